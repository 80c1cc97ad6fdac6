//! The levels at which bits of samples and settings have shown themselves. A bit that has not shown itself at both may be stuck
//! unseen.

use halfrow_model::{Frame, Kernel, TableSet};

use crate::reference::correct;

/// Levels of bits: `ones` marks each bit that was ever 1, `zeros` each that was ever 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Levels {
    ones: u32,
    zeros: u32,
}

impl Levels {
    pub(crate) fn of(values: impl IntoIterator<Item = u32>) -> Self {
        values
            .into_iter()
            .fold(Self::default(), |levels, value| levels.and(Self { ones: value, zeros: !value }))
    }

    /// Those of either.
    pub(crate) fn and(self, other: Self) -> Self {
        Self { ones: self.ones | other.ones, zeros: self.zeros | other.zeros }
    }

    /// Those of the lowest `bits` bits that have not had both levels.
    pub(crate) fn constant(self, bits: u32) -> Vec<usize> {
        (0..bits).filter(|bit| (self.ones & self.zeros) >> bit & 1 == 0).map(|bit| bit as usize).collect()
    }

    /// Adds the samples of a frame, unless they could change nothing.
    fn note(&mut self, frame: &Frame) {
        if !self.constant(frame.depth().bits()).is_empty() {
            *self = self.and(Self::of(frame.samples().iter().copied().map(u32::from)));
        }
    }

    /// The bits of C, at their level in `tables`, without which `input` would not come out as `expected`: with the bit stuck at
    /// the other level it comes out otherwise. Where that level is `known` already, it is not asked again.
    pub(crate) fn of_centre(
        tables: &TableSet,
        kernel: &Kernel,
        input: &Frame,
        expected: &Frame,
        known: Self,
    ) -> Self {
        let geometry = tables.geometry();
        let (centre2, most) = (geometry.centre2(), 2 * geometry.width() as u32 - 2);
        let shows = |bit: &u32| {
            // A centre further off than any may be moves the samples even further.
            let stuck = tables.with_settings(geometry.depth(), (centre2 ^ bit).min(most));
            let corrected = stuck.map(|stuck| correct(&stuck, kernel, input));
            corrected.is_ok_and(|corrected| corrected.is_ok_and(|corrected| corrected != *expected))
        };
        let is_known = |bit: &u32| if centre2 & bit == 0 { known.zeros } else { known.ones } & bit != 0;
        let bits = (0..u32::BITS - most.leading_zeros()).map(|place| 1 << place);
        let shown: u32 = bits.filter(|bit| !is_known(bit) && shows(bit)).sum();
        Self { ones: shown & centre2, zeros: shown & !centre2 }
    }
}

/// What frames have shown of a board: the levels of the bits of samples, and of the optical centre.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ShownBits {
    pub(crate) input: Levels,
    pub(crate) output: Levels,
    /// Those that would have changed a frame, had they been stuck.
    pub(crate) centre: Levels,
}

impl ShownBits {
    /// Adds a frame that went in, the frame that should have come out, and what that shows of the centre.
    pub(crate) fn note(&mut self, input: &Frame, output: &Frame, centre: Levels) {
        self.input.note(input);
        self.output.note(output);
        self.centre = self.centre.and(centre);
    }
}

#[cfg(test)]
mod tests {
    use halfrow_model::{BitDepth, Geometry, Interpolant, Phase};

    use super::*;

    /// What a frame of one row shows of the eight bits of C = 127, 0111 1111, in rows of 128.
    fn shown(factor: u32, sample: impl Fn(u16) -> u16, known: Levels) -> Levels {
        let geometry = Geometry::new(128, 1, BitDepth::Twelve, 127).unwrap();
        let tables = TableSet::from_units(geometry, &[factor]).unwrap();
        let samples = (0..128).map(sample).collect();
        let input = Frame::new(128, BitDepth::Twelve, Phase::Grbg, samples).unwrap();
        let kernel = Kernel::from(Interpolant::Hermite);
        let expected = correct(&tables, &kernel, &input).unwrap();
        Levels::of_centre(&tables, &kernel, &input, &expected, known)
    }

    fn noise(column: u16) -> u16 {
        column.wrapping_mul(1021) % 4096
    }

    /// DATAPATH.md, "Source coordinate": C/2 + Q (j - C/2), so that C matters by 1 - Q.
    #[test]
    fn the_centre_shows_itself_where_rows_are_stretched_and_samples_differ() {
        let all = Levels { ones: 0x7f, zeros: 0x80 };
        assert_eq!(shown(1 << 23, noise, Levels::default()), all);
        assert_eq!(shown(1 << 24, noise, Levels::default()), Levels::default());
        assert_eq!(shown(1 << 23, |_| 2000, Levels::default()), Levels::default());
    }

    #[test]
    fn what_is_known_is_not_asked_again() {
        let known = Levels { ones: 0x0f, zeros: 0xf0 };
        assert_eq!(shown(1 << 23, noise, known), Levels { ones: 0x70, zeros: 0 });
    }
}
