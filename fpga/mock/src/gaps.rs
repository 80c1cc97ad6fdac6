//! The pattern of pauses that a seed gives. The RTL draws the same numbers.

/// A seeded pattern of pauses; the seed 0 gives none.
#[derive(Debug, Default)]
pub(crate) struct Gaps {
    state: u32,
}

impl Gaps {
    /// Starts the pattern, as before row 0 of every frame.
    pub(crate) fn start(&mut self, seed: u32) {
        self.state = seed;
    }

    /// Whether they were started with a seed that gives some.
    pub(crate) fn have_begun(&self) -> bool {
        self.state != 0
    }

    /// Blank pixel clocks to be added before a row, 0 to 15. One draw.
    pub(crate) fn extra_blanking(&mut self) -> u32 {
        self.draw() & 0xF
    }

    /// Whether the pixel enable is off for one board clock before a sample. One draw.
    pub(crate) fn pauses(&mut self) -> bool {
        // 0 is the one state that the generator neither reaches nor leaves, so it can stand for "no gaps".
        self.state != 0 && self.draw() & 0x7 == 0
    }

    fn draw(&mut self) -> u32 {
        self.state = draw(self.state);
        self.state
    }
}

/// The number after `x` in Marsaglia's xorshift32.
pub(crate) fn draw(mut x: u32) -> u32 {
    x ^= x << 13;
    x ^= x >> 17;
    x ^ x << 5
}

#[cfg(test)]
mod tests {
    use super::Gaps;

    #[test]
    fn the_generator_is_marsaglias() {
        let mut gaps = Gaps::default();
        gaps.start(2_463_534_242);
        assert_eq!(gaps.draw(), 723_471_715);
    }

    #[test]
    fn the_seed_0_means_no_gaps() {
        let mut gaps = Gaps::default();
        gaps.start(0);
        assert!((0..1000).all(|_| !gaps.pauses() && gaps.extra_blanking() == 0));
    }
}
