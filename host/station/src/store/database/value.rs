//! Values of columns, and of parameters of statements.

use std::borrow::Cow;

use halfrow::Verdict;

/// The value of a column or a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Value<'a> {
    /// Nothing.
    Null,
    /// A whole number, or 0 and 1 for no and yes.
    Whole(i64),
    /// Another number.
    Real(f64),
    /// A text.
    Text(&'a str),
}

/// `text` as both engines can store it. PostgreSQL takes no U+0000 in a text, and what a person or a device said must reach a
/// plant.
pub(super) fn kept(text: &str) -> Cow<'_, str> {
    if text.contains('\0') { text.replace('\0', "\u{fffd}").into() } else { text.into() }
}

impl Value<'_> {
    pub(super) fn kind(self) -> &'static str {
        match self {
            Self::Null => "nothing",
            Self::Whole(_) => "a whole number",
            Self::Real(_) => "a number",
            Self::Text(_) => "a text",
        }
    }
}

impl From<i64> for Value<'_> {
    fn from(whole: i64) -> Self {
        Self::Whole(whole)
    }
}

impl From<u32> for Value<'_> {
    fn from(whole: u32) -> Self {
        Self::Whole(whole.into())
    }
}

impl From<u8> for Value<'_> {
    fn from(whole: u8) -> Self {
        Self::Whole(whole.into())
    }
}

impl From<f64> for Value<'_> {
    fn from(real: f64) -> Self {
        Self::Real(real)
    }
}

impl From<Verdict> for Value<'_> {
    fn from(verdict: Verdict) -> Self {
        Self::Text(verdict.name())
    }
}

impl<'a, T: AsRef<str> + ?Sized> From<&'a T> for Value<'a> {
    fn from(text: &'a T) -> Self {
        Self::Text(text.as_ref())
    }
}

impl<'a, T: Into<Value<'a>>> From<Option<T>> for Value<'a> {
    fn from(some: Option<T>) -> Self {
        some.map_or(Self::Null, Into::into)
    }
}

/// The values of a statement, from `$1` on.
macro_rules! values {
    ($($value:expr),* $(,)?) => { &[$($crate::store::Value::from($value)),*] };
}
pub(crate) use values;

/// What a column can be read as.
pub(crate) trait FromValue: Sized {
    /// What such a value is, in words for people.
    const EXPECTED: &'static str;

    /// The value, if it is of this type.
    fn from_value(value: Value<'_>) -> Option<Self>;
}

impl FromValue for i64 {
    const EXPECTED: &'static str = "a whole number";

    fn from_value(value: Value<'_>) -> Option<Self> {
        if let Value::Whole(whole) = value { Some(whole) } else { None }
    }
}

impl FromValue for u32 {
    const EXPECTED: &'static str = "a whole number from 0 to 4294967295";

    fn from_value(value: Value<'_>) -> Option<Self> {
        i64::from_value(value)?.try_into().ok()
    }
}

impl FromValue for u8 {
    const EXPECTED: &'static str = "a whole number from 0 to 255";

    fn from_value(value: Value<'_>) -> Option<Self> {
        i64::from_value(value)?.try_into().ok()
    }
}

impl FromValue for bool {
    const EXPECTED: &'static str = "yes or no";

    fn from_value(value: Value<'_>) -> Option<Self> {
        if let Value::Whole(whole @ 0..=1) = value { Some(whole == 1) } else { None }
    }
}

impl FromValue for f64 {
    const EXPECTED: &'static str = "a number";

    fn from_value(value: Value<'_>) -> Option<Self> {
        if let Value::Real(real) = value { Some(real) } else { None }
    }
}

impl FromValue for Verdict {
    const EXPECTED: &'static str = "PASS, FAIL or ERROR";

    fn from_value(value: Value<'_>) -> Option<Self> {
        Self::ALL.into_iter().find(|verdict| value == Value::from(*verdict))
    }
}

impl FromValue for String {
    const EXPECTED: &'static str = "a text";

    fn from_value(value: Value<'_>) -> Option<Self> {
        if let Value::Text(text) = value { Some(text.to_owned()) } else { None }
    }
}

impl<T: FromValue> FromValue for Option<T> {
    const EXPECTED: &'static str = T::EXPECTED;

    fn from_value(value: Value<'_>) -> Option<Self> {
        if value == Value::Null { Some(None) } else { T::from_value(value).map(Some) }
    }
}
