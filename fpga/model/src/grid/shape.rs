//! The shape of a grid: how far apart its nodes are.

use std::fmt;
use std::ops::RangeInclusive;

use crate::Geometry;

/// v and k of a grid: 2^v rows from one grid row to the next, 2^k columns from one node to the next (DATAPATH.md, "Datapath
/// 2: a grid of factors").
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct GridShape {
    v: u32,
    k: u32,
}

/// No grid has a shape of these numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "no grid has v = {v} and k = {k}; give v from {} to {}, and k from {} to {}",
    GridShape::V.start(), GridShape::V.end(), GridShape::K.start(), GridShape::K.end()
)]
pub struct GridShapeError {
    /// The binary logarithm of the rows between grid rows.
    pub v: u32,
    /// The binary logarithm of the columns between nodes.
    pub k: u32,
}

impl GridShape {
    /// All v of a grid. 0 would be one factor per row.
    pub const V: RangeInclusive<u32> = 1..=6;
    /// All k of a grid.
    pub const K: RangeInclusive<u32> = 5..=6;

    /// The shape with the fewest nodes and grid rows.
    pub(crate) const COARSEST: Self = Self { v: 6, k: 6 };

    /// The shape with the most nodes and grid rows.
    pub(crate) const FINEST: Self = Self { v: 1, k: 5 };

    /// The shape with 2^`v` rows from one grid row to the next and 2^`k` columns from one node to the next.
    ///
    /// # Errors
    /// [`GridShapeError`] when `v` is outside [`Self::V`] or `k` outside [`Self::K`].
    pub fn new(v: u32, k: u32) -> Result<Self, GridShapeError> {
        if Self::V.contains(&v) && Self::K.contains(&k) {
            Ok(Self { v, k })
        } else {
            Err(GridShapeError { v, k })
        }
    }

    /// All shapes, the coarsest first.
    pub fn all() -> impl Iterator<Item = Self> + Clone {
        Self::V.rev().flat_map(|v| Self::K.rev().map(move |k| Self { v, k }))
    }

    /// The k of grids with a node every `columns` columns, if there are such grids.
    #[must_use]
    pub fn k_of(columns: usize) -> Option<u32> {
        Self::K.into_iter().find(|&k| columns == 1 << k)
    }

    /// v.
    #[must_use]
    pub const fn v(self) -> u32 {
        self.v
    }

    /// k.
    #[must_use]
    pub const fn k(self) -> u32 {
        self.k
    }

    /// 2^v: rows from one grid row to the next.
    #[must_use]
    pub const fn row_pitch(self) -> usize {
        1 << self.v
    }

    /// h = 2^k: columns from one node to the next.
    #[must_use]
    pub const fn column_pitch(self) -> usize {
        1 << self.k
    }

    /// N: segments of a row. Its nodes are 0 to N.
    #[must_use]
    pub fn segments(self, geometry: &Geometry) -> usize {
        geometry.width().div_ceil(self.column_pitch())
    }

    /// N + 2: columns of the grid, one of offsets and one for each node.
    #[must_use]
    pub fn columns(self, geometry: &Geometry) -> usize {
        self.segments(geometry) + 2
    }

    /// Z: grid rows.
    #[must_use]
    pub fn rows(self, geometry: &Geometry) -> usize {
        ((geometry.height() - 1) >> self.v) + 3
    }

    /// (N + 2)·Z: entries of a grid.
    #[must_use]
    pub fn entries(self, geometry: &Geometry) -> usize {
        self.columns(geometry) * self.rows(geometry)
    }
}

impl fmt::Display for GridShape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "v = {}, k = {}", self.v, self.k)
    }
}
