//! The interpolants: continuous weights between two samples of the same colour (Eqs. 10, 11, 12, 18).

use std::fmt;
use std::str::FromStr;

/// A rule that weighs the seven samples around a source point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Interpolant {
    /// The nearer sample of the output's colour (Eq. 10).
    Nearest,
    /// A straight line between the two samples of the output's colour (Eq. 11).
    Linear,
    /// Keys' cubic through four samples of the output's colour (Eq. 12).
    Keys,
    /// The paper's cubic: two samples of the output's colour, with slopes from three of the row's other colour (Eq. 18).
    #[default]
    Hermite,
}

impl Interpolant {
    /// All four, from the simplest.
    pub const ALL: [Self; 4] = [Self::Nearest, Self::Linear, Self::Keys, Self::Hermite];

    /// The weights of G0 R1 G2 R3 G4 R5 G6 for a point `x` pixels right of G2, 0 ≤ x ≤ 2.
    ///
    /// G2 is always the tap at or left of the point, as in Eqs. 12 and 18; Eqs. 10 and 11 call that tap G0. At x = 1
    /// the nearest sample is G4.
    #[must_use]
    pub fn weights(self, x: f64) -> [f64; 7] {
        let x2 = x * x;
        let x3 = x2 * x;
        match self {
            Self::Nearest if x < 1.0 => [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
            Self::Nearest => [0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0],
            Self::Linear => [0.0, 0.0, 1.0 - x / 2.0, 0.0, x / 2.0, 0.0, 0.0],
            Self::Keys => [
                -x3 / 16.0 + x2 / 4.0 - x / 4.0,
                0.0,
                3.0 * x3 / 16.0 - 5.0 * x2 / 8.0 + 1.0,
                0.0,
                -3.0 * x3 / 16.0 + x2 / 2.0 + x / 4.0,
                0.0,
                x3 / 16.0 - x2 / 8.0,
            ],
            Self::Hermite => [
                0.0,
                -x3 / 8.0 + x2 / 2.0 - x / 2.0,
                x3 / 4.0 - 3.0 * x2 / 4.0 + 1.0,
                -x2 / 4.0 + x / 2.0,
                -x3 / 4.0 + 3.0 * x2 / 4.0,
                x3 / 8.0 - x2 / 4.0,
                0.0,
            ],
        }
    }

    /// The name in the spelling that [`FromStr`] reads.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Nearest => "nearest",
            Self::Linear => "linear",
            Self::Keys => "keys",
            Self::Hermite => "hermite",
        }
    }
}

impl fmt::Display for Interpolant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// No interpolant has this name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no interpolant; use nearest, linear, keys or hermite")]
pub struct UnknownInterpolant(String);

impl FromStr for Interpolant {
    type Err = UnknownInterpolant;

    fn from_str(text: &str) -> Result<Self, UnknownInterpolant> {
        Self::ALL
            .into_iter()
            .find(|interpolant| interpolant.name().eq_ignore_ascii_case(text))
            .ok_or_else(|| UnknownInterpolant(text.to_owned()))
    }
}
