//! Which grids a ring can serve, at the limit of each condition.

use halfrow_model::{BitDepth, Geometry, TableError, TableSet};
use proptest::prelude::*;

use crate::ONE;
use crate::grid::{any_grid, shape};

/// A grid of W = 64 and 128 rows that gives every row the same values: the offset and the factors of the two nodes.
fn uniform(centre2: u32, [offset, left, right]: [u32; 3]) -> TableSet {
    let geometry = Geometry::new(64, 128, BitDepth::Twelve, centre2).unwrap();
    // Z = 4, and all grid rows are equal.
    let column = |entry| [entry; 4];
    TableSet::from_grid(geometry, shape(6, 6), &[offset, left, right].map(column).concat()).unwrap()
}

/// The entry for an offset of `units` times 2^-13 column.
fn offset(units: i32) -> u32 {
    ONE.wrapping_add_signed(units)
}

#[test]
fn a_row_may_begin_half_a_unit_left_of_the_frame() {
    // S[0] = 2^15·O: an O of −1 is a whole unit of q, and only half a unit is allowed.
    assert_eq!(uniform(63, [offset(0), ONE, ONE]).check_ring(64), Ok(()));
    let refused = uniform(63, [offset(-1), ONE, ONE]).check_ring(64).unwrap_err();
    assert_eq!(refused, TableError::BeforeFirst { row: 0, raise: 1 });
    assert!(
        refused.to_string().starts_with("row 0 begins left of the frame; raise the offsets"),
        "{refused}"
    );
    // C = 126 and Q[0] = 2^24 − 8: S[0] = 8·126·8 + 2^15·O = 8064 − 2^15, below −2^14; with Q[0] = 2^24 − 24, 24192 − 2^15.
    assert!(uniform(126, [offset(-1), ONE - 8, ONE]).check_ring(64).is_err());
    assert_eq!(uniform(126, [offset(-1), ONE - 24, ONE]).check_ring(64), Ok(()));
    // 8·126·16 − 2^15 = −16640, 256 below −2^14.
    assert_eq!(
        uniform(126, [offset(-1), ONE - 16, ONE]).check_ring(64),
        Err(TableError::BeforeFirst { row: 0, raise: 1 })
    );
    let far = uniform(63, [offset(-8192), ONE, ONE]).check_ring(64);
    assert_eq!(far, Err(TableError::BeforeFirst { row: 0, raise: 8192 }));
}

#[test]
fn a_row_may_end_anywhere_in_its_last_column() {
    // n[63] = 63 up to q = 64·8192 − 1.
    assert_eq!(uniform(63, [offset(8191), ONE, ONE]).check_ring(64), Ok(()));
    assert_eq!(
        uniform(63, [offset(8192), ONE, ONE]).check_ring(64),
        Err(TableError::AfterLast { row: 0, excess: 1 })
    );
    // Modulo 2^12 columns this end would lie in the row again, but it is still refused.
    let far = uniform(0, [(1 << 25) - 1, 0, 0]).check_ring(64).unwrap_err();
    assert!(matches!(far, TableError::AfterLast { row: 0, excess: 1984 }), "{far:?}");
}

#[test]
fn look_ahead_and_look_back_are_those_of_one_factor() {
    // All columns come from column 31 with Q = 0 and O = 31 columns, C = 0: n[0] + 4 = 35 = W/2 + 3.
    assert_eq!(uniform(0, [offset(31 * 8192), 0, 0]).check_ring(64), Ok(()));
    let refused = uniform(0, [offset(32 * 8192), 0, 0]).check_ring(64);
    assert_eq!(refused, Err(TableError::LookAhead { row: 0, excess: 1 }));
    // n[63] = 31 needs 63 − 31 + 31 = 63 samples of look-back; 30 needs one more than a ring of 64 still holds.
    assert_eq!(
        uniform(0, [offset(30 * 8192), 0, 0]).check_ring(64),
        Err(TableError::LookBack { row: 0, excess: 1, ring: 64 })
    );
    assert_eq!(uniform(0, [offset(30 * 8192), 0, 0]).check_ring(128), Ok(()));
}

#[test]
fn the_row_that_is_illegal_is_named() {
    let geometry = Geometry::new(64, 200, BitDepth::Twelve, 63).unwrap();
    let mut entries = vec![ONE; 3 * 6];
    // Grid row 4 is first used by row 128, with the weight t² = 0. So row 129, with t² = 1 of 2^13, is the first that it
    // changes.
    entries[4] = ONE - 8 * 8192;
    let tables = TableSet::from_grid(geometry, shape(6, 6), &entries).unwrap();
    assert_eq!(tables.check_ring(64), Err(TableError::BeforeFirst { row: 129, raise: 8 }));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// The conditions of DATAPATH.md, checked at every column.
    #[test]
    fn a_grid_is_legal_where_all_its_columns_are(tables in any_grid(400), halvings in 0..12_u32) {
        let tables = (0..halvings).fold(tables, |tables, _| tables.halved());
        let (width, height) = (tables.geometry().width() as i64, tables.geometry().height());
        let ring = tables.geometry().width().next_power_of_two();
        let is_legal = |row: &usize| {
            let values = tables.values(*row).unwrap();
            let n: Vec<i64> = (0..width as usize).map(|column| (values.coordinate(column) + (1 << 14)) >> 28).collect();
            let ahead = (0..).zip(&n).map(|(j, n)| n + 4 - j).max().unwrap();
            let back = (0..).zip(&n).map(|(j, n)| j - n).max().unwrap() + width / 2 - 1;
            n[0] >= 0 && n[n.len() - 1] < width && ahead <= width / 2 + 3 && back < ring as i64
        };
        let first = (0..height).find(|row| !is_legal(row));
        let named = tables.check_ring(ring).err().map(|error| match error {
            TableError::BeforeFirst { row, .. } | TableError::AfterLast { row, .. }
            | TableError::LookAhead { row, .. } | TableError::LookBack { row, .. } => row,
            other => panic!("{other}"),
        });
        prop_assert_eq!(named, first);
    }
}
