//! Where the outputs of a row come from, a block of columns at a time.
//!
//! Coordinates here are S with half a unit of q added, so that dropping bits rounds, in units of 2^-25 column. S of a grid
//! has three bits more, which nothing depends on once that half is in.
#![cfg_attr(not(target_arch = "x86_64"), allow(dead_code, reason = "vectors need more than plain Rust does"))]

use super::BLOCK;
use super::padded::LEFT;
use crate::grid::Parabola;
use crate::{Geometry, RowFactor, RowValues};

/// Bits of a coordinate below those of n.
const FRACTION: u32 = 25;

/// Where a row's outputs come from.
pub(super) trait Walk: Copy {
    /// Whether the way from one output to the next changes along the row.
    const CURVED: bool;

    /// The coordinate of `column`.
    fn coordinate(self, column: usize) -> i64;

    /// The coordinates of `column`, which is even, and of the one behind it.
    fn pair(self, column: usize) -> [i64; 2];

    /// How far one output is from the next; 0 where that changes.
    fn stride(self) -> u32;

    /// The coordinates of the `columns` columns from `column` on as one parabola; none where they are not of one.
    fn piece(self, column: usize, columns: usize, start: &Start) -> Option<Piece>;

    /// The coordinate of `column`, less than a block right of where `start` is.
    fn relative(self, column: usize, start: &Start) -> u32 {
        (self.coordinate(column) - start.origin()) as u32
    }

    /// Those of the block that starts at `column`.
    fn relatives(self, column: usize, start: &Start) -> [u32; BLOCK];

    /// The block that starts at `column`, which is even.
    #[inline]
    fn start(self, column: usize) -> Start {
        let [own, next] = self.pair(column);
        let even = own >> (FRACTION + 1);
        let [relative, next] = [own, next].map(|coordinate| (coordinate - (even << (FRACTION + 1))) as u32);
        let lead = next < 1 << FRACTION;
        let first = first_tap(2 * even as isize) - isize::from(lead);
        Start { first, relative, lead, even: even as isize }
    }
}

/// Where a block of columns that starts at an even one finds its samples.
///
/// n moves by 0 or 1 a column. So does the last column with the output's colour at or left of it, but for a first move
/// back: from the lesser of the first two outputs' bases on, a block of N columns has its bases within N samples.
#[derive(Clone, Copy)]
pub(super) struct Start {
    /// The padded row's sample of tap G0 for base column `least`, the least base of the block.
    pub(super) first: isize,
    /// The coordinate of the first column from the even column at or left of n on: 26 bits.
    pub(super) relative: u32,
    /// That even column − `least`, 0 or 1.
    pub(super) lead: bool,
    /// Half of that even column.
    even: isize,
}

impl Start {
    /// The coordinate that others are relative to.
    fn origin(&self) -> i64 {
        (self.even as i64) << (FRACTION + 1)
    }
}

/// A parabola about the middle of some columns: `middle` + i · `slope` + ((i² · `curve` + `rest`) >> 3), with i from −half of
/// them on. Up to 32 columns keep all of it within 31 bits.
#[derive(Clone, Copy)]
pub(super) struct Piece {
    /// The coordinate in the middle, relative to the block's.
    pub(super) middle: u32,
    /// The three bits below it.
    pub(super) rest: u32,
    /// How far one output is from the next there.
    pub(super) slope: u32,
    /// G.
    pub(super) curve: i32,
}

/// What is added to ((n + column) & !1), with both counted from even columns, for a − `least`: [`Start::lead`] less the
/// column's parity.
pub(super) const LEADS: [[u16; BLOCK]; 2] = {
    let mut leads = [[0; BLOCK]; 2];
    let mut column = 0;
    while column < BLOCK {
        leads[0][column] = (column as u16 % 2).wrapping_neg();
        leads[1][column] = 1 - column as u16 % 2;
        column += 1;
    }
    leads
};

/// The padded row's sample of tap G0 for base column `base`.
fn first_tap(base: isize) -> isize {
    base + LEFT as isize - 2
}

/// The way of one factor.
#[derive(Clone, Copy)]
pub(super) struct Line {
    origin: i64,
    /// 2Q, from one output to the next: at most one column, 2^25.
    stride: u32,
}

impl Line {
    pub(super) fn new(geometry: &Geometry, row_factor: RowFactor) -> Self {
        let start = i64::from(geometry.centre2()) * i64::from(RowFactor::ONE.get() - row_factor.get());
        Self { origin: start + (1 << 11), stride: 2 * row_factor.get() }
    }
}

impl Walk for Line {
    const CURVED: bool = false;

    #[inline]
    fn coordinate(self, column: usize) -> i64 {
        self.origin + column as i64 * i64::from(self.stride)
    }

    #[inline]
    fn pair(self, column: usize) -> [i64; 2] {
        let own = self.coordinate(column);
        [own, own + i64::from(self.stride)]
    }

    fn stride(self) -> u32 {
        self.stride
    }

    #[inline]
    fn relatives(self, _: usize, start: &Start) -> [u32; BLOCK] {
        std::array::from_fn(|index| start.relative + index as u32 * self.stride)
    }

    fn piece(self, _: usize, _: usize, _: &Start) -> Option<Piece> {
        None
    }
}

/// The way of a grid's row.
#[derive(Clone, Copy)]
pub(super) struct Curve<'a>(pub(super) &'a RowValues);

impl Curve<'_> {
    /// The parabola of `column`'s segment, and the column's place in it.
    #[inline]
    fn segment(self, column: usize) -> (Parabola, i64) {
        let pitch = self.0.pitch();
        (self.0.parabola(column / pitch), (column % pitch) as i64)
    }
}

/// S of a grid with half a unit of q.
const HALF: i64 = 1 << 14;

impl Walk for Curve<'_> {
    const CURVED: bool = true;

    #[inline]
    fn coordinate(self, column: usize) -> i64 {
        (self.0.coordinate(column) + HALF) >> 3
    }

    #[inline]
    fn pair(self, column: usize) -> [i64; 2] {
        let (Parabola { start, slope, curve }, i) = self.segment(column);
        let own = start + HALF + i * (slope + i * curve);
        [own >> 3, (own + slope + (2 * i + 1) * curve) >> 3]
    }

    fn stride(self) -> u32 {
        0
    }

    #[inline]
    fn relatives(self, column: usize, start: &Start) -> [u32; BLOCK] {
        if !column.is_multiple_of(BLOCK) {
            return std::array::from_fn(|index| self.relative(column + index, start));
        }
        let (Parabola { start: first, slope, curve }, i) = self.segment(column);
        let mut own = first + HALF + i * (slope + i * curve) - (start.origin() << 3);
        let mut stride = slope + (2 * i + 1) * curve;
        std::array::from_fn(|_| {
            let relative = (own >> 3) as u32;
            own += stride;
            stride += 2 * curve;
            relative
        })
    }

    #[inline]
    fn piece(self, column: usize, columns: usize, start: &Start) -> Option<Piece> {
        if !column.is_multiple_of(columns) {
            return None;
        }
        let (Parabola { start: first, slope, curve }, i) = self.segment(column);
        let i = i + columns as i64 / 2;
        let middle = first + HALF + i * (slope + i * curve);
        Some(Piece {
            middle: ((middle >> 3) - start.origin()) as u32,
            rest: (middle & 7) as u32,
            slope: ((slope + 2 * i * curve) >> 3) as u32,
            curve: curve as i32,
        })
    }
}

/// The starts of the blocks of `block` columns that cover a row. The last one is moved left to end with the row.
pub(super) fn blocks(width: usize, block: usize) -> impl Iterator<Item = usize> {
    (0..width).step_by(block).map(move |column| column.min(width - block))
}
