//! Values given as text, as in `latency=12`, and their legal ranges.

/// A value that was given as text and cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ValueError {
    /// The option's value is not a whole number.
    #[error("{key}={value} is not a whole number; give one from {least} to {most}")]
    NotANumber {
        /// The value's name.
        key: &'static str,
        /// What was given.
        value: String,
        /// The least legal number.
        least: i64,
        /// The largest legal number.
        most: i64,
    },
    /// The option's value is a number outside the option's range.
    #[error("{key}={value} is out of range; give a number from {least} to {most}")]
    OutOfRange {
        /// The value's name.
        key: &'static str,
        /// What was given.
        value: i64,
        /// The least legal number.
        least: i64,
        /// The largest legal number.
        most: i64,
    },
    /// The option's value is not one of the words that it takes.
    #[error("{key}={value} is not known; give one of {known}")]
    NotAWord {
        /// The value's name.
        key: &'static str,
        /// What was given.
        value: String,
        /// The known words.
        known: String,
    },
    /// The option's value is not a number, or is outside the option's range.
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
    /// Two parameters both say where the fault strikes.
    #[error("{first} and {second} both say where the fault strikes; keep one of them")]
    TwoPlaces {
        /// One key.
        first: &'static str,
        /// Another one.
        second: &'static str,
    },
    /// The option needs a value, and none was given.
    #[error("{key} has no value; give one as {key}=VALUE")]
    Missing {
        /// The value's name.
        key: &'static str,
    },
}

/// The name of a whole number and the range it must lie in.
#[derive(Debug)]
pub struct Limits {
    key: &'static str,
    least: i64,
    most: i64,
}

impl Limits {
    /// A number called `key` from `least` to `most`, both included.
    #[must_use]
    pub const fn new(key: &'static str, least: i64, most: i64) -> Self {
        Self { key, least, most }
    }

    /// The number's name.
    #[must_use]
    pub const fn key(&self) -> &'static str {
        self.key
    }

    /// Whether a number lies in the range.
    ///
    /// # Errors
    /// [`ValueError::OutOfRange`] when it does not.
    pub fn check(&self, value: i64) -> Result<(), ValueError> {
        let Self { key, least, most } = *self;
        if (least..=most).contains(&value) {
            Ok(())
        } else {
            Err(ValueError::OutOfRange { key, value, least, most })
        }
    }

    /// The number in `text`, if it lies in the range and in that of `T`.
    ///
    /// # Errors
    /// [`ValueError::NotANumber`] or [`ValueError::OutOfRange`] when it does not.
    pub fn parse<T: TryFrom<i64>>(&self, text: &str) -> Result<T, ValueError> {
        let Self { key, least, most } = *self;
        let value = text.parse::<i64>().map_err(|_| {
            let value = text.to_owned();
            ValueError::NotANumber { key, value, least, most }
        })?;
        self.check(value)?;
        T::try_from(value).map_err(|_| ValueError::OutOfRange { key, value, least, most })
    }
}

/// The name of a number with a fraction, and the range it must lie in.
#[derive(Debug)]
pub(crate) struct Decimal {
    key: &'static str,
    least: f64,
    most: f64,
}

impl Decimal {
    /// A number called `key` from `least` to `most`, both included.
    pub(crate) const fn new(key: &'static str, least: f64, most: f64) -> Self {
        Self { key, least, most }
    }

    /// The number's name.
    pub(crate) const fn key(&self) -> &'static str {
        self.key
    }

    /// The number in `text`, if it lies in the range.
    pub(crate) fn parse(&self, text: &str) -> Result<f64, ValueError> {
        let Self { key, least, most } = *self;
        let number = text.parse().ok().filter(|number| (least..=most).contains(number));
        number.ok_or_else(|| ValueError::Decimal { key, value: text.to_owned(), least, most })
    }
}

/// The value among `known` whose word is `text`.
///
/// # Errors
/// [`ValueError::NotAWord`] when there is none.
pub fn parse_word<T: Copy>(
    key: &'static str,
    text: &str,
    known: &[(&'static str, T)],
) -> Result<T, ValueError> {
    known.iter().find(|(word, _)| *word == text).map(|(_, value)| *value).ok_or_else(|| {
        let words: Vec<_> = known.iter().map(|(word, _)| *word).collect();
        ValueError::NotAWord { key, value: text.to_owned(), known: words.join(", ") }
    })
}
