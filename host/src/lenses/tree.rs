//! YAML, of which JSON is a part, as calibration programs write it: keys in every spelling, and numbers in every grouping.

use std::borrow::Cow;

use saphyr::{LoadableYamlNode, Yaml};

use super::LensContentError;
use crate::tables::text::quoted;

/// The keys of a file or of a part of it.
pub(super) struct Keys<'a>(Vec<(&'a str, &'a Yaml<'a>)>);

/// `text` with OpenCV's own header, `%YAML:1.0`, as a comment: it is no directive of YAML, and older files go on without the
/// line `---` that has to follow one.
pub(super) fn without_header(text: &str) -> Cow<'_, str> {
    if text.starts_with("%YAML:") { Cow::Owned(text.replacen('%', "#", 1)) } else { Cow::Borrowed(text) }
}

/// The documents of `text`.
pub(super) fn documents(text: &str) -> Result<Vec<Yaml<'_>>, LensContentError> {
    Yaml::load_from_str(text).map_err(|error| LensContentError::Syntax {
        line: error.marker().line(),
        column: error.marker().col() + 1,
        reason: error.info().to_owned(),
    })
}

impl<'a> Keys<'a> {
    /// The keys of `node`, if it is a group of some.
    pub(super) fn of(node: &'a Yaml<'a>) -> Option<Self> {
        let members = node.as_mapping()?.iter();
        Some(Self(members.filter_map(|(key, value)| Some((key.as_str()?, value))).collect()))
    }

    /// The first of `names` that is there, as it is spelt there, and its value. Case and punctuation do not count, so
    /// `camera_matrix` is also `Camera_Matrix` and `cameraMatrix`.
    pub(super) fn find(&self, names: &[&str]) -> Option<(&'a str, &'a Yaml<'a>)> {
        let found = |name: &&str| self.0.iter().copied().find(|(key, _)| bare(key) == bare(name));
        names.iter().find_map(found)
    }

    /// As [`Self::find`], for `what` that must be there.
    pub(super) fn get(
        &self,
        what: &'static str,
        names: &[&str],
    ) -> Result<(&'a str, &'a Yaml<'a>), LensContentError> {
        self.find(names).ok_or_else(|| LensContentError::Missing { what, keys: names.join(", ") })
    }

    /// The keys that are groups of keys themselves and have a name such as cam0.
    pub(super) fn cameras(&self) -> Vec<(&'a str, &'a Yaml<'a>)> {
        let numbered = |key: &str| {
            key.strip_prefix("cam")
                .is_some_and(|rest| !rest.is_empty() && rest.bytes().all(|byte| byte.is_ascii_digit()))
        };
        self.0.iter().copied().filter(|(key, value)| numbered(key) && value.is_mapping()).collect()
    }
}

fn bare(key: &str) -> String {
    key.chars().filter(char::is_ascii_alphanumeric).map(|letter| letter.to_ascii_lowercase()).collect()
}

/// The numbers of `value`: of a list, of a list of lists, or of a matrix with `data`.
pub(super) fn numbers(key: &str, value: &Yaml<'_>) -> Result<Vec<f64>, LensContentError> {
    if let Some(data) = Keys::of(value).and_then(|keys| keys.find(&["data"])) {
        return numbers(key, data.1);
    }
    let Some(entries) = value.as_sequence() else {
        return Err(kind(key, value, "a matrix or a list of numbers"));
    };
    let mut found = Vec::with_capacity(entries.len());
    for entry in entries {
        if entry.is_sequence() {
            found.extend(numbers(key, entry)?);
        } else {
            found.push(number(key, entry)?);
        }
    }
    Ok(found)
}

/// The finite number that `value` is.
pub(super) fn number(key: &str, value: &Yaml<'_>) -> Result<f64, LensContentError> {
    let plain = value.as_floating_point().or_else(|| value.as_integer().map(|integer| integer as f64));
    let number = plain.or_else(|| value.as_str().and_then(|word| word.parse().ok()));
    number.filter(|number| number.is_finite()).ok_or_else(|| kind(key, value, "a finite number"))
}

fn kind(key: &str, value: &Yaml<'_>, wanted: &'static str) -> LensContentError {
    LensContentError::Kind { key: quoted(key), found: described(value), wanted }
}

/// A value in a few words.
fn described(value: &Yaml<'_>) -> String {
    if value.is_mapping() {
        "a group of keys".to_owned()
    } else if let Some(entries) = value.as_sequence() {
        format!("a list of {}", entries.len())
    } else if let Some(word) = value.as_str() {
        quoted(word)
    } else if let Some(number) = value.as_floating_point() {
        number.to_string()
    } else if let Some(number) = value.as_integer() {
        number.to_string()
    } else {
        "empty or no number".to_owned()
    }
}
