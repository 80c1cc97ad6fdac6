//! Faults by name. One table says what each does and what can be set; the list of faults and the parser follow from it.

use std::collections::BTreeMap;

use crate::value::{Decimal, Limits, ValueError, parse_word};

/// Parameters by key, as in `bit=5,value=1`.
pub type Parameters = BTreeMap<String, String>;

/// What a fault spoils.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The bytes between host and board.
    Pipe,
    /// The board itself.
    Board,
}

impl Place {
    /// The place, in one word.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pipe => "wire",
            Self::Board => "board",
        }
    }
}

/// The values that a parameter may have, both ends included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Range {
    /// Whole numbers.
    Whole(i64, i64),
    /// Numbers with a fraction.
    Decimal(f64, f64),
    /// One of some words.
    Words(&'static [&'static str]),
}

impl std::fmt::Display for Range {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Whole(least, most) => write!(to, "{least} to {most}"),
            Self::Decimal(least, most) => write!(to, "{least} to {most}"),
            Self::Words(words) => to.write_str(&words.join(", ")),
        }
    }
}

/// A parameter of a fault.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Its name, as in `bit=5`.
    pub key: &'static str,
    /// The values that it may have.
    pub range: Range,
    /// Its value when it is not given, as text; none if the fault needs no value.
    pub default: Option<&'static str>,
    /// What it means.
    pub meaning: &'static str,
}

impl Parameter {
    /// A parameter.
    #[must_use]
    pub const fn new(
        key: &'static str,
        range: Range,
        default: Option<&'static str>,
        meaning: &'static str,
    ) -> Self {
        Self { key, range, default, meaning }
    }

    fn parse(&self, text: &str) -> Result<Value, ValueError> {
        match self.range {
            Range::Whole(least, most) => Limits::new(self.key, least, most).parse(text).map(Value::Whole),
            Range::Decimal(least, most) => {
                Decimal::new(self.key, least, most).parse(text).map(Value::Decimal)
            }
            Range::Words(words) => {
                let places: Vec<_> = words.iter().copied().zip(0..).collect();
                parse_word(self.key, text, &places).map(Value::Word)
            }
        }
    }
}

/// What a parameter was set to.
#[derive(Clone, Copy, Debug)]
enum Value {
    Whole(i64),
    Decimal(f64),
    /// The index of the word in its range.
    Word(usize),
}

/// The values of a fault's parameters. A given value takes precedence over the default.
#[derive(Debug)]
pub struct Values {
    given: BTreeMap<&'static str, Value>,
    defaults: BTreeMap<&'static str, Value>,
}

impl Values {
    /// Takes the values of `parameters` out of `from`.
    fn take(parameters: &[Parameter], from: &mut Parameters) -> Result<Self, ValueError> {
        let mut values = Self { given: BTreeMap::new(), defaults: BTreeMap::new() };
        for parameter in parameters {
            if let Some(default) = parameter.default {
                values.defaults.insert(parameter.key, parameter.parse(default)?);
            }
            if let Some(text) = from.remove(parameter.key) {
                values.given.insert(parameter.key, parameter.parse(&text)?);
            }
        }
        Ok(values)
    }

    /// Whether the parameter was given, and not just left at its default.
    #[must_use]
    pub fn is_given(&self, key: &str) -> bool {
        self.given.contains_key(key)
    }

    fn get(&self, key: &str) -> Option<Value> {
        self.given.get(key).or_else(|| self.defaults.get(key)).copied()
    }

    /// A whole number.
    ///
    /// # Errors
    /// [`ValueError::Missing`] when the fault has no such number, or it is outside the range of `T`.
    pub fn whole<T: TryFrom<i64>>(&self, key: &'static str) -> Result<T, ValueError> {
        let whole = self.get(key).and_then(|value| match value {
            Value::Whole(whole) => T::try_from(whole).ok(),
            Value::Decimal(_) | Value::Word(_) => None,
        });
        whole.ok_or(ValueError::Missing { key })
    }

    /// A number with a fraction.
    ///
    /// # Errors
    /// [`ValueError::Missing`] when the fault has no such number.
    pub fn decimal(&self, key: &'static str) -> Result<f64, ValueError> {
        match self.get(key) {
            Some(Value::Decimal(decimal)) => Ok(decimal),
            _ => Err(ValueError::Missing { key }),
        }
    }

    /// The one of `choices` at the index that the word has in its range.
    ///
    /// # Errors
    /// [`ValueError::Missing`] when the fault has no such word.
    pub fn choice<T: Copy>(&self, key: &'static str, choices: &[T]) -> Result<T, ValueError> {
        let choice = self.get(key).and_then(|value| match value {
            Value::Word(place) => choices.get(place).copied(),
            Value::Whole(_) | Value::Decimal(_) => None,
        });
        choice.ok_or(ValueError::Missing { key })
    }
}

/// The description of a fault.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaultInfo {
    /// The name, as in `fault=late`.
    pub name: &'static str,
    /// What the fault spoils.
    pub place: Place,
    /// What happens, in one line.
    pub what: &'static str,
    /// What can be set.
    pub parameters: &'static [Parameter],
}

impl FaultInfo {
    /// What happens, with the parameters and their defaults, as in `a row goes in and never comes out (row=3)`. A parameter
    /// without a default is shown as `reads=N`.
    #[must_use]
    pub fn summary(&self) -> String {
        let shown = |it: &Parameter| format!("{}={}", it.key, it.default.unwrap_or("N"));
        let parameters: Vec<_> = self.parameters.iter().map(shown).collect();
        match parameters.as_slice() {
            [] => self.what.to_owned(),
            parameters => format!("{} ({})", self.what, parameters.join(", ")),
        }
    }

    /// Whether the fault has this parameter.
    #[must_use]
    pub fn takes(&self, key: &str) -> bool {
        self.parameters.iter().any(|parameter| parameter.key == key)
    }
}

/// A line of a table of faults; `T` is the type of the fault that it makes.
#[derive(Clone, Copy, Debug)]
pub struct Fault<T: 'static> {
    /// Its description.
    pub info: FaultInfo,
    make: fn(&Values) -> Result<T, ValueError>,
}

impl<T> Fault<T> {
    /// The fault called `name`, which does `what` to `place`. `make` makes it from the values of its `parameters`.
    #[must_use]
    pub const fn new(
        name: &'static str,
        place: Place,
        what: &'static str,
        parameters: &'static [Parameter],
        make: fn(&Values) -> Result<T, ValueError>,
    ) -> Self {
        Self { info: FaultInfo { name, place, what, parameters }, make }
    }

    /// The one of `faults` that is called `name`.
    pub(crate) fn find<'a>(faults: &'a [Self], name: &str) -> Option<&'a Self> {
        faults.iter().find(|fault| fault.info.name == name)
    }

    /// Makes the fault. Takes its own parameters out of `parameters` and leaves the others there.
    ///
    /// # Errors
    /// [`FaultError`] when one is out of range, or contradicts another.
    pub fn make(&self, parameters: &mut Parameters) -> Result<T, FaultError> {
        Values::take(self.info.parameters, parameters)
            .and_then(|values| (self.make)(&values))
            .map_err(|source| FaultError { fault: self.info.name.to_owned(), source })
    }
}

/// The value of a parameter of the fault is wrong, or contradicts another.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("fault={fault} has a wrong parameter")]
pub struct FaultError {
    /// The fault's name.
    pub fault: String,
    /// What is wrong.
    #[source]
    pub source: ValueError,
}
