//! The sources of a block as a path found them, for checks.

use super::BLOCK;
use super::padded::LEFT;
use crate::Source;

/// Where a block's outputs come from.
pub(super) struct Located {
    /// Like [`Start`](super::walk::Start)'s.
    pub(super) first: isize,
    /// a of each column, counted from the block's least one.
    pub(super) base: [u16; BLOCK],
    /// x of each column, the lower 14 bits.
    pub(super) x: [u16; BLOCK],
}

impl Located {
    /// The oracle's sources, with the least base taken as two columns left of the row.
    pub(super) fn by_oracle(column: usize, source: impl Fn(usize) -> Source) -> Self {
        let sources: [Source; BLOCK] = std::array::from_fn(|index| source(column + index));
        Self {
            first: LEFT as isize - 4,
            base: sources.map(|source| (source.base + 2) as u16),
            x: sources.map(|source| (source.node << 8) as u16 | source.fraction as u16),
        }
    }

    /// Writes a of each column, −1 to W − 1, and x. n is taken modulo 2^12, which matters only where the row is not legal.
    pub(super) fn write(&self, bases: &mut [i16], distances: &mut [u16]) {
        let least = self.first + 2 - LEFT as isize;
        for (((place, distance), base), x) in bases.iter_mut().zip(distances).zip(self.base).zip(self.x) {
            let back = (x >> 13 & 1) as i16;
            let n = (least + isize::from(base.cast_signed())) as i16 + back;
            *place = (n & 0xfff) - back;
            *distance = x & 0x3fff;
        }
    }
}
