//! Where the outputs of a row come from, a block of columns at a time.
//!
//! Coordinates here are S with half a unit of q added, so that dropping bits rounds; their unit is 2^-26 column. S of a grid
//! has two more bits, which nothing depends on once that half is added.
#![cfg_attr(not(target_arch = "x86_64"), allow(dead_code, reason = "vectors need more than plain Rust does"))]

use super::BLOCK;
use super::padded::LEFT;
use crate::grid::{RowNodes, curve};
use crate::{Geometry, RowFactor};

/// Bits of a coordinate below n.
const FRACTION: u32 = 26;

/// One column.
const COLUMN: u32 = 1 << FRACTION;

/// Steps through a row's sources, block after block.
pub(super) trait Walk {
    /// Whether the distance from one source to the next changes along the row.
    const CURVED: bool;

    /// The next block. What lies beyond the row means nothing.
    fn next(&mut self) -> Start;

    /// [`Start::step`] of a row with a single factor.
    fn step(&self) -> u32;
}

/// Where a block of columns finds its samples.
///
/// A column's *displacement* is its coordinate minus that of the block's origin and minus the column's place in the block: how
/// far the sources have fallen back since the origin against one column per output, from 2 columns to −31. An even number of
/// columns leads to a sample of the output's colour. So the lower 14 bits of the displacement, in units of q, are x, and the
/// bits above are (a − the column) / 2.
///
/// Displacements follow a parabola, modulo 2^32: d\[2j\] = d\[0\] + j · (2 · `step` + j · `bend`) and d\[2j + 1\] = d\[2j\] +
/// `half` + j · `bend`. S of column i contains i² · G, in units a quarter as large. For even columns that is exactly j² · G;
/// for odd ones it is (j² + j) · G plus a quarter of G, the only part that must be rounded.
///
/// a is n or n − 1, and n moves by 0 or 1 a column. So, counted from the lesser of the first two outputs' bases, the bases of N
/// columns lie within N samples.
#[derive(Clone, Copy)]
pub(super) struct Start {
    /// The sample of the padded row that is tap G0 for the base `least`, the least base of the block.
    pub(super) first: isize,
    /// The origin (the even column at or left of the first n) minus `least`: 0 or 1.
    pub(super) lead: bool,
    /// The displacement d\[0\] of the first column: 27 bits.
    pub(super) displacement: u32,
    /// Half the change from the first even column to the next, if there were no bend.
    pub(super) step: u32,
    /// The change from the first column to the second.
    pub(super) half: u32,
    /// G.
    pub(super) bend: u32,
}

impl Start {
    /// From the coordinate of the first column, and how it continues.
    #[inline]
    fn new(own: i64, step: u32, half: u32, bend: u32) -> Self {
        let displacement = own as u32 % (2 * COLUMN);
        let even = own >> (FRACTION + 1);
        // The second column's displacement is negative.
        let lead = displacement.wrapping_add(half) >> 31 != 0;
        let first = 2 * even as isize + LEFT as isize - 2 - isize::from(lead);
        Self { first, lead, displacement, step, half, bend }
    }

    /// The displacements of the block by additions, four columns at a time, in a form that compilers vectorise.
    #[inline]
    pub(super) fn displacements(&self) -> [u32; BLOCK] {
        let &Self { displacement, step, half, bend, .. } = self;
        let third = displacement.wrapping_add(step.wrapping_mul(2)).wrapping_add(bend);
        let mut four = [
            displacement,
            displacement.wrapping_add(half),
            third,
            third.wrapping_add(half).wrapping_add(bend),
        ];
        let mut ways =
            [4, 6, 8, 10].map(|bends: u32| bends.wrapping_mul(bend).wrapping_add(step.wrapping_mul(4)));
        let mut displacements = [0; BLOCK];
        for columns in displacements.as_chunks_mut().0 {
            *columns = four;
            for (column, way) in four.iter_mut().zip(&mut ways) {
                *column = column.wrapping_add(*way);
                *way = way.wrapping_add(bend.wrapping_mul(8));
            }
        }
        displacements
    }
}

/// Each column's place in its block, counted from `least`: [`Start::lead`] more than when counted from the origin.
pub(super) const LEADS: [[u16; BLOCK]; 2] = {
    let mut leads = [[0; BLOCK]; 2];
    let mut column = 0;
    while column < BLOCK {
        leads[0][column] = column as u16;
        leads[1][column] = column as u16 + 1;
        column += 1;
    }
    leads
};

/// The walk along a row with a single factor.
pub(super) struct Line {
    /// The coordinate of the next block's first column.
    own: i64,
    /// 4Q, the distance from one source to the next: at most one column.
    stride: u32,
}

impl Line {
    pub(super) fn new(geometry: &Geometry, row_factor: RowFactor) -> Self {
        let start = i64::from(geometry.centre2()) * i64::from(RowFactor::ONE.get() - row_factor.get());
        Self { own: 2 * (start + (1 << 11)), stride: 4 * row_factor.get() }
    }
}

impl Walk for Line {
    const CURVED: bool = false;

    #[inline]
    fn next(&mut self) -> Start {
        let start = Start::new(self.own, self.step(), self.step(), 0);
        self.own += BLOCK as i64 * i64::from(self.stride);
        start
    }

    #[inline]
    fn step(&self) -> u32 {
        self.stride.wrapping_sub(COLUMN)
    }
}

/// The walk along a grid's row.
pub(super) struct Curve<'a> {
    factors: &'a [u32],
    k: u32,
    /// The next block's first column.
    column: usize,
    /// S there, plus half a unit of q.
    own: i64,
    /// The slope of S there.
    slope: i64,
    /// G.
    curve: i64,
}

impl<'a> Curve<'a> {
    pub(super) fn new(nodes: &'a RowNodes) -> Self {
        let slope = 16 * i64::from(nodes.factors.first().copied().unwrap_or_default());
        Self { factors: &nodes.factors, k: nodes.k, column: 0, own: nodes.start + HALF, slope, curve: 0 }
    }
}

/// Half a unit of q, in units of a grid's S.
const HALF: i64 = 1 << 14;

/// Bits of a grid's S below a coordinate. At the beginning of a block they are 0, and so are those of the slope there.
const BELOW: u32 = 2;

impl Walk for Curve<'_> {
    const CURVED: bool = true;

    #[inline]
    fn next(&mut self) -> Start {
        // A segment holds whole blocks, and the slope is continuous from one segment to the next.
        let nodes = self.factors.get(self.column >> self.k..).unwrap_or_default();
        if let Some(&nodes) = nodes.first_chunk() {
            self.curve = curve(nodes, self.k);
        }
        let step = ((self.slope >> BELOW) as u32).wrapping_sub(COLUMN);
        let half = step.wrapping_add((self.curve >> BELOW) as u32);
        let start = Start::new(self.own >> BELOW, step, half, self.curve as u32);
        let columns = BLOCK as i64;
        self.own += columns * (self.slope + columns * self.curve);
        self.slope += 2 * columns * self.curve;
        self.column += BLOCK;
        start
    }

    fn step(&self) -> u32 {
        0
    }
}

/// The blocks that cover a row. The last one may extend beyond it.
pub(super) fn blocks(width: usize) -> impl Iterator<Item = usize> {
    (0..width).step_by(BLOCK)
}
