//! YAML, which includes JSON, as calibration programs write it: keys in any spelling, and numbers in any grouping.

use std::borrow::Cow;

use saphyr::{LoadableYamlNode, Marker, ScanError, Yaml};
use saphyr_parser::{Event, Parser};

use super::LensContentError;
use halfrow_files::text::quoted;

/// The keys of a file or of a part of it.
pub(super) struct Keys<'a>(Vec<(&'a str, &'a Yaml<'a>)>);

/// `text` with OpenCV's own header, `%YAML:1.0`, turned into a comment. It is no valid directive of YAML, and older files lack
/// the line `---` that must follow one.
pub(super) fn without_header(text: &str) -> Cow<'_, str> {
    if text.starts_with("%YAML:") { Cow::Owned(text.replacen('%', "#", 1)) } else { Cow::Borrowed(text) }
}

/// The deepest nesting of lists and groups that a file may have. Lens files have four levels at most, and the loader recurses at
/// each level.
const DEEPEST: usize = 32;

/// The documents of `text`.
pub(super) fn documents(text: &str) -> Result<Vec<Yaml<'_>>, LensContentError> {
    check_depth(text)?;
    Yaml::load_from_str(text).map_err(|error| unreadable(&error))
}

fn check_depth(text: &str) -> Result<(), LensContentError> {
    let mut depth = 0;
    for event in Parser::new_from_str(text) {
        let (event, place) = event.map_err(|error| unreadable(&error))?;
        match event {
            Event::SequenceStart(..) | Event::MappingStart(..) => depth += 1,
            Event::SequenceEnd | Event::MappingEnd => depth -= 1,
            _ => {}
        }
        if depth > DEEPEST {
            let reason = format!("lists and groups lie deeper than {DEEPEST} in each other");
            return Err(syntax(place.start, reason));
        }
    }
    Ok(())
}

fn unreadable(error: &ScanError) -> LensContentError {
    syntax(*error.marker(), error.info().to_owned())
}

fn syntax(place: Marker, reason: String) -> LensContentError {
    LensContentError::Syntax { line: place.line(), column: place.col() + 1, reason }
}

impl<'a> Keys<'a> {
    /// The keys of `node`, if it is a group of keys.
    pub(super) fn of(node: &'a Yaml<'a>) -> Option<Self> {
        let members = node.as_mapping()?.iter();
        Some(Self(members.filter_map(|(key, value)| Some((key.as_str()?, value))).collect()))
    }

    /// The first of `names` that exists, as it is spelt there, and its value. Case and punctuation do not count, so
    /// `camera_matrix` is also `Camera_Matrix` and `cameraMatrix`.
    pub(super) fn find(&self, names: &[&str]) -> Option<(&'a str, &'a Yaml<'a>)> {
        let found = |name: &&str| self.0.iter().copied().find(|(key, _)| bare(key) == bare(name));
        names.iter().find_map(found)
    }

    /// Refuses a second key for `name`: it would be unclear which of the two is meant.
    pub(super) fn check_once(&self, name: &str) -> Result<(), LensContentError> {
        let mut found = self.0.iter().map(|(key, _)| *key).filter(|key| bare(key) == bare(name));
        match (found.next(), found.next()) {
            (Some(first), Some(second)) => {
                Err(LensContentError::Twice { first: quoted(first), second: quoted(second) })
            }
            _ => Ok(()),
        }
    }

    /// Refuses two of `names`, which mean the same, with different numbers: it would be unclear which are meant.
    pub(super) fn check_agree(&self, names: &[&str]) -> Result<(), LensContentError> {
        let each = names.iter().filter_map(|name| self.find(&[name]));
        let mut said = each.filter_map(|(key, value)| {
            Some((
                key,
                numbers(key, value).or_else(|_| Ok::<_, LensContentError>(vec![number(key, value)?])).ok()?,
            ))
        });
        let Some((first, numbers)) = said.next() else { return Ok(()) };
        match said.find(|(_, other)| *other != numbers) {
            Some((second, _)) => {
                Err(LensContentError::Twice { first: quoted(first), second: quoted(second) })
            }
            None => Ok(()),
        }
    }

    /// Like [`Self::find`], for `what` that must exist.
    pub(super) fn get(
        &self,
        what: &'static str,
        names: &[&str],
    ) -> Result<(&'a str, &'a Yaml<'a>), LensContentError> {
        self.find(names).ok_or_else(|| LensContentError::Missing { what, keys: names.join(", ") })
    }

    /// The keys that are groups of keys themselves and are named like cam0.
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

/// The numbers in `value`, which may be a list, a list of lists, or a matrix with `data`.
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

/// `value` as a finite number.
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
