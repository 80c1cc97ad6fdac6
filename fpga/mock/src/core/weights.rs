//! The weighted sum: weights interpolated between the kernel's nodes, times the taps.

use super::kernel::{Kernel, NODES};
use super::source::FRACTION_BITS;
use super::window::TAPS;

/// Fractional bits of a weight.
const WEIGHT_BITS: u32 = 14;

/// Half of the last bit that an output keeps.
pub(crate) const ROUNDING: i32 = 1 << (WEIGHT_BITS - 1);

/// Bits of the position between two nodes.
const BETWEEN_BITS: u32 = FRACTION_BITS - 5;

/// How the weights of an output come from the kernel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Weighing {
    /// As specified.
    #[default]
    Right,
    /// From words without a sign.
    Unsigned,
    /// With the product between two nodes rounded toward zero.
    TowardZero,
    /// Between the two nodes after the right ones.
    NextNode,
}

/// The five weights of one output, in units of 2^-14.
pub(crate) struct Weights {
    g0: i32,
    r1: i32,
    g4: i32,
    r5: i32,
    g6: i32,
}

impl Weights {
    /// The kernel's weights at `x` of 2^-13 column, 0 ≤ x < 2^14, interpolated between the two nodes around it.
    #[inline]
    pub(crate) fn at(kernel: &Kernel, x: u32, weighing: Weighing) -> Self {
        let first = (x >> BETWEEN_BITS) as usize % (NODES - 1);
        let node = if weighing == Weighing::NextNode { first + 1 } else { first };
        let between = (x & ((1 << BETWEEN_BITS) - 1)) as i32;
        let (left, right) = (&kernel.nodes[node], &kernel.nodes[(node + 1).min(NODES - 1)]);
        let number = |word: i16| match weighing {
            Weighing::Unsigned => word.cast_unsigned().into(),
            _ => i32::from(word),
        };
        let weight = |left: i16, right: i16| {
            let (left, right) = (number(left), number(right));
            let product = (right - left) * between + (1 << (BETWEEN_BITS - 1));
            let is_cut = weighing == Weighing::TowardZero;
            left + if is_cut { product / (1 << BETWEEN_BITS) } else { product >> BETWEEN_BITS }
        };
        Self {
            g0: weight(left.g0, right.g0),
            r1: weight(left.r1, right.r1),
            g4: weight(left.g4, right.g4),
            r5: weight(left.r5, right.r5),
            g6: weight(left.g6, right.g6),
        }
    }

    /// The weighted sum of the taps, plus `rounding`, without its fraction. Five products suffice, since the weights of the
    /// output's own colour add up to one and those of the other colour to zero.
    #[inline]
    pub(crate) fn sum(&self, taps: [i32; TAPS], rounding: i32) -> i32 {
        let [g0, r1, g2, r3, g4, r5, g6] = taps;
        let own = self.g0 * (g0 - g2) + self.g4 * (g4 - g2) + self.g6 * (g6 - g2);
        let other = self.r1 * (r1 - r3) + self.r5 * (r5 - r3);
        ((g2 << WEIGHT_BITS) + own + other + rounding) >> WEIGHT_BITS
    }
}

#[cfg(test)]
mod tests {
    use super::super::kernel::Node;
    use super::*;

    /// -2 times 100/256 is -0.78, to which a half is added: -0.28 is -1 rounded down, and 0 rounded toward zero. A product that is
    /// exact or positive is the same either way.
    #[test]
    fn only_a_negative_fraction_shows_which_way_it_is_dropped() {
        let weight = |right: i16, between: u32, weighing| {
            let mut kernel = Kernel::default();
            kernel.nodes[1] = Node { g4: right, ..Node::default() };
            Weights::at(&kernel, between, weighing).g4
        };
        for (right, between, down, toward_zero) in [(-2, 100, -1, 0), (-3, 128, -1, -1), (3, 200, 2, 2)] {
            assert_eq!(weight(right, between, Weighing::Right), down);
            assert_eq!(weight(right, between, Weighing::TowardZero), toward_zero);
        }
    }
}
