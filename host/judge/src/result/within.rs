//! What was taken of a run that had to keep within a time.

use serde::{Deserialize, Serialize};

/// What was taken of a run, why, and what was left out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WithinReport {
    /// The time that was allowed, in seconds of the link's clock.
    pub seconds: f64,
    /// The time that the run was expected to take, in seconds.
    pub expected_seconds: f64,
    /// The bytes a second that the link was assumed to carry; none where bytes take no time.
    pub bytes_per_second: Option<f64>,
    /// The round trip over the link, in seconds.
    pub round_trip: f64,
    /// Every part of a whole run, in its order.
    pub parts: Vec<WithinPart>,
    /// How many of the Verilog's measured single faults are found by the parts that were taken.
    pub found: usize,
    /// How many faults were measured.
    pub faults: usize,
    /// Whether they were measured with this run's tables and frames.
    pub measured: bool,
    /// Columns and rows of the frames that they were measured with.
    pub measured_at: [usize; 2],
    /// How many faults shorter and longer runs over this link find.
    pub curve: Vec<CoveragePoint>,
}

/// How much of a part was taken.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct WithinPart {
    /// Its name.
    pub part: String,
    /// Rows, or frames at speed, that were taken; 0 where the part was left out.
    pub taken: usize,
    /// How many there are in all.
    pub of: usize,
}

/// What a run of a given time finds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CoveragePoint {
    /// Its time, in seconds.
    pub seconds: f64,
    /// Faults found.
    pub found: usize,
}
