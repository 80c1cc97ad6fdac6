//! Why a person does something. The audit keeps it.

use std::ops::Deref;

/// The longest reason that pages and events have room for, in characters.
pub(crate) const MOST_REASON: usize = 500;

/// Why a person does something, without blanks around it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reason(String);

impl Reason {
    /// The reason that a person gives as `text`.
    ///
    /// # Errors
    /// [`ReasonError`] when it says nothing, or is too long.
    pub fn of(text: &str) -> Result<Self, ReasonError> {
        let text = text.trim();
        match text.chars().count() {
            0 => Err(ReasonError::Missing),
            1..=MOST_REASON => Ok(Self(text.to_owned())),
            characters => Err(ReasonError::TooLong { characters, most: MOST_REASON }),
        }
    }

    /// The reason of this program itself, whose end is cut off where it is too long.
    pub(crate) fn of_program(text: &str) -> Self {
        Self(text.chars().take(MOST_REASON).collect())
    }
}

impl Deref for Reason {
    type Target = str;

    fn deref(&self) -> &str {
        &self.0
    }
}

/// A text that is no reason.
#[derive(Debug, thiserror::Error)]
pub enum ReasonError {
    /// The text is empty or blank.
    #[error("there is no reason, which is kept with what is done; say why in a few words")]
    Missing,
    /// The text is longer than pages and events have room for.
    #[error("the reason has {characters} characters, and may have {most} at most; say it in fewer")]
    TooLong {
        /// Its length.
        characters: usize,
        /// The most.
        most: usize,
    },
}
