//! The values of a row: what the datapath computes from a table before the row leaves (DATAPATH.md, "Values of a row").

use crate::corrector::{Source, locate};
use crate::{Geometry, GridShape, RowFactor};

/// Bits of a source coordinate: a board keeps S modulo 2^40.
const COORDINATE_BITS: u32 = 40;

/// Bits of S below q.
const BELOW: u32 = 15;

/// O and Q\[0\] to Q\[N\] of a row, and where its segments start. For one factor per row, O is 0 and every node has that
/// factor.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RowValues {
    nodes: RowNodes,
    /// The course of S in each segment, 0 to N − 1.
    segments: Vec<Parabola>,
}

/// What a row's values are made of.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct RowNodes {
    /// The binary logarithm of a segment's columns.
    pub(crate) k: u32,
    offset: i32,
    /// S\[0\].
    pub(crate) start: i64,
    /// Q of every node.
    pub(crate) factors: Vec<u32>,
}

impl RowNodes {
    /// The factors of `nodes` nodes, to be filled in before [`Self::take`].
    pub(crate) fn factors_mut(&mut self, nodes: usize) -> &mut [u32] {
        self.factors.resize(nodes, 0);
        &mut self.factors
    }

    /// Takes the offset `offset` about the column `centre2` / 2. The factors must already be those of nodes 2^`k` columns apart.
    pub(crate) fn take(&mut self, centre2: u32, k: u32, offset: i32) {
        let short = RowFactor::ONE.get() - self.factors.first().copied().unwrap_or(0);
        let start = 8 * i64::from(centre2) * i64::from(short) + (i64::from(offset) << BELOW);
        (self.k, self.offset, self.start) = (k, offset, start);
    }
}

/// G of the segment between two nodes with these factors.
#[inline]
pub(crate) fn curve([left, right]: [u32; 2], k: u32) -> i64 {
    ((i64::from(right) - i64::from(left)) >> 3) << (6 - k)
}

/// The parabola that S follows within a segment: start + i · (slope + i · curve) at its column i.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Parabola {
    /// S\[s · h\].
    start: i64,
    /// 16·Q\[s\].
    slope: i64,
    /// G\[s\].
    curve: i64,
}

impl RowValues {
    /// What the values are made of, to be filled in. Until [`Self::lay_out`] there are no values.
    pub(crate) fn nodes_mut(&mut self) -> &mut RowNodes {
        self.segments.clear();
        &mut self.nodes
    }

    pub(crate) fn nodes(&self) -> &RowNodes {
        &self.nodes
    }

    /// Computes where the segments start.
    pub(crate) fn lay_out(&mut self) {
        let RowNodes { k, mut start, ref factors, .. } = self.nodes;
        self.segments.clear();
        let nodes = factors.iter().zip(factors.iter().skip(1));
        self.segments.extend(nodes.map(|(&left, &right)| {
            let parabola = Parabola { start, slope: 16 * i64::from(left), curve: curve([left, right], k) };
            start += (i64::from(left) + i64::from(right)) << (k + 3);
            parabola
        }));
    }

    /// Takes the single factor of a row about the column `centre2` / 2.
    pub(crate) fn take_factor(&mut self, geometry: &Geometry, centre2: u32, row_factor: RowFactor) {
        let shape = GridShape::FINEST;
        let nodes = shape.segments(geometry) + 1;
        self.nodes.factors_mut(nodes).fill(row_factor.get());
        self.nodes.take(centre2, shape.k(), 0);
        self.lay_out();
    }

    /// O: how much farther right the row begins than with the factors alone, in units of 2^-13 column.
    #[must_use]
    pub fn offset(&self) -> i32 {
        self.nodes.offset
    }

    /// Q of every node, from the left, in units of 2^-24: 0 to 2^24.
    #[must_use]
    pub fn factors(&self) -> &[u32] {
        &self.nodes.factors
    }

    /// S of column `column`, 0 to W − 1, in units of 2^-28 column. It is exact; a board keeps it modulo 2^40.
    ///
    /// # Panics
    /// May panic when the row has no such column.
    #[must_use]
    pub fn coordinate(&self, column: usize) -> i64 {
        let Parabola { start, slope, curve } = self.segments[column >> self.nodes.k];
        let i = (column & ((1 << self.nodes.k) - 1)) as i64;
        start + i * (slope + i * curve)
    }

    /// Where the output of column `column`, 0 to W − 1, comes from. For a grid that no ring could serve, n is taken modulo
    /// 2^12, as on a board.
    ///
    /// # Panics
    /// May panic when the row has no such column.
    #[must_use]
    pub fn source(&self, column: usize) -> Source {
        locate(q_of_grid(self.coordinate(column)) & ((1 << (COORDINATE_BITS - BELOW)) - 1), column)
    }

    /// The output column at which the source column `source` appears: between two columns, or beyond the row's end at the rate
    /// there, but at most a row's width away.
    pub(crate) fn output(&self, source: f64) -> f64 {
        let columns = self.segments.len() << self.nodes.k;
        let at = |column: usize| self.coordinate(column) as f64 / f64::from(1 << 28);
        let (mut low, mut high) = (0, columns - 1);
        while high - low > 1 {
            let middle = usize::midpoint(low, high);
            *(if at(middle) <= source { &mut low } else { &mut high }) = middle;
        }
        let rate = at(high) - at(low);
        // A row whose source does not move shows no other source anywhere, and one whose source hardly moves at its end shows it
        // nowhere near.
        let found = low as f64 + if rate > 0.0 { (source - at(low)) / rate } else { 0.0 };
        found.clamp(-(columns as f64), 2.0 * columns as f64)
    }
}

/// q, in units of 2^-13 column, of an S of datapath 2, which is in units of 2^-28 column.
pub(crate) fn q_of_grid(coordinate: i64) -> i64 {
    (coordinate + (1 << (BELOW - 1))) >> BELOW
}
