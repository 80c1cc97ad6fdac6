//! Settings that no plan has, each for two frames at the full pixel clock: other sizes, depths, centres, factors and
//! kernels, so that every bit of a setting, of an address and of a weight has both levels once; and grids. A burst takes
//! next to no time on a link.

use halfrow_model::{Geometry, Kernel, MIN_WIDTH, NODES, RowFactor, TableSet};
use rand_core::Rng;
use rand_pcg::Pcg64Mcg;

use super::grids::grid_corners;
use crate::board::Capabilities;
use crate::run::plan::variations::Build;
use crate::tables::Generation;

/// About how many samples a corner's frame with long rows has.
const SAMPLES: usize = 1 << 15;
/// The generation of the first corner's tables. The others follow; none of them is a plan's.
const FIRST: u8 = 64;
/// The generation of the first grid.
const FIRST_OF_GRIDS: u8 = FIRST + 8;
/// Bits of a setting, 0 and 1 by turns, and the other way round.
pub(in crate::run) const BY_TURNS: [usize; 2] = [0x5555, 0xaaaa];
/// The bits by which random weights of 16 bits are shifted down: for weights of any sign and size, and for weights with
/// which few samples reach the end of their range.
pub(in crate::run) const WILD: u32 = 0;
pub(in crate::run) const CALM: u32 = 3;

/// Tables for each corner of a board's settings, one set for each of its table banks, drawn from `seed`.
pub(super) fn corners(capabilities: &Capabilities, seed: u64) -> Vec<Vec<Generation>> {
    let build = Build::of(capabilities);
    let mut draws = Pcg64Mcg::new(u128::from(seed) | 1 << 64);
    let most = usize::from(capabilities.max_width).min(build.ring);
    let rows = usize::from(capabilities.max_height);
    let long = |width: usize| (SAMPLES / width).min(rows);
    let by_turns = BY_TURNS.map(|bits| fit(bits, most).max(MIN_WIDTH) & !1);
    let sizes = [by_turns[0], by_turns[1], most & !1].map(|width| (width, long(width)));
    // One row less than the most has the other level in most bits.
    let tall = (MIN_WIDTH, rows.saturating_sub(1).max(1));
    let corner = |(place, (width, height)): (usize, (usize, usize))| {
        let depth = *build.depths.get(place % build.depths.len().max(1))?;
        let last = 2 * width - 2;
        let centre2 = [fit(BY_TURNS[place % 2], last), fit(BY_TURNS[place % 2], last), last, 0][place];
        let geometry = Geometry::new(width, height, depth, centre2 as u32).ok()?;
        let banks = [CALM, WILD].into_iter().take(build.table_banks.into());
        let tables = banks.map(|size| {
            let number = FIRST + 2 * place as u8 + u8::from(size == WILD);
            let kernel = drawn_kernel(build.taps, size, &mut draws)?;
            Some(Generation { number, tables: drawn_factors(geometry, build.ring, &mut draws)?, kernel })
        });
        tables.collect()
    };
    let mut corners: Vec<_> = sizes.into_iter().chain([tall]).enumerate().filter_map(corner).collect();
    corners.extend(grid_corners(capabilities, FIRST_OF_GRIDS, &mut draws));
    corners
}

/// Sizes, depths and centres of the frames of all corners.
pub(in crate::run) fn geometries_of_corners(capabilities: &Capabilities, seed: u64) -> Vec<Geometry> {
    let made = corners(capabilities, seed).into_iter().flatten();
    made.map(|made| *made.tables.geometry()).collect()
}

/// As many low bits of `pattern` as do not exceed `most`.
pub(in crate::run) fn fit(pattern: usize, most: usize) -> usize {
    let bits = (1..=usize::BITS - most.leading_zeros()).rev();
    bits.map(|bits| pattern & ((1 << bits) - 1)).find(|&value| value <= most).unwrap_or(0)
}

/// The largest factor in row 0, then random ones of every size that a ring of `ring` samples allows.
pub(in crate::run) fn drawn_factors(
    geometry: Geometry,
    ring: usize,
    draws: &mut Pcg64Mcg,
) -> Option<TableSet> {
    let row = Geometry::new(geometry.width(), 1, geometry.depth(), geometry.centre2()).ok()?;
    let is_legal = |factor: &RowFactor| {
        TableSet::new(row, vec![*factor]).is_ok_and(|tables| tables.check_ring(ring).is_ok())
    };
    let factor = |_| {
        let drawn = RowFactor::new(draws.next_u32() & ((1 << 24) - 1) | 1).unwrap_or(RowFactor::ONE);
        let nearer = drawn.midpoint(RowFactor::ONE);
        [drawn, nearer, nearer.midpoint(RowFactor::ONE)].into_iter().find(is_legal).unwrap_or(RowFactor::ONE)
    };
    let others = (1..geometry.height()).map(factor);
    TableSet::new(geometry, std::iter::once(RowFactor::ONE).chain(others).collect()).ok()
}

/// The nodes of a block of a wild kernel.
const BLOCK: usize = 8;

/// In every other block of nodes of a wild kernel, a weight at the end of its range, at the lower and the upper one by turns: a
/// weighted sum needs all of its bits only if all weights are there.
fn at_the_end(node: usize, size: u32) -> Option<i16> {
    let (block, ends) = (node / BLOCK, [i16::MIN, i16::MAX]);
    (size == WILD && block % 2 == 1).then(|| ends[block / 2 % 2])
}

/// Random weights of any sign, and of any size that 16 bits shifted down by `size` can have.
pub(in crate::run) fn drawn_kernel(taps: u8, size: u32, draws: &mut Pcg64Mcg) -> Option<Kernel> {
    let weight = |tap: usize, node: usize, drawn: u32| {
        let is_outer = tap == 0 || tap == 4;
        if is_outer && taps < 7 { 0 } else { at_the_end(node, size).unwrap_or((drawn >> 16) as i16 >> size) }
    };
    let nodes = (0..NODES).map(|node| std::array::from_fn(|tap| weight(tap, node, draws.next_u32())));
    Kernel::from_nodes(nodes.collect()).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// DATAPATH.md, "Signed bits that hold every legal case": the sum has 31, and 30 must be too few.
    #[test]
    fn some_sum_of_a_wild_kernel_needs_all_of_its_bits() {
        let kernel = drawn_kernel(7, WILD, &mut Pcg64Mcg::new(1)).unwrap();
        let most = |[g0, r1, g4, r5, g6]: &[i16; 5]| {
            // G2 black and R3 white, or the other way round, and all others so that the sum is largest.
            let all = [g0, r1, g4, r5, g6].map(|&weight| i64::from(weight));
            let sum = |signs: [i64; 5]| {
                all.iter().zip(signs).map(|(weight, sign)| weight * sign * 4095).sum::<i64>()
            };
            [sum([1, -1, 1, -1, 1]), sum([1, 1, 1, 1, 1])].map(i64::abs).into_iter().max().unwrap_or(0)
        };
        let nodes = kernel.nodes().iter().filter(|node| most(node) >= 1 << 29).count();
        assert!(nodes >= 32, "{nodes}");
    }
}
