//! The names of a board's counters.

use halfrow_protocol::message::Status;
use serde::{Deserialize, Serialize};

/// What a board counts and the host also knows: mostly the counters of STATUS in `protocol/WIRE.md`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Counter {
    /// Rows that were accepted.
    RowsIn,
    /// Rows that came out.
    RowsOut,
    /// Samples above the depth.
    SamplesOver,
    /// The sequence number of the first row that has not arrived.
    NextRowIn,
    /// The sequence number of the first row that is not acknowledged.
    NextRowOut,
    /// The generation of the tables in use.
    Generation,
    /// Rows sent again.
    RowsRepeated,
    /// Rows that arrived without being needed.
    RowsUnneeded,
    /// Requests that were refused.
    Refusals,
    /// ROW_OUT packets, by the numbers in their headers.
    RowsNumbered,
    /// Packets that reached the board whole.
    Packets,
    /// Packets of another session.
    ForeignPackets,
    /// Whether a row is inside the core.
    CoreBusy,
    /// Packets with a wrong CRC.
    CrcErrors,
    /// Packets with broken stuffing, size, version or length.
    FramingErrors,
    /// The least latency of a row, in pixel clocks.
    LeastLatency,
    /// The greatest latency of a row, in pixel clocks.
    MostLatency,
}

impl Counter {
    /// What `status` says of it.
    #[must_use]
    pub(crate) const fn in_status(self, status: &Status) -> u32 {
        match self {
            Self::RowsIn => status.rows_in,
            Self::RowsOut => status.rows_out,
            Self::SamplesOver => status.samples_over,
            Self::NextRowIn => status.next_row_in,
            Self::NextRowOut => status.next_row_out,
            Self::Generation => status.generation,
            Self::RowsRepeated => status.rows_repeated,
            Self::RowsUnneeded => status.rows_unneeded,
            Self::Refusals => status.refusals,
            // Each is a row that came out or one that was sent again.
            Self::RowsNumbered => status.rows_out.saturating_add(status.rows_repeated),
            Self::Packets => status.packets,
            Self::ForeignPackets => status.foreign_packets,
            Self::CoreBusy => status.core_busy,
            Self::CrcErrors => status.crc_errors,
            Self::FramingErrors => status.framing_errors,
            Self::LeastLatency => status.least_latency,
            Self::MostLatency => status.most_latency,
        }
    }

    /// The words that follow its figure in a sentence.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::RowsIn => "rows in",
            Self::RowsOut => "rows out",
            Self::SamplesOver => "samples above the depth",
            Self::NextRowIn => "as the first row that has not arrived (next_row_in)",
            Self::NextRowOut => "as the first row that is not acknowledged (next_row_out)",
            Self::Generation => "as the tables' generation",
            Self::RowsRepeated => "rows sent again",
            Self::RowsUnneeded => "rows that were not needed",
            Self::Refusals => "refusals",
            Self::RowsNumbered => "ROW_OUT packets by their numbers",
            Self::Packets => "packets that came to it",
            Self::ForeignPackets => "packets of another session",
            Self::CoreBusy => "rows inside the core",
            Self::CrcErrors => "packets with a wrong CRC",
            Self::FramingErrors => "packets with broken stuffing, size, version or length",
            Self::LeastLatency => "pixel clocks as the least latency",
            Self::MostLatency => "pixel clocks as the greatest latency",
        }
    }

    /// The words before the right figure in a sentence, for counters of which the host knows only a bound.
    #[must_use]
    pub(super) const fn bound(self) -> &'static str {
        match self {
            Self::RowsNumbered => "at most ",
            Self::Packets | Self::CrcErrors | Self::FramingErrors => "at least ",
            _ => "",
        }
    }
}
