//! The source of each output column in the row.

use super::values::{RowValues, UNSTRETCHED};

/// The source coordinate has 40 bits, unsigned. With an illegal table it wraps, as the register does.
const COORDINATE_MASK: u64 = (1 << 40) - 1;

/// The step from one coordinate to the next has 29 bits.
const STEP_MASK: u64 = (1 << 29) - 1;

/// Fractional bits that are dropped before the kernel's position is formed, and half a unit of what remains.
const DROPPED_BITS: u32 = 15;
pub(crate) const DROPPED_HALF: u64 = 1 << (DROPPED_BITS - 1);

/// Fractional bits of the position: five choose the node, eight interpolate.
pub(crate) const FRACTION_BITS: u32 = 13;

/// The source coordinate S of one output column after another, in units of 2^-28 column, made by two adders.
#[derive(Debug)]
pub(crate) struct Source {
    coordinate: u64,
    /// D, the step from this coordinate to the next.
    step: u64,
    /// 2·G, the change from this step to the next within a segment.
    bend: u64,
    /// Added to the coordinate before its last bits are dropped.
    rounding: u64,
    /// Columns that remain of the segment.
    left: u32,
    /// The node at the end of the segment.
    node: usize,
    values: RowValues,
}

/// A source coordinate, rounded to 2^-13 column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Position {
    /// The column at or left of the source, 0 to 4095.
    pub(crate) n: i32,
    /// The distance from that column to the source, in units of 2^-13 column.
    pub(crate) fraction: u32,
}

impl Source {
    /// S[0] = 8·C·(2^24 − Q[0]) + 2^15·O, from twice the column of the centre and the row's values. `rounding` is added to
    /// every coordinate before its last bits are dropped.
    pub(crate) fn new(centre2: u16, values: &RowValues, rounding: u64) -> Self {
        let first = values.factors.first().copied().unwrap_or(UNSTRETCHED);
        let shortfall = u64::from(UNSTRETCHED).wrapping_sub(first.into());
        let stretched = (8 * u64::from(centre2)).wrapping_mul(shortfall);
        let moved = i64::from(values.offset).cast_unsigned() << DROPPED_BITS;
        let mut source = Self {
            coordinate: stretched.wrapping_add(moved) & COORDINATE_MASK,
            step: 0,
            bend: 0,
            rounding,
            left: 0,
            node: 0,
            values: values.clone(),
        };
        source.begin_segment();
        source
    }

    /// S of the current column.
    #[cfg(test)]
    pub(super) fn coordinate(&self) -> u64 {
        self.coordinate
    }

    /// The position of the current column. Moves on to the next column.
    #[inline]
    pub(crate) fn advance(&mut self) -> Position {
        let position = self.position();
        self.coordinate = (self.coordinate + self.step) & COORDINATE_MASK;
        self.step = (self.step + self.bend) & STEP_MASK;
        self.left -= 1;
        if self.left == 0 {
            self.begin_segment();
        }
        position
    }

    /// The position of the current column.
    pub(crate) fn position(&self) -> Position {
        let rounded = ((self.coordinate + self.rounding) & COORDINATE_MASK) >> DROPPED_BITS;
        let fraction = rounded as u32 & ((1 << FRACTION_BITS) - 1);
        Position { n: (rounded >> FRACTION_BITS) as i32, fraction }
    }

    /// Sets D = 16·Q[s] + G[s]. After the last node, where a row with a single factor already begins, all steps are equal.
    #[cold]
    fn begin_segment(&mut self) {
        let RowValues { factors, k, .. } = &self.values;
        let first = factors.get(self.node).or(factors.last()).copied().unwrap_or(UNSTRETCHED);
        self.node += 1;
        let (bend, columns) = match factors.get(self.node) {
            None => (0, u32::MAX),
            Some(&next) => (((i64::from(next) - i64::from(first)) >> 3) << (6 - k), 1 << k),
        };
        self.step = (16 * u64::from(first)).wrapping_add_signed(bend) & STEP_MASK;
        (self.bend, self.left) = ((2 * bend).cast_unsigned() & STEP_MASK, columns);
    }
}
