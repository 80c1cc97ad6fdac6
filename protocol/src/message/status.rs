//! STATUS: what a board has counted since its session began or since the counters were cleared.

use alloc::vec::Vec;

use crate::Malformed;
use crate::bytes::Fields;

macro_rules! status {
    ($($(#[$doc:meta])* $name:ident,)*) => {
        /// A board's counters, 32 bits each; they stay at their largest value instead of wrapping.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub struct Status {
            $($(#[$doc])* pub $name: u32,)*
        }

        impl Status {
            /// Every counter with its name, in the order of the wire.
            #[must_use]
            pub fn counters(&self) -> Vec<(&'static str, u32)> {
                alloc::vec![$((stringify!($name), self.$name),)*]
            }

            pub(crate) fn write(&self, payload: &mut Vec<u8>) {
                $(payload.extend_from_slice(&self.$name.to_le_bytes());)*
            }

            pub(crate) fn read(mut fields: Fields<'_>) -> Result<Self, Malformed> {
                let status = Self { $($name: fields.u32()?,)* };
                Ok(fields.end(status))
            }
        }
    };
}

status! {
    /// Packets that arrived intact.
    packets,
    /// Packets with a wrong CRC-32.
    crc_errors,
    /// Packets with broken stuffing, a wrong length or a wrong version.
    framing_errors,
    /// Packets of a session that is not open.
    foreign_packets,
    /// Requests refused.
    refusals,
    /// Rows accepted into a bank.
    rows_in,
    /// Rows whose last sample has left the core.
    rows_out,
    /// Rows sent again from their bank.
    rows_repeated,
    /// Rows that came again although the board has them or they were acknowledged.
    rows_unneeded,
    /// Samples at or above 2^B.
    samples_over,
    /// The first row sequence number that has not arrived.
    next_row_in,
    /// The first row sequence number that the host has not acknowledged.
    next_row_out,
    /// 1 while a row is inside the core.
    core_busy,
    /// The generation of the active tables, 0 for none.
    generation,
    /// The smallest first or last latency of any row, in pixel clocks; 0 before any.
    least_latency,
    /// The largest first or last latency of any row, in pixel clocks.
    most_latency,
}

impl Status {
    /// Packets that came damaged, in whichever way.
    #[must_use]
    pub const fn damaged(&self) -> u32 {
        self.crc_errors.saturating_add(self.framing_errors)
    }
}
