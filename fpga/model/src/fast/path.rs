//! The ways to compute the same samples.

use std::fmt;
use std::str::FromStr;

/// One implementation of the datapath. All of them give the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ModelPath {
    /// The oracle, [`correct_row`](crate::correct_row), written for clarity.
    Reference,
    /// Plain Rust, for every processor.
    Scalar,
    /// x86-64 with AVX2: 32 columns at a time.
    Avx2,
    /// x86-64 with AVX-512 F, BW and VL: 32 columns at a time.
    Avx512,
}

impl ModelPath {
    /// All paths, from the slowest.
    pub const ALL: [Self; 4] = [Self::Reference, Self::Scalar, Self::Avx2, Self::Avx512];

    /// Whether this processor has what the path needs.
    #[must_use]
    pub fn is_available(self) -> bool {
        match self {
            Self::Reference | Self::Scalar => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => super::x86::Avx2::detect().is_some(),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => super::x86::Avx512::detect().is_some(),
            #[cfg(not(target_arch = "x86_64"))]
            Self::Avx2 | Self::Avx512 => false,
        }
    }

    /// The paths that this processor has, from the slowest.
    pub fn available() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(|path| path.is_available())
    }

    /// The fastest path that this processor has.
    #[must_use]
    pub fn best() -> Self {
        Self::available().last().unwrap_or(Self::Scalar)
    }

    /// The path in the spelling that [`FromStr`] reads.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Reference => "reference",
            Self::Scalar => "scalar",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }
}

impl fmt::Display for ModelPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The model has no path of this name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no path of the model; use reference, scalar, avx2 or avx512")]
pub struct UnknownPath(String);

impl FromStr for ModelPath {
    type Err = UnknownPath;

    fn from_str(text: &str) -> Result<Self, UnknownPath> {
        Self::ALL
            .into_iter()
            .find(|path| path.name().eq_ignore_ascii_case(text))
            .ok_or_else(|| UnknownPath(text.to_owned()))
    }
}

/// This processor does not support the path of the model that was asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("this processor cannot take the path {0} of the model; use {best}, the fastest that it has", best = ModelPath::best())]
pub struct UnavailablePath(pub ModelPath);
