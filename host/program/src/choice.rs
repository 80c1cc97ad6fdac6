//! Options that take one of a few words.

use std::ffi::OsStr;

use clap::builder::{PossibleValue, TypedValueParser};
use clap::{Arg, Command};

/// What `inner` reads, with `words` for shells to complete. Errors are those of `inner`, which name the words themselves; so does the
/// help of such an option, which hides the list that clap would make of them.
#[must_use]
pub fn one_of<const N: usize, Inner: TypedValueParser>(
    words: [&'static str; N],
    inner: Inner,
) -> impl TypedValueParser<Value = Inner::Value> {
    OneOf { words, inner }
}

#[derive(Clone)]
struct OneOf<const N: usize, Inner> {
    words: [&'static str; N],
    inner: Inner,
}

impl<const N: usize, Inner: TypedValueParser> TypedValueParser for OneOf<N, Inner> {
    type Value = Inner::Value;

    fn parse_ref(
        &self,
        line: &Command,
        argument: Option<&Arg>,
        value: &OsStr,
    ) -> Result<Self::Value, clap::Error> {
        self.inner.parse_ref(line, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(self.words.iter().map(PossibleValue::new)))
    }
}
