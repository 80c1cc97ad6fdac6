//! The colour scale of differences.

use crate::frames::MAGMA;

/// A colour of the map, with the smallest absolute difference that has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// The smallest absolute difference of this step.
    pub from: u16,
    /// Red, green and blue.
    pub colour: [u8; 3],
}

/// From 2 on each step is four times the one before, because a fault in one bit of a sample differs by a power of two.
const STEPS: [Step; 7] = [
    step(1, MAGMA[1]),
    step(2, MAGMA[2]),
    step(8, MAGMA[3]),
    step(32, MAGMA[4]),
    step(128, MAGMA[5]),
    step(512, MAGMA[6]),
    step(2048, MAGMA[7]),
];

/// The colour of rows that did not come back: the sky blue of Okabe and Ito's palette for colour-blind readers. Magma has no such
/// colour.
pub const MISSING: [u8; 3] = [0x56, 0xb4, 0xe9];

/// The colour where nothing differs.
pub(super) const EQUAL: [u8; 3] = MAGMA[0];

const fn step(from: u16, colour: [u8; 3]) -> Step {
    Step { from, colour }
}

/// The colour of an absolute difference.
pub(super) fn colour(difference: u16) -> [u8; 3] {
    steps_up_to(difference).last().map_or(EQUAL, |step| step.colour)
}

/// The steps that differences up to `largest` reach, from the smallest.
pub fn steps_up_to(largest: u16) -> impl DoubleEndedIterator<Item = Step> {
    STEPS.into_iter().filter(move |step| step.from <= largest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_has_the_colour_of_the_last_step_that_it_reaches() {
        assert_eq!(colour(0), EQUAL);
        assert_eq!(colour(1), STEPS[0].colour);
        assert_eq!(colour(7), STEPS[1].colour);
        assert_eq!(colour(8), STEPS[2].colour);
        assert_eq!(colour(u16::MAX), STEPS[6].colour);
    }
}
