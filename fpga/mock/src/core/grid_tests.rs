//! The source coordinates that the two adders make, against the golden values of `fpga/DATAPATH.md`, *Datapath 2*.

use halfrow_conformance::material;
use proptest::prelude::*;
use proptest::sample::Index;

use super::source::{DROPPED_HALF, Source};
use super::values::{GridShape, RowValues, UNSTRETCHED};

/// Frames of this geometry with this grid.
struct Case {
    width: u16,
    height: u16,
    centre2: u16,
    shape: GridShape,
}

#[derive(Clone, Copy)]
enum Drawn {
    Narrow,
    Wide,
}

impl Case {
    fn values(&self, grid: &[u32], row: u16) -> RowValues {
        RowValues::of_grid(self.shape, (self.width, self.height), row, |entry| grid[entry])
    }

    /// The grid drawn from a seed: entries a little below 1, or of any size.
    fn drawn(&self, seed: u32, kind: Drawn) -> Vec<u32> {
        let entries = 0..self.shape.entries(self.width, self.height) as u32;
        let value = |entry: u32| {
            let x = entry.wrapping_add(seed).wrapping_mul(2_654_435_761);
            match kind {
                Drawn::Narrow => 14_680_064 + (x >> 12),
                Drawn::Wide => x >> 7,
            }
        };
        entries.map(value).collect()
    }
}

/// S of a row's columns.
fn coordinates(centre2: u16, values: &RowValues, width: u16) -> Vec<u64> {
    let mut source = Source::new(centre2, values, DROPPED_HALF);
    let columns = (0..width).map(|_| {
        let coordinate = source.coordinate();
        source.advance();
        coordinate
    });
    columns.collect()
}

fn crc_of_coordinates(rows: impl Iterator<Item = Vec<u64>>) -> u32 {
    crc32fast::hash(&rows.flatten().flat_map(u64::to_le_bytes).collect::<Vec<_>>())
}

#[test]
fn the_coordinates_of_drawn_grids_are_the_golden_ones() {
    use Drawn::{Narrow, Wide};
    for ((width, height, centre2, v, k), (seed, kind), grid_crc, expected) in [
        ((128, 9, 127, 1, 5), (0, Narrow), 0xf3f8_7b0c, 0x45fa_e881),
        ((128, 70, 100, 6, 6), (1, Narrow), 0xdb24_8d53, 0x2617_fe6d),
        ((130, 40, 31, 3, 5), (2, Wide), 0x27d8_4e57, 0x21b5_19cd),
        ((192, 5, 382, 2, 6), (3, Wide), 0x9f8f_1aa6, 0xc53e_6168),
        // Not on the page: the greatest C, with a factor other than 1 at column 0. From the page's formulas, by Python's
        // integers.
        ((192, 5, 382, 2, 6), (3, Narrow), 0x1340_8ac9, 0x551d_fae1),
    ] {
        let case = Case { width, height, centre2, shape: GridShape::new(v, k).unwrap() };
        let grid = case.drawn(seed, kind);
        let bytes: Vec<u8> = grid.iter().flat_map(|entry| entry.to_le_bytes()).collect();
        assert_eq!(crc32fast::hash(&bytes), grid_crc, "seed {seed}");
        let rows = (0..height).map(|row| coordinates(centre2, &case.values(&grid, row), width));
        assert_eq!(crc_of_coordinates(rows), expected, "seed {seed}");
    }
}

#[test]
fn the_coordinates_of_row_factors_are_the_golden_ones() {
    let rows = material::factors(1080, 1106.697).into_iter();
    let rows = rows.map(|factor| coordinates(1919, &factor.into(), 1920));
    assert_eq!(crc_of_coordinates(rows), 0x2074_7eed);
}

/// Row 3 of the worked example; all other entries are drawn.
fn worked_row() -> RowValues {
    let case = Case { width: 128, height: 9, centre2: 127, shape: GridShape::new(1, 5).unwrap() };
    let mut grid = case.drawn(9, Drawn::Wide);
    assert_eq!(grid.len(), 42);
    grid[1..4].copy_from_slice(&[16_777_216, 16_785_408, 16_793_600]);
    grid[8..11].copy_from_slice(&[14_680_064, 14_684_160, 14_696_448]);
    grid[15..18].copy_from_slice(&[14_745_600, 14_745_600, 14_749_696]);
    case.values(&grid, 3)
}

#[test]
fn the_worked_example_holds() {
    let values = worked_row();
    assert_eq!((values.offset, &values.factors[..2]), (8192, &[14_685_184, 14_746_112][..]));
    assert_eq!(values.factors.len(), 5);
    let coordinates = coordinates(127, &values, 33);
    assert_eq!(
        [coordinates[0], coordinates[5], coordinates[32]],
        [2_393_939_968, 3_569_135_488, 9_928_351_744]
    );
    let mut source = Source::new(127, &values, DROPPED_HALF);
    let position = (0..6).map(|_| source.advance()).last().unwrap();
    assert_eq!((position.n, position.fraction), (13, 108_921 - (13 << 13)));
}

/// Column 5 of the worked example of datapath 1: S = 280594744 is 68504.58 of 2^-13 column.
#[test]
fn a_source_that_is_not_rounded_is_one_less() {
    let fraction = |rounding| {
        let mut source = Source::new(63, &RowValues::from(14_648_488), rounding);
        let position = (0..6).map(|_| source.advance()).last().unwrap();
        assert_eq!(position.n, 8);
        position.fraction
    };
    assert_eq!([fraction(DROPPED_HALF), fraction(0)], [68_505 - (8 << 13), 68_504 - (8 << 13)]);
}

/// Entries of 2^24 leave every column where it is, in every shape, and larger factors are cut to 2^24.
#[test]
fn the_largest_factor_is_one() {
    for (v, k) in (1..=6).flat_map(|v| [(v, 5), (v, 6)]) {
        let case = Case { width: 2592, height: 2048, centre2: 9, shape: GridShape::new(v, k).unwrap() };
        for above in [0, 1, (1 << 24) - 1] {
            let columns = case.shape.grid_rows(case.height);
            let entry = |index| if index < columns { UNSTRETCHED } else { UNSTRETCHED + above };
            let values = RowValues::of_grid(case.shape, (case.width, case.height), 2047, entry);
            let expected: Vec<u64> = (0..2592).map(|column| column << 28).collect();
            assert_eq!(coordinates(case.centre2, &values, case.width), expected, "v = {v}, k = {k}");
        }
    }
}

/// S of a column by the page's closed form, modulo 2^40.
fn closed_form(centre2: u16, values: &RowValues, column: u16) -> i128 {
    let factor = |node: usize| i128::from(values.factors[node]);
    let segments = (0..usize::from(column >> values.k)).map(|s| factor(s) + factor(s + 1));
    let begun = segments.sum::<i128>() << (values.k + 3);
    let first =
        8 * i128::from(centre2) * (i128::from(UNSTRETCHED) - factor(0)) + (i128::from(values.offset) << 15);
    let (s, i) = (usize::from(column >> values.k), i128::from(column % (1 << values.k)));
    let bend = ((factor(s + 1) - factor(s)) / 8) << (6 - values.k);
    (first + begun + i * (16 * factor(s) + i * bend)).rem_euclid(1 << 40)
}

proptest! {
    /// Whatever the entries, legal or not: the coordinates wrap, and none is more than a column after the one before.
    #[test]
    fn two_adders_make_the_closed_form_of_any_grid(
        v in 1_u8..=6, k in 5_u8..=6, half in 32_u16..=200, height in 1_u16..=80, row: Index, centre: Index, seed: u32,
    ) {
        let (width, shape) = (2 * half, GridShape::new(v, k).unwrap());
        let case = Case { width, height, centre2: centre.index(2 * usize::from(width) - 1) as u16, shape };
        let values = case.values(&case.drawn(seed, Drawn::Wide), row.index(height.into()) as u16);
        let made = coordinates(case.centre2, &values, width);
        for (column, &coordinate) in (0..).zip(&made) {
            prop_assert_eq!(i128::from(coordinate), closed_form(case.centre2, &values, column), "column {}", column);
        }
        prop_assert!(made.windows(2).all(|pair| pair[1].wrapping_sub(pair[0]) % (1 << 40) <= 1 << 28));
    }
}

#[test]
fn only_shapes_of_the_page_are_made() {
    let made =
        (0..=9).flat_map(|v| (0..=9).map(move |k| (v, k))).filter(|&(v, k)| GridShape::new(v, k).is_some());
    assert_eq!(made.collect::<Vec<_>>(), (1..=6).flat_map(|v| [(v, 5), (v, 6)]).collect::<Vec<_>>());
}
