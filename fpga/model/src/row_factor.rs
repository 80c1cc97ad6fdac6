//! The row factor: a row's entry of the table.

use std::fmt;
use std::ops::RangeInclusive;

/// The row factor Q: the distance, in source columns, between the sources of two neighbouring outputs of a row (DATAPATH.md,
/// "Table").
///
/// It is 1/k of Eq. 9 in units of 2^-24, so it is above 0 and at most 1: [`Self::RANGE`] as an integer. It is displayed as a
/// decimal fraction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(transparent)]
pub struct RowFactor(u32);

/// The word is out of the range of a row factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{units} is no row factor, which is 1 to {max}; give 2^24 / k, rounded, with a stretch factor k of at least 1",
    max = RowFactor::ONE.get()
)]
pub struct RowFactorError {
    /// The word.
    pub units: u32,
}

impl RowFactor {
    /// The row factor of a row that is not stretched: 2^24, which is 1.
    pub const ONE: Self = Self(1 << 24);
    /// The least row factor, 2^-24.
    pub const LEAST: Self = Self(1);
    /// Bits of a row factor in a board's memory.
    pub const BITS: u32 = 25;
    /// All row factors in units of 2^-24.
    pub const RANGE: RangeInclusive<u32> = Self::LEAST.0..=Self::ONE.0;

    /// The row factor of `units` times 2^-24.
    ///
    /// # Errors
    /// [`RowFactorError`] outside [`Self::RANGE`].
    pub const fn new(units: u32) -> Result<Self, RowFactorError> {
        if units < Self::LEAST.0 || units > Self::ONE.0 {
            return Err(RowFactorError { units });
        }
        Ok(Self(units))
    }

    /// The row factor nearest to `shrink` = 1/k, halves up: max(1, floor(2^24 · shrink + ½)), at most 1.
    #[must_use]
    pub fn nearest(shrink: f64) -> Self {
        Self(((f64::from(Self::ONE.0) * shrink + 0.5).floor() as u32).clamp(Self::LEAST.0, Self::ONE.0))
    }

    /// Q, in units of 2^-24.
    #[must_use]
    pub const fn get(self) -> u32 {
        self.0
    }

    /// 1/k as a fraction, exactly.
    #[must_use]
    pub fn fraction(self) -> f64 {
        f64::from(self.0) / f64::from(Self::ONE.0)
    }

    /// The row factor half way to another one, rounded down.
    #[must_use]
    pub const fn midpoint(self, other: Self) -> Self {
        Self(u32::midpoint(self.0, other.0))
    }
}

impl TryFrom<u32> for RowFactor {
    type Error = RowFactorError;

    fn try_from(units: u32) -> Result<Self, RowFactorError> {
        Self::new(units)
    }
}

impl From<RowFactor> for u32 {
    fn from(row_factor: RowFactor) -> Self {
        row_factor.0
    }
}

impl fmt::Display for RowFactor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.fraction().fmt(f)
    }
}
