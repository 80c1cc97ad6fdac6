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

    /// The block that starts at `column`, which is even.
    fn start(self, column: usize) -> Start;

    /// How far one output is from the next; 0 where that changes.
    fn stride(self) -> u32;

    /// The coordinate of `column`, which is in the block that `start` starts, relative to it.
    fn relative(self, column: usize, start: &Start) -> u32;

    /// Those of the block that starts at `column`.
    fn relatives(self, column: usize, start: &Start) -> [u32; BLOCK];
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
    /// The coordinate of that even column.
    origin: i64,
    /// The way of a whole block within one segment.
    pub(super) piece: Piece,
}

impl Start {
    /// Of the coordinates of the first two columns.
    #[inline]
    fn new(own: i64, next: i64, piece: Piece) -> Self {
        let even = own >> (FRACTION + 1);
        let origin = even << (FRACTION + 1);
        let lead = next - origin < 1 << FRACTION;
        let first = 2 * even as isize + LEFT as isize - 2 - isize::from(lead);
        Self { first, relative: (own - origin) as u32, lead, origin, piece }
    }
}

/// A parabola about the middle of a block: `middle` + i · `slope` + ((i² · `curve` + `rest`) >> 3), with i from −16 on. All of
/// it keeps within 31 bits.
#[derive(Clone, Copy, Default)]
pub(super) struct Piece {
    /// The coordinate in the middle, less that of the first column.
    pub(super) middle: u32,
    /// The three bits below it.
    pub(super) rest: u32,
    /// How far one output is from the next there.
    pub(super) slope: u32,
    /// G.
    pub(super) curve: i32,
}

impl Piece {
    /// The coordinates of the block whose first column has the coordinate `first`, each by itself: what compilers make vectors of.
    #[inline]
    fn coordinates(self, first: u32) -> [u32; BLOCK] {
        let middle = first.wrapping_add(self.middle);
        let mut relatives = [0; BLOCK];
        for (index, relative) in relatives.iter_mut().enumerate() {
            let i = index as i32 - MIDDLE as i32;
            let bent = (i * i).wrapping_mul(self.curve).wrapping_add(self.rest.cast_signed()) >> 3;
            let straight = i.cast_unsigned().wrapping_mul(self.slope);
            *relative = middle.wrapping_add(straight).wrapping_add(bent.cast_unsigned());
        }
        relatives
    }
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
    fn start(self, column: usize) -> Start {
        let own = self.origin + column as i64 * i64::from(self.stride);
        Start::new(own, own + i64::from(self.stride), Piece::default())
    }

    fn stride(self) -> u32 {
        self.stride
    }

    fn relative(self, column: usize, start: &Start) -> u32 {
        (self.origin + column as i64 * i64::from(self.stride) - start.origin) as u32
    }

    #[inline]
    fn relatives(self, _: usize, start: &Start) -> [u32; BLOCK] {
        std::array::from_fn(|index| start.relative + index as u32 * self.stride)
    }
}

/// The way of a grid's row.
#[derive(Clone, Copy)]
pub(super) struct Curve<'a> {
    segments: &'a [Parabola],
    /// The binary logarithm of a segment's columns.
    k: u32,
}

impl<'a> Curve<'a> {
    pub(super) fn new(values: &'a RowValues) -> Self {
        let (segments, k) = values.segments();
        Self { segments, k }
    }

    /// The coordinates of a block that lies across two segments.
    #[cold]
    #[inline(never)]
    fn scattered(self, column: usize, start: &Start) -> [u32; BLOCK] {
        std::array::from_fn(|index| self.relative(column + index, start))
    }

    /// S of `column` with half a unit of q, how it would go on along a line, and how it bends.
    #[inline]
    fn at(self, column: usize) -> [i64; 3] {
        let Parabola { start, slope, curve } = self.segments[column >> self.k];
        let i = (column & ((1 << self.k) - 1)) as i64;
        let turned = i * curve;
        [start + HALF + i * (slope + turned), slope + 2 * turned, curve]
    }
}

/// S of a grid for half a unit of q.
const HALF: i64 = 1 << 14;

/// Columns of half a block.
const MIDDLE: i64 = BLOCK as i64 / 2;

impl Walk for Curve<'_> {
    const CURVED: bool = true;

    #[inline]
    fn start(self, column: usize) -> Start {
        let [own, slope, curve] = self.at(column);
        let middle = own + MIDDLE * (slope + MIDDLE * curve);
        let piece = Piece {
            middle: ((middle >> 3) - (own >> 3)) as u32,
            rest: (middle & 7) as u32,
            slope: ((slope + 2 * MIDDLE * curve) >> 3) as u32,
            curve: curve as i32,
        };
        Start::new(own >> 3, (own + slope + curve) >> 3, piece)
    }

    fn stride(self) -> u32 {
        0
    }

    fn relative(self, column: usize, start: &Start) -> u32 {
        ((self.at(column)[0] >> 3) - start.origin) as u32
    }

    #[inline]
    fn relatives(self, column: usize, start: &Start) -> [u32; BLOCK] {
        if !is_within_segment(column) {
            return self.scattered(column, start);
        }
        start.piece.coordinates(start.relative)
    }
}

/// Whether the block at `column` lies within one segment: the last of a row, which ends with it, may not.
#[inline]
pub(super) fn is_within_segment(column: usize) -> bool {
    column.is_multiple_of(BLOCK)
}

/// The starts of the blocks of `block` columns that cover a row. The last one is moved left to end with the row.
pub(super) fn blocks(width: usize, block: usize) -> impl Iterator<Item = usize> {
    (0..width).step_by(block).map(move |column| column.min(width - block))
}
