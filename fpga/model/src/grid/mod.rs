//! The grid: factors that depend on the column, too (DATAPATH.md, "Datapath 2: a grid of factors").

mod choice;
mod closed_form;
mod fit;
mod lattice;
mod normal;
mod projection;
mod rows;
mod shape;
mod values;

pub use choice::GridRoomError;
pub use lattice::{GridResidual, GridResiduals};
pub use shape::{GridShape, GridShapeError};
pub use values::RowValues;
pub(crate) use values::{Parabola, rounded};

use crate::{Geometry, RowFactor};

/// Bits of an entry.
pub(crate) const ENTRY_BITS: u32 = 25;

/// Weights of the B-spline add up to 2^13.
const WEIGHT_BITS: u32 = 13;

/// The entries of a grid, column by column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Grid {
    shape: GridShape,
    /// (c, b) at c · `rows` + b.
    entries: Vec<u32>,
    /// Z.
    rows: usize,
}

/// Entries that make no grid.
pub(crate) enum GridFault {
    /// So many, not (N + 2)·Z.
    Count(usize),
    /// One of more than [`ENTRY_BITS`] bits, and its place.
    Entry { place: usize, units: u32 },
}

impl Grid {
    /// The grid of `entries` in a board's order.
    pub(crate) fn new(geometry: &Geometry, shape: GridShape, entries: Vec<u32>) -> Result<Self, GridFault> {
        if entries.len() != shape.entries(geometry) {
            return Err(GridFault::Count(entries.len()));
        }
        let wide = |(_, units): &(usize, &u32)| **units >> ENTRY_BITS != 0;
        match entries.iter().enumerate().find(wide) {
            Some((place, &units)) => Err(GridFault::Entry { place, units }),
            None => Ok(Self { shape, entries, rows: shape.rows(geometry) }),
        }
    }

    pub(crate) fn shape(&self) -> GridShape {
        self.shape
    }

    pub(crate) fn entries(&self) -> &[u32] {
        &self.entries
    }

    /// The upper grid rows, as many as `geometry` has, which is as wide as the grid's own and not higher.
    pub(crate) fn upper(&self, geometry: &Geometry) -> Option<Self> {
        let rows = self.shape.rows(geometry);
        let columns = self.entries.chunks_exact(self.rows).map(|column| column.get(..rows));
        let entries = columns.collect::<Option<Vec<_>>>()?.concat();
        Some(Self { shape: self.shape, entries, rows })
    }

    /// Every entry half way to 2^24, rounded down.
    pub(crate) fn halved(&self) -> Self {
        let halved = |&entry: &u32| u32::midpoint(entry, RowFactor::ONE.get());
        Self { entries: self.entries.iter().map(halved).collect(), ..*self }
    }

    /// The values of row `row`, which the frame has, in the place of those that `values` held.
    pub(crate) fn values(&self, geometry: &Geometry, row: usize, values: &mut RowValues) {
        let (first, weights) = spline(self.shape, row);
        let value = |column: &[u32]| {
            let terms = column[first..first + 3].iter().zip(weights);
            let sum: u64 = terms.map(|(&entry, weight)| u64::from(entry) * u64::from(weight)).sum();
            ((sum + (1 << (WEIGHT_BITS - 1))) >> WEIGHT_BITS) as u32
        };
        let mut columns = self.entries.chunks_exact(self.rows).map(value);
        let one = RowFactor::ONE.get();
        let offset = columns.next().map_or(0, |offset| offset as i32 - one as i32);
        let factors = columns.map(|factor| 8 * (factor >> 3).min(one >> 3));
        values.take(geometry, self.shape.k(), offset, factors);
    }
}

/// The first of the three grid rows that a row is made of, and their weights.
pub(crate) fn spline(shape: GridShape, row: usize) -> (usize, [u32; 3]) {
    let t = ((row % shape.row_pitch()) << (6 - shape.v())) as u32;
    let (above, below) = ((64 - t).pow(2), t.pow(2));
    (row >> shape.v(), [above, (1 << WEIGHT_BITS) - above - below, below])
}
