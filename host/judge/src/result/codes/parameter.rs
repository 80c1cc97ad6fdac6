//! The figures and names of errors in JSON.

use std::path::PathBuf;
use std::time::Duration;

use halfrow_model::{BitDepth, Interpolant, Phase};
use halfrow_protocol::Kind;
use halfrow_protocol::message::{Refusal, RowPlace};
use serde_json::{Value, json};

use crate::frames::RawLayout;
use crate::link::{Holder, UsbBoard};
use crate::link_test::Errors;
use crate::tables::Place;
use crate::verdict::StoppedBy;

/// A figure or a name of an error.
pub trait Parameter {
    /// The value in JSON. Times are in seconds.
    fn parameter(&self) -> Value;
}

/// Implements [`Parameter`] for types that JSON can hold.
macro_rules! as_they_are {
    ($($kind:ty),+) => { $(impl Parameter for $kind {
        fn parameter(&self) -> Value {
            json!(self)
        }
    })+ };
}
as_they_are!(u8, u16, u32, u64, usize, i32, i64, f64, bool, String, &'static str);
as_they_are!(Box<Errors>, StoppedBy, UsbBoard);

/// Implements [`Parameter`] for types that are written as their text.
macro_rules! by_words {
    ($($kind:ty),+ $(,)?) => { $(impl Parameter for $kind {
        fn parameter(&self) -> Value {
            self.to_string().into()
        }
    })+ };
}
by_words!(Holder, Interpolant, Phase, Place, RawLayout, char, i128);

impl Parameter for PathBuf {
    fn parameter(&self) -> Value {
        self.display().to_string().into()
    }
}

impl Parameter for Duration {
    fn parameter(&self) -> Value {
        self.as_secs_f64().into()
    }
}

impl<T: Parameter> Parameter for Vec<T> {
    fn parameter(&self) -> Value {
        self.iter().map(Parameter::parameter).collect()
    }
}

impl<T: Parameter> Parameter for Option<T> {
    fn parameter(&self) -> Value {
        self.as_ref().map_or(Value::Null, Parameter::parameter)
    }
}

impl Parameter for Kind {
    fn parameter(&self) -> Value {
        self.name().into()
    }
}

impl Parameter for Refusal {
    fn parameter(&self) -> Value {
        json!({ "code": self.code as u8, "reason": self.code.name(), "detail": self.detail })
    }
}

impl Parameter for RowPlace {
    fn parameter(&self) -> Value {
        json!({ "frame": self.frame, "row": self.row })
    }
}

impl Parameter for BitDepth {
    fn parameter(&self) -> Value {
        self.bits().into()
    }
}

#[cfg(test)]
mod tests {
    use halfrow_protocol::message::RefusalCode;

    use super::*;

    #[test]
    fn programs_read_the_names_of_the_wires_page() {
        assert_eq!(Kind::TableWrite.parameter(), "TABLE_WRITE");
        let refusal = Refusal { code: RefusalCode::NotReady, kind: 0x13, detail: 0 };
        assert_eq!(refusal.parameter(), json!({ "code": 8, "reason": "not ready", "detail": 0 }));
        assert_eq!(StoppedBy::Disconnection.parameter(), "disconnection");
    }
}
