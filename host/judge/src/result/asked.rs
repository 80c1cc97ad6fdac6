//! The request that a finding is about.

use serde::{Deserialize, Serialize};

/// A request as it was sent.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Asked {
    /// The sequence in the header of its packet, by which a host counts its packets.
    pub sequence: u16,
    /// Bytes of its payload.
    pub bytes: usize,
    /// The fields that the payload has room for, in their order on the wire; none of a kind without fields.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fields: Vec<Field>,
    /// The first 16 bytes behind the fields, in hexadecimal, and `…` if there are more.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub rest: String,
    /// The frame of a commit that was pending, if the answer depends on it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pending: Option<u16>,
}

/// A field of a request.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Field {
    /// Its name (WIRE.md, section 3).
    pub name: String,
    /// Its value.
    pub value: u32,
}
