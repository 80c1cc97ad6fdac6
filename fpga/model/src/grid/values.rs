//! The values of a row: what the datapath finds of a table before the row leaves (DATAPATH.md, "Values of a row").

use crate::corrector::{Source, locate};
use crate::{Geometry, GridShape, RowFactor};

/// Bits of a source coordinate: a board keeps S modulo 2^40.
const COORDINATE_BITS: u32 = 40;

/// Bits of S below those of q.
const BELOW: u32 = 15;

/// O and Q\[0\] to Q\[N\] of a row, and where its segments start. One factor a row is O = 0 and that factor at every node.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RowValues {
    /// The binary logarithm of a segment's columns.
    k: u32,
    offset: i32,
    factors: Vec<u32>,
    /// How S goes in each segment, 0 to N − 1.
    segments: Vec<Parabola>,
}

/// The parabola that S follows within a segment: start + i · (slope + i · curve) at its column i.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Parabola {
    /// S\[s · h\].
    pub(crate) start: i64,
    /// 16·Q\[s\].
    pub(crate) slope: i64,
    /// G\[s\].
    pub(crate) curve: i64,
}

impl RowValues {
    /// The factors of `nodes` nodes, to be filled in before [`Self::take`].
    pub(crate) fn factors_mut(&mut self, nodes: usize) -> &mut [u32] {
        self.factors.resize(nodes, 0);
        &mut self.factors
    }

    /// Takes the offset `offset`, for factors that are those of nodes 2^`k` columns apart.
    pub(crate) fn take(&mut self, geometry: &Geometry, k: u32, offset: i32) {
        (self.k, self.offset) = (k, offset);
        self.segments.clear();
        let short = RowFactor::ONE.get() - self.factors.first().copied().unwrap_or(0);
        let mut start = 8 * i64::from(geometry.centre2()) * i64::from(short) + (i64::from(offset) << BELOW);
        let nodes = self.factors.iter().zip(self.factors.iter().skip(1));
        self.segments.extend(nodes.map(|(&left, &right)| {
            let [left, right] = [left, right].map(i64::from);
            let curve = ((right - left) >> 3) << (6 - k);
            let parabola = Parabola { start, slope: 16 * left, curve };
            start += (left + right) << (k + 3);
            parabola
        }));
    }

    /// Takes the one factor of a row.
    pub(crate) fn take_factor(&mut self, geometry: &Geometry, row_factor: RowFactor) {
        let shape = GridShape::FINEST;
        let nodes = shape.segments(geometry) + 1;
        self.factors_mut(nodes).fill(row_factor.get());
        self.take(geometry, shape.k(), 0);
    }

    /// O: how much farther right the row begins than the factors alone tell, in units of 2^-13 column.
    #[must_use]
    pub fn offset(&self) -> i32 {
        self.offset
    }

    /// Q of every node from the left in units of 2^-24, 0 to 2^24.
    #[must_use]
    pub fn factors(&self) -> &[u32] {
        &self.factors
    }

    /// S of column `column`, 0 to W − 1, in units of 2^-28 column; exactly, where a board keeps it modulo 2^40.
    ///
    /// # Panics
    /// When the row has no such column.
    #[must_use]
    pub fn coordinate(&self, column: usize) -> i64 {
        let Parabola { start, slope, curve } = self.segments[column >> self.k];
        let i = (column & ((1 << self.k) - 1)) as i64;
        start + i * (slope + i * curve)
    }

    /// Where the output of column `column`, 0 to W − 1, comes from. Of a grid that no ring could serve n is what a board
    /// has, modulo 2^12.
    ///
    /// # Panics
    /// When the row has no such column.
    #[must_use]
    pub fn source(&self, column: usize) -> Source {
        locate(rounded(self.coordinate(column)) & ((1 << (COORDINATE_BITS - BELOW)) - 1), column)
    }

    /// Where the output lies that comes from the column `source`: between two columns, or beyond the row's end at the rate
    /// there.
    pub(crate) fn output(&self, source: f64) -> f64 {
        let columns = self.segments.len() << self.k;
        let at = |column: usize| self.coordinate(column) as f64 / f64::from(1 << 28);
        let (mut low, mut high) = (0, columns - 1);
        while high - low > 1 {
            let middle = usize::midpoint(low, high);
            *(if at(middle) <= source { &mut low } else { &mut high }) = middle;
        }
        let rate = at(high) - at(low);
        // A row that does not move at all shows no other source anywhere.
        low as f64 + if rate > 0.0 { (source - at(low)) / rate } else { 0.0 }
    }

    /// How S goes in each segment of 2^k columns, and k.
    pub(crate) fn segments(&self) -> (&[Parabola], u32) {
        (&self.segments, self.k)
    }
}

/// q: S rounded to 2^-13 column.
pub(crate) fn rounded(coordinate: i64) -> i64 {
    (coordinate + (1 << (BELOW - 1))) >> BELOW
}
