//! The colour filter array: which colour a sample has.

use std::fmt;
use std::str::FromStr;

/// The colour of one sample of a Bayer frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Colour {
    /// Red.
    Red,
    /// Green.
    Green,
    /// Blue.
    Blue,
}

/// The Bayer phase: the colours of a frame's first two rows and columns, read left to right, top to bottom.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Phase {
    /// Green, red / blue, green: the paper's system (MT9P031).
    #[default]
    Grbg,
    /// Red, green / green, blue.
    Rggb,
    /// Blue, green / green, red.
    Bggr,
    /// Green, blue / red, green.
    Gbrg,
}

impl Phase {
    /// All four phases.
    pub const ALL: [Self; 4] = [Self::Grbg, Self::Rggb, Self::Bggr, Self::Gbrg];

    /// The colour of the sample at `row` and `column`, both counted from 0.
    #[must_use]
    pub fn colour(self, row: usize, column: usize) -> Colour {
        use Colour::{Blue, Green, Red};
        let cell = match self {
            Self::Grbg => [Green, Red, Blue, Green],
            Self::Rggb => [Red, Green, Green, Blue],
            Self::Bggr => [Blue, Green, Green, Red],
            Self::Gbrg => [Green, Blue, Red, Green],
        };
        cell[row % 2 * 2 + column % 2]
    }

    /// The phase in the spelling that [`FromStr`] reads.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Grbg => "grbg",
            Self::Rggb => "rggb",
            Self::Bggr => "bggr",
            Self::Gbrg => "gbrg",
        }
    }
}

impl fmt::Display for Phase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The word is none of the four Bayer phases.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no Bayer phase; use grbg, rggb, bggr or gbrg")]
pub struct UnknownPhase(String);

impl FromStr for Phase {
    type Err = UnknownPhase;

    fn from_str(text: &str) -> Result<Self, UnknownPhase> {
        Self::ALL
            .into_iter()
            .find(|phase| phase.name().eq_ignore_ascii_case(text))
            .ok_or_else(|| UnknownPhase(text.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_phase_names_the_colours_of_its_first_two_rows() {
        for phase in Phase::ALL {
            let cell: String = [(0, 0), (0, 1), (1, 0), (1, 1)]
                .map(|(row, column)| match phase.colour(row + 2, column + 4) {
                    Colour::Red => 'r',
                    Colour::Green => 'g',
                    Colour::Blue => 'b',
                })
                .iter()
                .collect();
            assert_eq!(cell, phase.name());
            assert_eq!(cell.to_uppercase().parse(), Ok(phase));
        }
        assert!("gggg".parse::<Phase>().is_err());
    }
}
