//! The options of a target, KEY=VALUE, read in the same way for every kind of board.

use std::str::FromStr;

use crate::{OpenError, Target};

/// Passes every option to `take`, which returns whether an option with this key and value exists. `known` lists those that exist.
///
/// # Errors
/// [`OpenError::Option`] for the first option that `take` does not accept.
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

/// Stores the value if `read` has one, and returns whether it has.
pub(crate) fn set<T>(place: &mut T, read: Option<T>) -> bool {
    let is_read = read.is_some();
    if let Some(value) = read {
        *place = value;
    }
    is_read
}

/// A number greater than 0.
pub(crate) fn positive<T: FromStr + Default + PartialOrd>(value: &str) -> Option<T> {
    value.parse().ok().filter(|number| *number > T::default())
}

/// One of two words.
pub(crate) fn choice(value: &str, yes: &str, no: &str) -> Option<bool> {
    if value == yes { Some(true) } else { (value == no).then_some(false) }
}
