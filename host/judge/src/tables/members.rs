//! The members of a JSON object, which are checked as they are taken out one by one.

use std::collections::HashSet;
use std::fmt::{self, Display};
use std::ops::RangeInclusive;

use halfrow_protocol::message::Datapath;
use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde_json::{Map, Value};

use super::{ContentError, Place, WrongDatapath};
use halfrow_files::text::{quoted, without_mark};

/// An object's members as they stand in the text, repeated keys included.
pub(super) struct Members(Vec<(String, Value)>);

impl<'de> Deserialize<'de> for Members {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Object;

        impl<'de> Visitor<'de> for Object {
            type Value = Members;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Members, A::Error> {
                let mut members = Vec::new();
                while let Some(member) = map.next_entry()? {
                    members.push(member);
                }
                Ok(Members(members))
            }
        }

        deserializer.deserialize_map(Object)
    }
}

impl Members {
    /// The members of the JSON object `text`, in which no key may be repeated.
    pub(super) fn parse(text: &str) -> Result<Self, ContentError> {
        let members: Self = serde_json::from_str(without_mark(text)).map_err(json_error)?;
        let mut seen = HashSet::new();
        match members.0.iter().find(|(key, _)| !seen.insert(key)) {
            Some((key, _)) => Err(ContentError::RepeatedKey { key: quoted(key) }),
            None => Ok(members),
        }
    }

    /// The datapath that the tables are for, if the text says which.
    ///
    /// Ask for it first: a file for another datapath may have other keys.
    pub(super) fn datapath(&self) -> Result<Option<Datapath>, ContentError> {
        let Some((_, value)) = self.0.iter().find(|(key, _)| key == Place::Datapath.key()) else {
            return Ok(None);
        };
        let found = integer(Place::Datapath, value)?;
        Ok(Some(WrongDatapath::check(found)?))
    }

    /// Refuses members other than `places`.
    pub(super) fn check_keys(&self, places: &[Place]) -> Result<(), ContentError> {
        let known: Vec<_> = places.iter().map(|place| place.key()).collect();
        match self.0.iter().find(|(key, _)| !known.contains(&key.as_str())) {
            Some((key, _)) => Err(ContentError::UnknownKey { key: quoted(key), known: known.join(", ") }),
            None => Ok(()),
        }
    }

    /// Takes the value of `place`, which must exist.
    pub(super) fn take(&mut self, place: Place) -> Result<Value, ContentError> {
        self.take_optional(place).ok_or(ContentError::MissingKey(place))
    }

    /// Takes the number of `place`, which must exist and be within `allowed`.
    pub(super) fn take_number<T>(
        &mut self,
        place: Place,
        allowed: &RangeInclusive<T>,
    ) -> Result<T, ContentError>
    where
        T: TryFrom<i128> + PartialOrd + Display,
    {
        number(place, &self.take(place)?, allowed)
    }

    /// Takes the user's notes, if there are any.
    pub(super) fn take_about(&mut self) -> Result<Option<Map<String, Value>>, ContentError> {
        match self.take_optional(Place::About) {
            None => Ok(None),
            Some(Value::Object(about)) => Ok(Some(about)),
            Some(other) => Err(kind(Place::About, &other, "an object")),
        }
    }

    fn take_optional(&mut self, place: Place) -> Option<Value> {
        let index = self.0.iter().position(|(key, _)| key == place.key())?;
        Some(self.0.swap_remove(index).1)
    }
}

/// `value` as a whole number within `allowed`.
pub(super) fn number<T>(place: Place, value: &Value, allowed: &RangeInclusive<T>) -> Result<T, ContentError>
where
    T: TryFrom<i128> + PartialOrd + Display,
{
    let found = integer(place, value)?;
    T::try_from(found).ok().filter(|number| allowed.contains(number)).ok_or_else(|| ContentError::Range {
        place,
        found,
        allowed: format!("{} to {}", allowed.start(), allowed.end()),
    })
}

/// The entries of the list `value`, of which there must be `wanted`.
pub(super) fn list(place: Place, value: &Value, wanted: usize) -> Result<&[Value], ContentError> {
    let entries = value.as_array().ok_or_else(|| kind(place, value, "a list"))?;
    if entries.len() == wanted {
        Ok(entries)
    } else {
        Err(ContentError::Length { place, found: entries.len(), wanted })
    }
}

fn integer(place: Place, value: &Value) -> Result<i128, ContentError> {
    let integer = value.as_number().and_then(serde_json::Number::as_i128);
    // It is read as a double, whatever its digits.
    let is_larger = value.as_f64().is_some_and(|number| number.abs() >= 2_f64.powi(63));
    let wanted = if is_larger { "a whole number of 64 bits" } else { "a whole number in plain digits" };
    integer.ok_or_else(|| kind(place, value, wanted))
}

fn kind(place: Place, value: &Value, wanted: &'static str) -> ContentError {
    ContentError::Kind { place, found: quoted(&value.to_string()), wanted }
}

fn json_error(source: serde_json::Error) -> ContentError {
    let (line, column) = (source.line(), source.column());
    if source.is_eof() {
        ContentError::Truncated { line, column }
    } else {
        ContentError::Json { line, column, source }
    }
}
