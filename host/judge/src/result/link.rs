//! What is told of the link.

use serde::{Deserialize, Serialize};

use super::Problem;
use crate::link::LineErrors;

/// What the link did.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LinkReport {
    /// The link, for people.
    pub name: String,
    /// Bytes written.
    pub bytes_out: u64,
    /// Bytes read.
    pub bytes_in: u64,
    /// Packets written, retries included.
    pub packets_out: u64,
    /// Packets read whole.
    pub packets_in: u64,
    /// Packets that came damaged.
    pub damaged_in: u64,
    /// Packets that the board got damaged, by its own count.
    pub damaged_out: u64,
    /// Packets sent again.
    pub retries: u64,
    /// Of those, the ones after which nothing turned out to be lost: the first answer was late.
    pub late: u64,
    /// Packets that nobody waited for: second answers, rows that were there already, and what is of another session.
    pub strays: u64,
    /// What the chip at the link's near end has seen go wrong on the line.
    pub line_errors: LineErrors,
    /// The most retries, late ones left out, over which the link is not too poor to judge a board.
    pub retry_limit: u64,
    /// The round trip of an empty request, in microseconds of the link's clock.
    pub round_trip_us: Option<u64>,
    /// The time that the run took on the link's clock, in seconds.
    pub seconds: f64,
    /// Every time that the board went away and came back, in order.
    pub reconnections: Vec<Reconnection>,
}

/// A board that went away during the run and came back.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reconnection {
    /// How it went, and what was under way.
    pub reason: Problem,
    /// How long it was away, in seconds.
    pub seconds_away: f64,
    /// Whether it still had its tables, so that it had not lost its power; none when it was not asked.
    #[serde(default)]
    pub kept_tables: Option<bool>,
}
