//! What is measured, and limits on it that say whom they blame.

use serde::{Deserialize, Serialize};
use strum::{AsRefStr, Display};

/// Who is to blame for a measurement beyond its limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, AsRefStr, Display)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum Blame {
    /// The board: FAIL.
    Board,
    /// The station: ERROR.
    Station,
    /// Nobody: it is recorded, and judges nothing.
    Nobody,
}

/// What makes a measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Maker {
    /// The whole run.
    Run,
    /// A step `link`.
    Link,
    /// A step `verify`.
    Verify,
}

/// Something that is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Measurement {
    /// Its name: stable.
    pub name: &'static str,
    /// Its unit; `1` for a number of things.
    pub unit: &'static str,
    /// What makes it.
    pub made_by: Maker,
    /// Whom a limit on it blames unless it says otherwise.
    pub blames: Blame,
    /// What it is, in words for people.
    pub meaning: &'static str,
}

const fn of(
    name: &'static str,
    unit: &'static str,
    made_by: Maker,
    blames: Blame,
    meaning: &'static str,
) -> Measurement {
    Measurement { name, unit, made_by, blames, meaning }
}

/// Samples that differ from the reference. Their only limit is 0, which a plan cannot change.
pub const SAMPLES_DIFFERING: &str = "frames.samples_differing";

/// Everything that is measured.
pub const MEASUREMENTS: [Measurement; 11] = [
    of("run.seconds", "s", Maker::Run, Blame::Nobody, "from the board's first touch to the last step's end"),
    of("link.round_trip", "us", Maker::Link, Blame::Station, "an empty request and its answer, median"),
    of("link.to_board", "B/s", Maker::Link, Blame::Station, "full packets to the board"),
    of("link.to_host", "B/s", Maker::Link, Blame::Station, "full packets from the board"),
    of("link.together", "B/s", Maker::Link, Blame::Station, "rows both ways at once, the slower way"),
    of("link.retries", "1", Maker::Link, Blame::Station, "packets that were sent again"),
    of(
        "latency.clocks",
        "clocks",
        Maker::Verify,
        Blame::Board,
        "the latest row, from sample in to sample out",
    ),
    of("latency.microseconds", "us", Maker::Verify, Blame::Board, "the same by the board's pixel clock"),
    of("verify.retries", "1", Maker::Verify, Blame::Station, "packets that were sent again"),
    of("verify.seconds", "s", Maker::Verify, Blame::Nobody, "the step, by the wall's clock"),
    of(SAMPLES_DIFFERING, "1", Maker::Verify, Blame::Board, "samples that differ from the reference"),
];

impl Measurement {
    /// The measurement with this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        MEASUREMENTS.into_iter().find(|measurement| measurement.name == name)
    }

    /// Whether it is the time that samples take through the board, which is never 0.
    #[must_use]
    pub(super) fn is_latency(&self) -> bool {
        self.name.starts_with("latency.")
    }
}

/// A limit on a measurement. It has a least value, a most value, or both.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Limit {
    /// What it limits.
    pub measurement: Measurement,
    /// The least value that is right.
    pub least: Option<f64>,
    /// The most.
    pub most: Option<f64>,
    /// Whom it blames.
    pub blames: Blame,
}

impl Limit {
    /// Whether `value` is right.
    #[must_use]
    pub fn allows(&self, value: f64) -> bool {
        self.least.is_none_or(|least| value >= least) && self.most.is_none_or(|most| value <= most)
    }
}
