//! A row's values: its offset and its factors, from the tables (`fpga/DATAPATH.md`, *Values of a row*).

use std::sync::Arc;

/// The table entry of a row that is not stretched, 1.0; also the largest row factor.
pub const UNSTRETCHED: u32 = 1 << 24;

/// Fractional bits of a row's place between two grid rows. With 2^v rows from one to the next, v of them are used.
const PLACE_BITS: u8 = 6;

/// The B-spline's weights are integers whose sum is 2^13.
const WEIGHT_BITS: u32 = 13;

/// How a grid lies over a frame: a grid row every 2^v rows, a node every 2^k columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GridShape {
    v: u8,
    k: u8,
}

impl GridShape {
    /// The greatest v.
    pub(crate) const MOST_V: u8 = PLACE_BITS;

    /// The values of k that the mock's core takes.
    pub(crate) const KS: [u8; 2] = [5, 6];

    /// A grid row every 2^`v` rows, 1 to 6, and a node every 2^`k` columns, 5 or 6; none for other numbers.
    #[must_use]
    pub fn new(v: u8, k: u8) -> Option<Self> {
        ((1..=Self::MOST_V).contains(&v) && Self::KS.contains(&k)).then_some(Self { v, k })
    }

    /// N: segments of a row. It has one node more than segments.
    #[must_use]
    pub fn segments(self, width: u16) -> usize {
        usize::from(width).div_ceil(1 << self.k)
    }

    /// Z: grid rows of a frame of `height` rows.
    #[must_use]
    pub fn grid_rows(self, height: u16) -> usize {
        usize::from(height.saturating_sub(1) >> self.v) + 3
    }

    /// Entries for a frame: the offsets, then the factors of one node after another.
    #[must_use]
    pub fn entries(self, width: u16, height: u16) -> usize {
        (self.segments(width) + 2) * self.grid_rows(height)
    }
}

/// What determines the source coordinates of a row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RowValues {
    /// O, in units of 2^-13 column, signed.
    pub(super) offset: i32,
    /// Q[0] to Q[N] in units of 2^-24, one at each end of a segment; a single one if the whole row has the same factor.
    pub(super) factors: Arc<[u32]>,
    /// k: a segment has 2^k columns.
    pub(super) k: u8,
}

impl From<u32> for RowValues {
    /// The values of a row with one row factor.
    fn from(factor: u32) -> Self {
        Self { offset: 0, factors: Arc::new([factor]), k: 0 }
    }
}

impl RowValues {
    /// The values of `row` in a frame of this width and height. `entry` reads the grid.
    #[must_use]
    pub fn of_grid(
        shape: GridShape,
        (width, height): (u16, u16),
        row: u16,
        entry: impl Fn(usize) -> u32,
    ) -> Self {
        let (above, place) = (usize::from(row >> shape.v), row % (1 << shape.v));
        let weights = weights(place << (PLACE_BITS - shape.v));
        let grid_rows = shape.grid_rows(height);
        let value = |column: usize| {
            let first = column * grid_rows + above;
            let sum: u64 =
                (first..).zip(weights).map(|(index, weight)| weight * u64::from(entry(index))).sum();
            ((sum + (1 << (WEIGHT_BITS - 1))) >> WEIGHT_BITS) as u32
        };
        let factor = |node| 8 * (value(1 + node) >> 3).min(UNSTRETCHED >> 3);
        Self {
            offset: value(0).wrapping_sub(UNSTRETCHED).cast_signed(),
            factors: (0..=shape.segments(width)).map(factor).collect(),
            k: shape.k,
        }
    }
}

/// The weights w0, w1 and w2 of three grid rows, `place`/64 of the way from one grid row to the next.
fn weights(place: u16) -> [u64; 3] {
    let (right, left) = (u64::from(place), u64::from(64 - place));
    let (first, last) = (left * left, right * right);
    [first, (1 << WEIGHT_BITS) - first - last, last]
}
