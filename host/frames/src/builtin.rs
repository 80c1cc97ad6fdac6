//! The built-in frames, which need no file.

use std::fmt;
use std::str::FromStr;

use halfrow_model::{Frame, FrameError};

use super::scene::Scene;
use super::{patterns, street};

/// A frame that is made on the spot, for any geometry.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Builtin {
    /// Every sample 0.
    Black,
    /// Every sample 2^B − 1.
    White,
    /// Every sample 2^(B−1).
    Grey,
    /// From black at the left to white at the right.
    RampAcross,
    /// From black at the top to white at the bottom.
    RampDown,
    /// Eight vertical bars in the full colours.
    Bars,
    /// Neighbours of one colour alternate between black and white.
    Checkerboard,
    /// Isolated bright samples on black and dark ones on white.
    Impulses,
    /// Random samples over the full range.
    Noise,
    /// Only 0 and 2^B − 1, in orders that drive the sum beyond both ends of the range.
    Extremes,
    /// Rings that become finer outwards.
    ZonePlate,
    /// A street through the fisheye lens, with the noise of a sensor.
    Street,
}

impl Builtin {
    /// The prefix of its name where a file could be named instead.
    pub const PREFIX: &str = "builtin:";

    /// All built-in frames.
    pub const ALL: [Self; 12] = [
        Self::Black,
        Self::White,
        Self::Grey,
        Self::RampAcross,
        Self::RampDown,
        Self::Bars,
        Self::Checkerboard,
        Self::Impulses,
        Self::Noise,
        Self::Extremes,
        Self::ZonePlate,
        Self::Street,
    ];

    /// The name that [`FromStr`] reads.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Black => "black",
            Self::White => "white",
            Self::Grey => "grey",
            Self::RampAcross => "ramp-across",
            Self::RampDown => "ramp-down",
            Self::Bars => "bars",
            Self::Checkerboard => "checkerboard",
            Self::Impulses => "impulses",
            Self::Noise => "noise",
            Self::Extremes => "extremes",
            Self::ZonePlate => "zone-plate",
            Self::Street => "street",
        }
    }

    /// What the frame is and what it is good for, in one line.
    #[must_use]
    pub fn description(self) -> &'static str {
        match self {
            Self::Black => "all 0: anything else in the result is a fault",
            Self::White => "all 2^B - 1: finds weights that do not add up to one, and missing bits",
            Self::Grey => "all 2^(B-1): must come back as it went",
            Self::RampAcross => "black to white from left to right: shows wrong columns",
            Self::RampDown => "black to white from top to bottom: shows rows out of order",
            Self::Bars => "eight colour bars: shows a wrong Bayer phase and exchanged colours",
            Self::Checkerboard => "neighbours of one colour alternate: the finest detail, at full swing",
            Self::Impulses => "single bright and dark samples in every column: shows each weight by itself",
            Self::Noise => "random samples: every bit of every sample",
            Self::Extremes => "0 and 2^B - 1 only: drives the sum beyond both ends of the range",
            Self::ZonePlate => "rings that become finer outwards: shows errors of interpolation",
            Self::Street => "a street through the fisheye lens: what a camera sees",
        }
    }

    /// The built-in frame that `text` names, or none if it names a file instead.
    ///
    /// # Errors
    /// [`UnknownBuiltin`] when no built-in frame has the name after [`Self::PREFIX`].
    pub fn named(text: &str) -> Result<Option<Self>, UnknownBuiltin> {
        text.strip_prefix(Self::PREFIX).map(str::parse).transpose()
    }

    /// The frame, made for `scene`. The same scene always gives the same frame, except that single samples of the street may
    /// differ between floating-point libraries.
    ///
    /// # Errors
    /// None for a legal geometry; the [`FrameError`] is passed on rather than dropped.
    pub fn render(self, scene: &Scene) -> Result<Frame, FrameError> {
        match self {
            Self::Black => patterns::flat(scene, 0),
            Self::White => patterns::flat(scene, scene.max()),
            Self::Grey => patterns::flat(scene, scene.max() / 2 + 1),
            Self::RampAcross => patterns::ramp_across(scene),
            Self::RampDown => patterns::ramp_down(scene),
            Self::Bars => patterns::bars(scene),
            Self::Checkerboard => patterns::checkerboard(scene),
            Self::Impulses => patterns::impulses(scene),
            Self::Noise => patterns::noise(scene),
            Self::Extremes => patterns::extremes(scene),
            Self::ZonePlate => patterns::zone_plate(scene),
            Self::Street => street::render(scene),
        }
    }
}

impl fmt::Display for Builtin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// No built-in frame has this name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{name}` is no built-in frame; use one of {}", Builtin::ALL.map(Builtin::name).join(", "))]
pub struct UnknownBuiltin {
    /// The name.
    pub name: String,
}

impl FromStr for Builtin {
    type Err = UnknownBuiltin;

    fn from_str(text: &str) -> Result<Self, UnknownBuiltin> {
        let named = |frame: &Self| frame.name().eq_ignore_ascii_case(text);
        Self::ALL.into_iter().find(named).ok_or_else(|| UnknownBuiltin { name: text.to_owned() })
    }
}
