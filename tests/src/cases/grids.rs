//! Grids of factors, DATAPATH.md's datapath 2, for cases.

use halfrow_model::{Geometry, GridShape, RowFactor, TableSet};

use crate::dice::Dice;

/// What a build needs for grids.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GridNeeds {
    /// T.
    pub entries: usize,
    /// Pixel clocks needed between rows of a grid that are narrower than `width`.
    pub blanking: u16,
    /// The width from which on a grid needs no more blanking than row factors do.
    pub width: usize,
}

/// A factor of 1, and an offset of 0.
const ONE: u32 = RowFactor::ONE.get();

/// The largest offset to the right that is drawn, 16 columns in units of 2^-13 column.
const OFFSETS: usize = 16 << 13;

/// A legal grid of any shape that the bank has room for. Its nodes range from all alike to all different, are at times above 2^24
/// and at times only at both ends of a range; its offsets go to the right. It is brought nearer to the identity until a ring of
/// `ring` samples can serve it.
pub(super) fn draw(dice: &mut Dice, geometry: Geometry, ring: usize, needs: GridNeeds) -> TableSet {
    let shapes: Vec<_> = GridShape::all().filter(|shape| shape.entries(&geometry) <= needs.entries).collect();
    let shape = shapes[dice.below(shapes.len())];
    let (rows, count) = (shape.rows(&geometry), shape.entries(&geometry));
    let spread = 1 << dice.below(24);
    let least = dice.one_of(&[1, 16, 22, 23]);
    let common = ONE - dice.below(1 << least) as u32;
    let two_ends = dice.below(4) == 0;
    let entry = |place: usize| match place < rows {
        true => ONE + dice.below(OFFSETS) as u32,
        false if two_ends => dice.one_of(&[common, (common + spread).min(*TableSet::GRID_RANGE.end())]),
        false => (common.saturating_sub(spread / 2) + dice.below(spread as usize) as u32)
            .min(*TableSet::GRID_RANGE.end()),
    };
    let entries: Vec<u32> = (0..count).map(entry).collect();
    let mut tables = TableSet::from_grid(geometry, shape, &entries).unwrap();
    for _ in 0..ONE.ilog2() {
        if tables.check_ring(ring).is_ok() {
            return tables;
        }
        tables = tables.halved();
    }
    TableSet::from_grid(geometry, shape, &vec![ONE; count]).unwrap()
}
