//! What every JSON document begins with.

use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

use super::{BoardReport, Problem};
use crate::exit::Exit;
use crate::verdict::Verdict;

/// The version of the shape of all documents. It goes up when a key is removed or changes its meaning, not when one is added.
const SCHEMA: u32 = 1;

/// The version of a document's shape. A document with any other is not read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Schema;

impl Serialize for Schema {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_u32(SCHEMA)
    }
}

impl<'de> Deserialize<'de> for Schema {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match u64::deserialize(deserializer)? {
            number if number == u64::from(SCHEMA) => Ok(Self),
            other => Err(de::Error::custom(format!(
                "schema {other} is not the one that this program reads, {SCHEMA}; read it with the halfrow that wrote it"
            ))),
        }
    }
}

/// The result of a command, or the reason why there is none.
#[derive(Clone, Debug, Serialize)]
pub struct Document<'a, T> {
    /// The shape.
    pub schema: Schema,
    /// The command that was given.
    pub command: &'a str,
    /// The judgement; none for a command that judges nothing.
    pub verdict: Option<Verdict>,
    /// The exit code of a program that ends with this document.
    pub exit_code: Exit,
    /// The board, if one was used.
    pub board: Option<&'a BoardReport>,
    /// Why there is no result; none where there is one.
    pub error: Option<&'a Problem>,
    /// The command's own keys.
    #[serde(flatten)]
    pub rest: T,
}
