//! Options that take a number of something, within limits.

use std::ops::RangeInclusive;
use std::str::FromStr;
use std::time::Duration;

use clap::builder::{NonEmptyStringValueParser, TypedValueParser};

/// A number of `unit`, in the range `within`.
#[must_use]
pub fn number(unit: &'static str, within: RangeInclusive<f64>) -> impl TypedValueParser<Value = f64> {
    NonEmptyStringValueParser::new().try_map(move |text| {
        let number = text.parse().ok().filter(|number| within.contains(number));
        number.ok_or_else(|| format!("give a number of {unit}, {} to {}", within.start(), within.end()))
    })
}

/// A number as `wanted` names it, without limits: which values are legal depends on more than the value.
#[must_use]
pub fn any<T: FromStr + Clone + Send + Sync + 'static>(
    wanted: &'static str,
) -> impl TypedValueParser<Value = T> {
    NonEmptyStringValueParser::new().try_map(move |text| text.parse().map_err(|_| format!("give {wanted}")))
}

/// A whole number from `least`, and to `most` if there is such a limit.
#[must_use]
pub fn counted<T: TryFrom<u64> + Clone + Send + Sync + 'static>(
    least: u64,
    most: Option<u64>,
) -> impl TypedValueParser<Value = T> {
    NonEmptyStringValueParser::new().try_map(move |text| {
        let number = text.parse().ok().filter(|number| (least..=most.unwrap_or(u64::MAX)).contains(number));
        let wanted = match most {
            Some(most) => format!("give a whole number, {least} to {most}"),
            None => format!("give a whole number, {least} or more"),
        };
        number.and_then(|number| T::try_from(number).ok()).ok_or(wanted)
    })
}

/// A whole number, such as a seed.
#[must_use]
pub fn whole_number() -> impl TypedValueParser<Value = u64> {
    counted(0, Some(u64::MAX))
}

/// A number of seconds, in the range `within`.
#[must_use]
pub fn seconds(within: RangeInclusive<f64>) -> impl TypedValueParser<Value = Duration> {
    number("seconds", within).map(Duration::from_secs_f64)
}
