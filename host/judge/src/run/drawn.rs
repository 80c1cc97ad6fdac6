//! Random factors and kernels, and settings of which every bit changes, for tables that no plan has.

use halfrow_model::{Geometry, Kernel, NODES, RowFactor, TableSet};
use rand_core::Rng;
use rand_pcg::Pcg64Mcg;

/// Bits of a setting, 0 and 1 by turns, and the other way round.
pub(super) const BY_TURNS: [usize; 2] = [0x5555, 0xaaaa];

/// How large the weights of a random kernel are.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Weights {
    /// Of any size.
    Wild,
    /// So small that few samples reach the end of their range.
    Calm,
}

/// As many low bits of `pattern` as do not exceed `most`.
pub(super) fn fit(pattern: usize, most: usize) -> usize {
    let bits = (1..=usize::BITS - most.leading_zeros()).rev();
    bits.map(|bits| pattern & ((1 << bits) - 1)).find(|&value| value <= most).unwrap_or(0)
}

/// The largest factor in row 0, then random ones of every size that a ring of `ring` samples allows.
pub(super) fn drawn_factors(geometry: Geometry, ring: usize, draws: &mut Pcg64Mcg) -> Option<TableSet> {
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
fn at_the_end(node: usize) -> Option<i16> {
    let (block, ends) = (node / BLOCK, [i16::MIN, i16::MAX]);
    (block % 2 == 1).then(|| ends[block / 2 % 2])
}

/// Random weights of any sign.
pub(super) fn drawn_kernel(taps: u8, weights: Weights, draws: &mut Pcg64Mcg) -> Option<Kernel> {
    let weight = |tap: usize, node: usize, drawn: u32| {
        let (is_outer, drawn) = (tap == 0 || tap == 4, (drawn >> 16) as i16);
        match weights {
            _ if is_outer && taps < 7 => 0,
            Weights::Wild => at_the_end(node).unwrap_or(drawn),
            Weights::Calm => drawn >> 3,
        }
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
        let kernel = drawn_kernel(7, Weights::Wild, &mut Pcg64Mcg::new(1)).unwrap();
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
