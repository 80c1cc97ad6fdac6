//! Values of the wire and its faults given as text.

use crate::faults::Parameters;
use crate::value::ValueError;

/// A value of the wire or of one of its faults that cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WireValueError {
    /// A whole number or a word is wrong.
    #[error(transparent)]
    Value(#[from] ValueError),
    /// The text is no number, or one outside its range.
    #[error("{key}={value} is not a number from {least} to {most}; give one in this range")]
    Decimal {
        /// The value's name.
        key: &'static str,
        /// What was given.
        value: String,
        /// The least legal number.
        least: f64,
        /// The largest legal number.
        most: f64,
    },
    /// A fault was told twice where to strike.
    #[error("{first} and {second} both say where the fault strikes; keep one of them")]
    TwoPlaces {
        /// One key.
        first: &'static str,
        /// Another one.
        second: &'static str,
    },
}

/// The name of a number with a fraction, and the range it must lie in.
#[derive(Debug)]
pub(super) struct Decimal {
    key: &'static str,
    least: f64,
    most: f64,
}

impl Decimal {
    /// A number called `key` from `least` to `most`, both included.
    pub(super) const fn new(key: &'static str, least: f64, most: f64) -> Self {
        Self { key, least, most }
    }

    /// The number's name.
    pub(super) const fn key(&self) -> &'static str {
        self.key
    }

    /// The number that `text` stands for, if it lies in the range.
    pub(super) fn parse(&self, text: &str) -> Result<f64, WireValueError> {
        let Self { key, least, most } = *self;
        let number = text.parse().ok().filter(|number| (least..=most).contains(number));
        number.ok_or_else(|| WireValueError::Decimal { key, value: text.to_owned(), least, most })
    }
}

/// Takes the value called `key` out of the parameters and lets `parse` read it.
pub(super) fn take<T, E: Into<WireValueError>>(
    from: &mut Parameters,
    key: &str,
    parse: impl FnOnce(&str) -> Result<T, E>,
) -> Result<Option<T>, WireValueError> {
    from.remove(key).map(|text| parse(&text)).transpose().map_err(Into::into)
}
