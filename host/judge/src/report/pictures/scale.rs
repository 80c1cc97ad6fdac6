//! The colour scale of differences.

/// A colour of the map, with the smallest absolute difference that has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// The smallest absolute difference of this step.
    pub from: u16,
    /// Red, green and blue.
    pub colour: [u8; 3],
}

/// From 2 on each step is four times the one before, because a fault in one bit of a sample differs by a power of two. The
/// colours are the brighter part of magma, whose lightness rises evenly, so that the order also shows in grey and to
/// colour-blind readers.
const STEPS: [Step; 7] = [
    step(1, [0x83, 0x26, 0x81]),
    step(2, [0xb0, 0x31, 0x7b]),
    step(8, [0xdc, 0x46, 0x6a]),
    step(32, [0xf4, 0x69, 0x5c]),
    step(128, [0xfe, 0x9a, 0x6c]),
    step(512, [0xfe, 0xca, 0x8d]),
    step(2048, [0xfc, 0xfd, 0xbf]),
];

/// The colour where nothing differs.
pub(super) const EQUAL: [u8; 3] = [0x17, 0x17, 0x20];

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

    #[test]
    fn lightness_rises_with_the_difference() {
        let luma = |[red, green, blue]: [u8; 3]| 2 * u32::from(red) + 7 * u32::from(green) + u32::from(blue);
        let all: Vec<_> = std::iter::once(EQUAL).chain(STEPS.map(|step| step.colour)).map(luma).collect();
        assert!(all.is_sorted(), "{all:?}");
    }
}
