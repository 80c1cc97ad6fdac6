//! REFUSAL: why a request was not carried out.

use alloc::vec::Vec;
use core::fmt;

use crate::Malformed;
use crate::bytes::Fields;

macro_rules! codes {
    ($($(#[$doc:meta])* $variant:ident = $code:literal, $name:literal, $text:literal;)*) => {
        /// Why a request was refused.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u8)]
        pub enum RefusalCode {
            $($(#[$doc])* $variant = $code,)*
        }

        impl RefusalCode {
            /// The reason with this code.
            #[must_use]
            pub fn from_code(code: u8) -> Option<Self> {
                match code {
                    $($code => Some(Self::$variant),)*
                    _ => None,
                }
            }

            /// Its name in WIRE.md, section 6.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)* }
            }
        }

        impl fmt::Display for RefusalCode {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(match self { $(Self::$variant => $text,)* })
            }
        }
    };
}

codes! {
    /// No common version of the wire; `detail` is the board's.
    Version = 1, "version", "the board speaks another version of the wire";
    /// The kind is not known to the board.
    Kind = 2, "kind", "the board does not know this request";
    /// The payload is not one of this kind.
    Payload = 3, "payload", "the request's payload is malformed";
    /// A value out of range; `detail` is the index of the entry, or the field's place in WIRE.md.
    Range = 4, "range", "a value is out of the board's range";
    /// The packet's session is not open.
    Session = 5, "session", "the session is not open: the board was reset, or another host has taken it over";
    /// Another host holds the board; `detail` is the time in tenths of a second until it would be free.
    Held = 6, "held", "another host holds the board";
    /// The core is not empty, or the shadow bank is still in use.
    Busy = 7, "busy", "the core is busy";
    /// Rows came before a configuration and a commit.
    NotReady = 8, "not ready", "geometry and tables have not been set";
    /// A table does not read back with the CRC that the host gave; `detail` is the table.
    TableCrc = 9, "table crc", "a table reads back with another CRC";
    /// A row at or beyond the window.
    Credit = 10, "credit", "a row was sent without credit";
    /// The row's place or width does not fit the configuration or the order.
    Row = 11, "row", "a row does not fit the configuration or the order";
    /// The kernel needs the outer taps, and the board has none; `detail` is the node.
    Taps = 12, "taps", "the kernel needs seven taps and the board has five";
}

/// A refused request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// Why.
    pub code: RefusalCode,
    /// The code of the kind of the request.
    pub kind: u8,
    /// Further detail; its meaning depends on the code.
    pub detail: u16,
}

impl Refusal {
    pub(crate) fn write(&self, payload: &mut Vec<u8>) {
        payload.extend_from_slice(&[self.code as u8, self.kind]);
        payload.extend_from_slice(&self.detail.to_le_bytes());
    }

    pub(crate) fn read(mut fields: Fields<'_>) -> Result<Self, Malformed> {
        let code = fields.u8()?;
        let refusal = Self {
            code: RefusalCode::from_code(code)
                .ok_or(Malformed::Value { field: "code", value: code.into() })?,
            kind: fields.u8()?,
            detail: fields.u16()?,
        };
        Ok(fields.end(refusal))
    }
}
