//! The grid: factors that depend on the column as well (DATAPATH.md, "Datapath 2: a grid of factors").

mod choice;
mod closed_form;
mod fit;
mod lattice;
mod normal;
mod projection;
mod residual_sum;
mod rows;
mod shape;
mod values;

pub use choice::GridRoomError;
pub use lattice::{GridResiduals, INNER_DEGREES, INNER_ROWS};
pub(crate) use lattice::{height_in_circle, is_inner};
pub use residual_sum::{GridResidual, ResidualSum, VISIBLE};
pub use shape::{GridShape, GridShapeError};
pub use values::RowValues;
pub(crate) use values::{RowNodes, curve, q_of_grid};

use crate::{Geometry, RowFactor};

/// Bits of an entry.
pub(crate) const ENTRY_BITS: u32 = 25;

/// The bits of the sum of the B-spline's weights, 2^13.
const WEIGHT_BITS: u32 = 13;

/// The entries of a grid. They are stored grid row by grid row, since each row is made of three of those.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Grid {
    shape: GridShape,
    /// Entry (c, b), at b · `columns` + c.
    entries: Vec<u32>,
    /// N + 2.
    columns: usize,
}

/// Entries that are no grid.
pub(crate) enum GridFault {
    /// This number of entries, which is not (N + 2)·Z.
    Count(usize),
    /// An entry with more than [`ENTRY_BITS`] bits, and its place.
    Entry { place: usize, units: u32 },
}

impl Grid {
    /// The grid of `entries`, which are in a board's order.
    pub(crate) fn new(geometry: &Geometry, shape: GridShape, entries: &[u32]) -> Result<Self, GridFault> {
        if entries.len() != shape.entries(geometry) {
            return Err(GridFault::Count(entries.len()));
        }
        let wide = |(_, units): &(usize, &u32)| **units >> ENTRY_BITS != 0;
        match entries.iter().enumerate().find(wide) {
            Some((place, &units)) => Err(GridFault::Entry { place, units }),
            None => Ok(Self::of_columns(geometry, shape, entries)),
        }
    }

    /// The grid of `entries`, which are in a board's order and of the right number.
    fn of_columns(geometry: &Geometry, shape: GridShape, entries: &[u32]) -> Self {
        let rows = shape.rows(geometry);
        let row = |row| entries.iter().skip(row).step_by(rows).copied();
        Self { shape, entries: (0..rows).flat_map(row).collect(), columns: shape.columns(geometry) }
    }

    pub(crate) fn shape(&self) -> GridShape {
        self.shape
    }

    /// (N + 2)·Z.
    pub(crate) fn len(&self) -> usize {
        self.entries.len()
    }

    /// The entry at `place` in a board's order.
    pub(crate) fn entry(&self, place: usize) -> u32 {
        let rows = self.entries.len() / self.columns;
        self.entries[place % rows * self.columns + place / rows]
    }

    /// The offset of grid row `row`.
    fn offset_mut(&mut self, row: usize) -> &mut u32 {
        &mut self.entries[row * self.columns]
    }

    /// The upper grid rows, as many as `geometry` has. It must be as wide as the grid's own geometry and at most as high.
    pub(crate) fn upper(&self, geometry: &Geometry) -> Option<Self> {
        let entries = self.entries.get(..self.shape.entries(geometry))?.to_vec();
        Some(Self { entries, ..*self })
    }

    /// Every entry half way to 2^24, rounded down.
    pub(crate) fn halved(&self) -> Self {
        let halved = |&entry: &u32| u32::midpoint(entry, RowFactor::ONE.get());
        Self { entries: self.entries.iter().map(halved).collect(), ..*self }
    }

    /// Replaces `values` by those of row `row`, which the frame must have, about the column `centre2` / 2.
    pub(crate) fn values(&self, centre2: u32, row: usize, values: &mut RowValues) {
        self.nodes(centre2, row, values.nodes_mut());
        values.lay_out();
    }

    /// What those values are made of.
    pub(crate) fn nodes(&self, centre2: u32, row: usize, values: &mut RowNodes) {
        let (first, weights) = spline(self.shape, row);
        let [above, own, below] = weights.map(u64::from);
        let value = |[first, second, third]: [u32; 3]| {
            let sum = above * u64::from(first) + own * u64::from(second) + below * u64::from(third);
            ((sum + (1 << (WEIGHT_BITS - 1))) >> WEIGHT_BITS) as u32
        };
        let [upper, middle, lower] =
            [0, 1, 2].map(|row| &self.entries[(first + row) * self.columns..][..self.columns]);
        let one = RowFactor::ONE.get();
        let offset = value([upper[0], middle[0], lower[0]]) as i32 - one as i32;
        let nodes = upper[1..].iter().zip(&middle[1..]).zip(&lower[1..]);
        // A loop over slices, which compilers vectorise.
        for (factor, ((&upper, &middle), &lower)) in
            values.factors_mut(self.columns - 1).iter_mut().zip(nodes)
        {
            *factor = 8 * (value([upper, middle, lower]) >> 3).min(one >> 3);
        }
        values.take(centre2, self.shape.k(), offset);
    }
}

/// The first of the three grid rows that make a row, and their weights.
pub(crate) fn spline(shape: GridShape, row: usize) -> (usize, [u32; 3]) {
    let t = ((row % shape.row_pitch()) << (6 - shape.v())) as u32;
    let (above, below) = ((64 - t).pow(2), t.pow(2));
    (row >> shape.v(), [above, (1 << WEIGHT_BITS) - above - below, below])
}
