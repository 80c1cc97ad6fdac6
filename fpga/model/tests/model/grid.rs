//! Grids: their arithmetic by hand and by the additions that a board makes.

use std::error::Error as _;

use halfrow_model::{
    BitDepth, Equidistant, Frame, Geometry, GeometryError, GridShape, Interpolant, Kernel, Phase, RowFactor,
    Source, TableError, TableSet, correct, correct_row, correct_row_of_values, source,
};
use proptest::prelude::*;

use crate::{ONE, row_factor};

pub(crate) fn shape(v: u32, k: u32) -> GridShape {
    GridShape::new(v, k).unwrap()
}

/// Every entry 2^24.
pub(crate) fn identity(geometry: Geometry, shape: GridShape) -> TableSet {
    TableSet::from_grid(geometry, shape, &vec![ONE; shape.entries(&geometry)]).unwrap()
}

/// Grids from a seed: with entries of every size, only the limits, or as smooth as those of a lens.
pub(crate) fn any_grid(widest: usize) -> impl Strategy<Value = TableSet> {
    let geometry =
        (32..=widest / 2, 1..=70_usize, any::<u32>(), prop::sample::select(BitDepth::ALL.to_vec()));
    let geometry = geometry.prop_map(|(half, height, centre, depth)| {
        let last = 4 * half as u32 - 2;
        let centre2 = if centre.is_multiple_of(3) { last / 2 } else { centre % (last + 1) };
        Geometry::new(2 * half, height, depth, centre2).unwrap()
    });
    (geometry, 1..=6_u32, 5..=6_u32, any::<u32>(), 0..=2_u32).prop_map(|(geometry, v, k, seed, kind)| {
        let entry = |place: u32| {
            let drawn = (place ^ seed).wrapping_mul(2_654_435_761).rotate_left(seed % 16);
            match kind {
                0 => drawn >> 7,
                1 => {
                    if drawn >> 31 == 0 {
                        0
                    } else {
                        (1 << 25) - 1
                    }
                }
                _ => 14_680_064 + (drawn >> 12),
            }
        };
        let shape = shape(v, k);
        let entries: Vec<_> = (0..shape.entries(&geometry) as u32).map(entry).collect();
        TableSet::from_grid(geometry, shape, &entries).unwrap()
    })
}

/// S modulo 2^40 along a row as a board adds it up, with 40 bits for S and 29 for D.
fn added_up(tables: &TableSet, row: usize) -> Vec<u64> {
    const S: u64 = (1 << 40) - 1;
    let (geometry, shape) = (tables.geometry(), tables.shape().unwrap());
    let (rows, entries): (usize, Vec<_>) = (shape.rows(geometry), tables.entries().map(u64::from).collect());
    let (grid_row, t) = (row >> shape.v(), ((row % (1 << shape.v())) << (6 - shape.v())) as u64);
    let weights = [(64 - t) * (64 - t), 8192 - (64 - t) * (64 - t) - t * t, t * t];
    let value = |column: usize| {
        let sum: u64 = (0..3).map(|place| weights[place] * entries[column * rows + grid_row + place]).sum();
        (sum + 4096) >> 13
    };
    let factor = |node: usize| 8 * (value(1 + node) >> 3).min(1 << 21);
    let offset = value(0).wrapping_sub(1 << 24);
    let mut s = (8 * u64::from(geometry.centre2()) * ((1 << 24) - factor(0))).wrapping_add(offset << 15) & S;
    let (mut d, mut found) = (0_u64, Vec::new());
    for column in 0..geometry.width() {
        let segment = column >> shape.k();
        let bend = (factor(segment + 1) / 8).wrapping_sub(factor(segment) / 8) << (6 - shape.k());
        if column % (1 << shape.k()) == 0 {
            d = (16 * factor(segment)).wrapping_add(bend);
        }
        found.push(s);
        assert!(d <= 1 << 28, "D = {d} at column {column}");
        s = s.wrapping_add(d) & S;
        d = d.wrapping_add(bend.wrapping_mul(2));
    }
    found
}

/// The source that DATAPATH.md derives from q.
fn located(q: u64, column: usize) -> Source {
    let n = (q >> 13) as i64;
    let base = if n % 2 == column as i64 % 2 { n } else { n - 1 };
    let x = q as i64 - base * 8192;
    Source { base, column: n, node: (x >> 8) as usize, fraction: (x % 256) as i32 }
}

#[test]
fn a_row_has_the_values_of_the_worked_example() {
    let geometry = Geometry::new(128, 9, BitDepth::Twelve, 127).unwrap();
    let mut entries = vec![0; 42];
    entries[1..4].copy_from_slice(&[16_777_216, 16_785_408, 16_793_600]);
    entries[8..11].copy_from_slice(&[14_680_064, 14_684_160, 14_696_448]);
    entries[15..18].copy_from_slice(&[14_745_600, 14_745_600, 14_749_696]);
    let tables = TableSet::from_grid(geometry, shape(1, 5), &entries).unwrap();
    let values = tables.values(3).unwrap();
    assert_eq!(values.offset(), 8192);
    assert_eq!(values.factors()[..2], [14_685_184, 14_746_112]);
    assert_eq!(values.factors().len(), 5);
    assert_eq!(
        [0, 5, 32].map(|column| values.coordinate(column)),
        [2_393_939_968, 3_569_135_488, 9_928_351_744]
    );
    // q = 108921 gives n = 13, and column 5 is odd too; 108921 − 13·8192 = 2425 = 9·256 + 121.
    assert_eq!(values.source(5), Source { base: 13, column: 13, node: 9, fraction: 121 });
}

#[test]
fn entries_of_2_to_the_24_stretch_nothing_in_every_shape() {
    for shape in GridShape::all() {
        let geometry = Geometry::new(130, 70, BitDepth::Twelve, 17).unwrap();
        let tables = identity(geometry, shape);
        for row in [0, 1, 31, 69] {
            let values = tables.values(row).unwrap();
            assert!((0..130).all(|column| values.coordinate(column) == (column as i64) << 28), "{shape}");
        }
        assert_eq!(tables.check_ring(256), Ok(()));
        assert_eq!(tables.values(70), None);
    }
    assert_eq!(GridShape::all().count(), 12);
}

#[test]
fn a_grid_has_as_many_entries_as_its_shape_says() {
    let geometry = Geometry::new(130, 65, BitDepth::Twelve, 17).unwrap();
    // N = ceil(130/32) = 5, Z = floor(64/16) + 3 = 7.
    let shape = shape(4, 5);
    assert_eq!((shape.segments(&geometry), shape.rows(&geometry), shape.entries(&geometry)), (5, 7, 49));
    for entries in [0, 48, 50] {
        let refused = TableSet::from_grid(geometry, shape, &vec![ONE; entries]).unwrap_err();
        assert_eq!(refused, TableError::GridCount { entries, columns: 7, rows: 7 });
        assert!(
            refused.to_string().ends_with("7 columns and 7 grid rows; give 49, column by column"),
            "{refused}"
        );
    }
    let mut entries = vec![0; 49];
    entries[2 * 7 + 3] = (1 << 25) - 1;
    assert!(TableSet::from_grid(geometry, shape, &entries).is_ok());
    entries[2 * 7 + 3] = 1 << 25;
    let refused = TableSet::from_grid(geometry, shape, &entries).unwrap_err();
    assert_eq!(refused, TableError::GridEntry { column: 2, row: 3, units: 1 << 25 });
    assert!(
        refused.source().is_none() && refused.to_string().contains("entry (2, 3) of the grid is 33554432")
    );
}

#[test]
fn a_shape_has_one_to_six_and_five_or_six() {
    for (v, k) in [(0, 5), (7, 5), (1, 4), (1, 7), (u32::MAX, u32::MAX)] {
        let refused = GridShape::new(v, k).unwrap_err();
        assert_eq!((refused.v, refused.k), (v, k));
        assert!(refused.to_string().ends_with("give v from 1 to 6, and k from 5 to 6"), "{refused}");
    }
    assert_eq!(shape(3, 6).to_string(), "v = 3, k = 6");
}

#[test]
fn a_grid_is_sent_column_by_column_little_endian() {
    let geometry = Geometry::new(64, 1, BitDepth::Twelve, 63).unwrap();
    let entries: Vec<u32> = (0..9).map(|entry| 0x0012_3400 + entry).collect();
    let tables = TableSet::from_grid(geometry, shape(6, 6), &entries).unwrap();
    assert!(tables.entries().eq(entries));
    assert_eq!(tables.to_bytes()[..8], [0x00, 0x34, 0x12, 0, 0x01, 0x34, 0x12, 0]);
    assert_eq!((tables.row_factors(), tables.row_factor(0)), (None, None));
    assert_eq!(tables.shape(), Some(shape(6, 6)));
}

#[test]
fn entries_go_with_another_depth_and_centre() {
    let geometry = |width, centre2| Geometry::new(width, 9, BitDepth::Ten, centre2).unwrap();
    let lens = Equidistant::from_radius(500.0).unwrap();
    let rows = TableSet::from_lens(geometry(96, 95), &lens, None).unwrap();
    let entries = vec![ONE - 4096; shape(2, 5).entries(&geometry(96, 95))];
    let grid = TableSet::from_grid(geometry(96, 95), shape(2, 5), &entries).unwrap();
    for tables in [rows, grid] {
        let moved = tables.with_settings(BitDepth::Eight, 30).unwrap();
        assert_eq!(*moved.geometry(), Geometry::new(96, 9, BitDepth::Eight, 30).unwrap());
        assert!(moved.entries().eq(tables.entries()));
        assert_eq!(moved.shape(), tables.shape());
        for row in 0..10 {
            assert_eq!(tables.values_about(30, row), moved.values(row));
        }
        assert_ne!(moved.values(0), tables.values(0));
        let beyond = GeometryError::Centre { column: 95.5, last: 95 };
        assert_eq!(tables.with_settings(BitDepth::Eight, 191), Err(beyond));
    }
}

#[test]
fn tables_that_stretch_half_as_far_lie_half_way_to_the_identity() {
    let geometry = Geometry::new(64, 2, BitDepth::Twelve, 63).unwrap();
    let tables = TableSet::from_units(geometry, &[ONE / 2, ONE]).unwrap();
    assert!(tables.halved().entries().eq([ONE / 4 * 3, ONE]));
    let entries = [ONE, 0, (1 << 25) - 1, 1, 2, 3, ONE, ONE, ONE];
    let grid = TableSet::from_grid(geometry, shape(6, 6), &entries).unwrap();
    assert!(grid.halved().entries().take(6).eq([ONE, ONE / 2, 25_165_823, 8_388_608, 8_388_609, 8_388_609]));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn the_closed_form_is_what_adders_make_of_every_grid(tables in any_grid(400), row in any::<prop::sample::Index>()) {
        let row = row.index(tables.geometry().height());
        let values = tables.values(row).unwrap();
        for (column, s) in added_up(&tables, row).into_iter().enumerate() {
            prop_assert_eq!(values.coordinate(column) as u64 & ((1 << 40) - 1), s, "column {}", column);
            let q = ((s + (1 << 14)) & ((1 << 40) - 1)) >> 15;
            prop_assert_eq!(values.source(column), located(q, column), "column {}", column);
        }
    }

    #[test]
    fn the_upper_rows_of_a_grid_have_the_values_that_they_had(tables in any_grid(200), rows in any::<prop::sample::Index>()) {
        let rows = rows.index(tables.geometry().height()) + 1;
        let upper = tables.upper(rows).unwrap();
        prop_assert_eq!(upper.geometry().height(), rows);
        prop_assert!((0..rows).all(|row| upper.values(row) == tables.values(row)));
        prop_assert_eq!(tables.upper(tables.geometry().height() + 1), None);
    }

    #[test]
    fn one_factor_a_row_is_a_grid_s_arithmetic_with_one_value(
        half in 32..=600_usize, centre in any::<u32>(), factor in 1..=ONE,
    ) {
        let geometry = Geometry::new(2 * half, 1, BitDepth::Twelve, centre % (4 * half as u32 - 1)).unwrap();
        let values = TableSet::from_units(geometry, &[factor]).unwrap().values(0).unwrap();
        prop_assert_eq!(values.offset(), 0);
        prop_assert!((0..2 * half).all(|column| values.source(column) == source(&geometry, row_factor(factor), column)));
        let row: Vec<u16> = (0..2 * half as u32).map(|column| (column.wrapping_mul(2_654_435_761) >> 20) as u16).collect();
        let (mut by_values, mut by_factor) = (vec![0; 2 * half], vec![0; 2 * half]);
        let kernel = Kernel::from(Interpolant::Keys);
        correct_row_of_values(&geometry, &values, &kernel, &row, &mut by_values);
        correct_row(&geometry, RowFactor::new(factor).unwrap(), &kernel, &row, &mut by_factor);
        prop_assert_eq!(by_values, by_factor);
    }

    #[test]
    fn a_flat_field_stays_flat_behind_every_grid(tables in any_grid(200), own in 0_u16..=255, other in 0_u16..=255) {
        let (width, height) = (tables.geometry().width(), tables.geometry().height());
        let samples = (0..width * height).map(|place| if place % width % 2 == 0 { own } else { other }).collect();
        let frame = Frame::new(width, tables.geometry().depth(), Phase::Grbg, samples).unwrap();
        prop_assert_eq!(correct(&tables, &Interpolant::Hermite.into(), &frame), Ok(frame));
    }
}
