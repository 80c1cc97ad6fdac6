//! The options of a target, KEY=VALUE: one reader for every kind of board.

use std::str::FromStr;

use crate::{OpenError, Target};

/// Hands every option to `take`, which says whether there is such an option with such a value; `known` names those that there are.
///
/// # Errors
/// [`OpenError::Option`] for the first that is not taken.
pub(crate) fn read(
    target: &Target,
    known: &'static str,
    mut take: impl FnMut(&str, &str) -> bool,
) -> Result<(), OpenError> {
    match target.options.iter().find(|(key, value)| !take(key, value)) {
        None => Ok(()),
        Some((key, value)) => {
            Err(OpenError::Option { kind: target.kind.clone(), option: format!("{key}={value}"), known })
        }
    }
}

/// Puts what `read` makes of a value into its place, and tells whether it made anything.
pub(crate) fn set<T>(place: &mut T, read: Option<T>) -> bool {
    let is_read = read.is_some();
    if let Some(value) = read {
        *place = value;
    }
    is_read
}

/// A number from 1 on.
pub(crate) fn positive<T: FromStr + Default + PartialOrd>(value: &str) -> Option<T> {
    value.parse().ok().filter(|number| *number > T::default())
}

/// One of two words.
pub(crate) fn choice(value: &str, yes: &str, no: &str) -> Option<bool> {
    if value == yes { Some(true) } else { (value == no).then_some(false) }
}
