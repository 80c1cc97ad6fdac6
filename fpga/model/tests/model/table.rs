//! Row factors from a lens, and the ring's two conditions.

use std::error::Error as _;

use halfrow_model::{BitDepth, Equidistant, Geometry, RowFactor, RowFactorError, TableError, TableSet};
use proptest::prelude::*;

use crate::ONE;

fn geometry(height: usize, centre2: u32) -> Geometry {
    Geometry::new(64, height, BitDepth::Twelve, centre2).unwrap()
}

/// Checks a ring of `ring` samples against a table whose row 2 of 4 has `factor` and whose other rows are not stretched.
fn check_ring(centre2: u32, factor: u32, ring: usize) -> Result<(), TableError> {
    let factors = [ONE, ONE, factor, ONE];
    TableSet::from_units(geometry(4, centre2), &factors).unwrap().check_ring(ring)
}

#[test]
fn row_factors_follow_the_circle_of_the_lens() {
    let lens = Equidistant::from_radius(5.0).unwrap();
    let tables = TableSet::from_lens(geometry(13, 63), &lens, None).unwrap();
    // 2^24 · (3, 4)/5 = 10066329.6 and 13421772.8; 2^24 · sqrt(21)/5 = 15376572.5; 2^24 · sqrt(24)/5 = 16438247.4
    let half = [ONE, ONE, 10_066_330, 13_421_773, 15_376_572, 16_438_247];
    assert!(tables.entries().take(6).eq(half));
    assert_eq!(tables.row_factor(6), Some(RowFactor::ONE));
    let rows = tables.row_factors().unwrap();
    assert!(rows[..6].iter().eq(rows[7..].iter().rev()));
    assert_eq!(tables.row_factor(13), None);
}

#[test]
fn the_optical_centre_may_lie_on_any_row() {
    let lens = Equidistant::from_radius(5.0).unwrap();
    let tables = TableSet::from_lens(geometry(4, 63), &lens, Some(-3.0)).unwrap();
    assert!(tables.entries().eq([13_421_773, 10_066_330, ONE, ONE]));
    let refused = TableSet::from_lens(geometry(4, 63), &lens, Some(f64::INFINITY));
    assert_eq!(refused, Err(TableError::CentreRow(f64::INFINITY)));
}

#[test]
fn a_row_factor_is_never_zero() {
    // The largest y below R = 1: sqrt(1 − y²) is 2^-26, and 2^24 times it rounds to 0.
    let lens = Equidistant::from_radius(1.0).unwrap();
    let tables = TableSet::from_lens(geometry(1, 63), &lens, Some(f64::EPSILON / 2.0 - 1.0)).unwrap();
    assert!(tables.entries().eq([1]));
}

#[test]
fn a_table_has_one_legal_row_factor_a_row() {
    let new = |factors: &[u32]| TableSet::from_units(geometry(3, 63), factors);
    assert_eq!(new(&[1, 2]), Err(TableError::Count { row_factors: 2, height: 3 }));
    assert_eq!(new(&[1, 0, 1]), Err(TableError::RowFactor { row: 1, source: RowFactorError { units: 0 } }));
    assert_eq!(
        new(&[1, 1, ONE + 1]),
        Err(TableError::RowFactor { row: 2, source: RowFactorError { units: ONE + 1 } })
    );
    assert!(new(&[1, 2, ONE]).is_ok());
}

#[test]
fn an_error_names_the_place_and_the_remedy() {
    let error = TableSet::from_units(geometry(1, 63), &[0]).unwrap_err();
    let said = format!("{error}: {}", error.source().unwrap());
    assert!(
        said.starts_with("the entry of row 0 cannot be used: 0 is no row factor, which is 1 to"),
        "{said}"
    );
}

#[test]
fn look_ahead_is_legal_up_to_half_a_row_and_three() {
    // C = 126, W = 64: n[0] ≤ 31 needs 126 · (2^24 − Q) + 2^11 < 2^30, so 2^24 − Q ≤ 8521744.
    assert_eq!(check_ring(126, ONE - 8_521_744, 64), Ok(()));
    let refused = Err(TableError::LookAhead { row: 2, excess: 1 });
    assert_eq!(check_ring(126, ONE - 8_521_745, 64), refused);
    // A longer ring does not bring samples earlier.
    assert_eq!(check_ring(126, ONE - 8_521_745, 4096), refused);
}

#[test]
fn look_back_is_legal_up_to_the_ring() {
    // C = 0, W = M = 64: n[63] ≥ 31 needs 126 · Q + 2^11 ≥ 31 · 2^25, so Q ≥ 8255440.
    assert_eq!(check_ring(0, 8_255_440, 64), Ok(()));
    assert_eq!(check_ring(0, 8_255_439, 64), Err(TableError::LookBack { row: 2, excess: 1, ring: 64 }));
    assert_eq!(check_ring(0, 8_255_439, 128), Ok(()));
}

#[test]
fn the_strongest_stretch_at_an_edge_misses_by_half_a_row() {
    // All along the row n stays at 63 (where the rounding of q lifts it) or at 0.
    assert_eq!(check_ring(126, 1, 64), Err(TableError::LookAhead { row: 2, excess: 32 }));
    assert_eq!(check_ring(0, 1, 64), Err(TableError::LookBack { row: 2, excess: 31, ring: 64 }));
}

#[test]
fn a_table_is_sent_row_by_row_little_endian() {
    let tables = TableSet::from_units(geometry(2, 63), &[0x00AB_CDEF, 1]).unwrap();
    assert_eq!(tables.to_bytes(), [0xEF, 0xCD, 0xAB, 0x00, 1, 0, 0, 0]);
}

proptest! {
    #[test]
    fn with_the_centre_in_the_middle_every_row_factor_fits_the_shortest_ring(pairs in 32_usize..=1296, factor in 1..=ONE) {
        let width = 2 * pairs;
        let geometry = Geometry::centred(width, 1, BitDepth::Twelve).unwrap();
        let tables = TableSet::from_units(geometry, &[factor]).unwrap();
        prop_assert_eq!(tables.check_ring(width.next_power_of_two()), Ok(()));
        prop_assert_eq!(tables.check_ring(width), Ok(()));
    }
}
