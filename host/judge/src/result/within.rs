//! What was taken of a run that had a time to keep within.

use serde::{Deserialize, Serialize};

/// What was taken of a run, why, and what was left out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WithinReport {
    /// The time that there was, in seconds of the link's clock.
    pub seconds: f64,
    /// What the run was expected to take of it.
    pub expected_seconds: f64,
    /// The bytes a second that the link was taken to carry; none where bytes take no time.
    pub bytes_per_second: Option<f64>,
    /// A round trip over it, in seconds.
    pub round_trip: f64,
    /// Every part of a whole run, in its order.
    pub parts: Vec<WithinPart>,
    /// Of the single faults of the Verilog that were measured, how many the parts that were taken find.
    pub found: usize,
    /// How many were measured.
    pub faults: usize,
    /// Whether they were measured with these tables and frames, and not with others.
    pub measured: bool,
    /// Columns and rows of the frames that they were measured with.
    pub measured_at: [usize; 2],
    /// What longer and shorter runs over this link find.
    pub curve: Vec<CoveragePoint>,
}

/// What was taken of a part.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct WithinPart {
    /// Its name.
    pub part: String,
    /// Rows, or frames at speed, of which there are `of`; 0 where it was left out.
    pub taken: usize,
    /// All that there are.
    pub of: usize,
}

/// What a run of so many seconds finds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CoveragePoint {
    /// Its time.
    pub seconds: f64,
    /// Faults found.
    pub found: usize,
}
