//! The record of a run: one JSON file that says all of it. The tables of the store are its index.

mod blobs;
mod conclude;
mod step;

use halfrow::Verdict;
use halfrow::result::FileHash;
use serde::{Deserialize, Serialize};

pub(crate) use blobs::synced;
pub use blobs::{BlobError, Blobs};
pub use conclude::Conclusion;
pub use step::{
    BoardSeen, Measured, MeasuredOutcome, RunCause, StepOutcome, StepRecord, SuspectRecord, judged,
};

/// The version of the record's format.
pub const SCHEMA: u32 = 1;

/// A run that is over, however it ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// [`SCHEMA`]
    pub schema: u32,
    /// What was known before the board was touched.
    pub run: RunHead,
    /// When it ended, in milliseconds since 1970, UTC.
    pub ended_ms: i64,
    /// How long it took by a clock that nobody sets, in seconds; none after a crash.
    pub seconds: Option<f64>,
    /// What it came to.
    pub conclusion: Conclusion,
    /// The plan, whole.
    pub plan: PlanRecord,
    /// Whether the plan takes hardware alone: without that no run counts as production.
    pub production: bool,
    /// Whether a step needed more than one try.
    pub marginal: bool,
    /// The board, as soon as it had said who it is.
    pub board: Option<BoardSeen>,
    /// Every try of every step, in order.
    pub steps: Vec<StepRecord>,
    /// Measurements of the run as a whole.
    pub measurements: Vec<Measured>,
    /// The parts that are suspected, the likeliest first.
    pub suspects: Vec<SuspectRecord>,
    /// Further evidence, each under its hash.
    pub attachments: Vec<Attachment>,
    /// The program that judged, and the commit that it was built from.
    pub program: String,
}

/// What is known of a run before the board is touched.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunHead {
    /// The run, a UUID of version 7.
    pub id: String,
    /// The station.
    pub station: String,
    /// The lane.
    pub lane: String,
    /// The unit, a UUID.
    pub unit_id: String,
    /// The product.
    pub product: String,
    /// The serial number.
    pub serial: String,
    /// The variant; empty if the serial number names none.
    pub variant: String,
    /// Who started it.
    pub operator: String,
    /// The target string of the board.
    pub target: String,
    /// The how-manieth holder of the lane this run is.
    pub fence: i64,
    /// When it began, in milliseconds since 1970, UTC.
    pub started_ms: i64,
}

/// The plan of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlanRecord {
    /// Hash of its text and files.
    pub sha256: String,
    /// Its name.
    pub name: String,
    /// Its version.
    pub version: String,
    /// Its text.
    pub text: String,
    /// The files that it names, in order; none are known after a crash.
    pub files: Option<Vec<FileHash>>,
}

/// Evidence beside the record.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Attachment {
    /// Its name within the run.
    pub name: String,
    /// SHA-256 of its bytes.
    pub sha256: String,
    /// How many they are.
    pub bytes: u64,
    /// Its media type.
    pub media_type: String,
}

/// A record that must not be stored.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// A number is none.
    #[error(
        "the measurement {name} came to {value}, which is no number; report this with the plan and the board"
    )]
    NotANumber {
        /// Of what.
        name: String,
        /// What it came to.
        value: f64,
    },
    /// A PASS does not tell of every step that the plan has.
    #[error(
        "the record says PASS and has no outcome of step {seq} of {steps}; run the board again, and report this"
    )]
    Incomplete {
        /// The step.
        seq: u32,
        /// The plan's steps.
        steps: u32,
    },
    /// It cannot be written as JSON, or read.
    #[error("the record is no JSON of schema {SCHEMA}; report this with the record")]
    Json(#[source] serde_json::Error),
}

impl Record {
    /// What is stored, for a plan of `steps` steps.
    ///
    /// # Errors
    /// [`RecordError`] when it says what no record may say.
    pub fn bytes(&self, steps: u32) -> Result<Vec<u8>, RecordError> {
        let measured = self.steps.iter().flat_map(|step| &step.measurements).chain(&self.measurements);
        for Measured { name, value, .. } in measured {
            if let Some(value) = value.filter(|value| !value.is_finite()) {
                return Err(RecordError::NotANumber { name: name.clone(), value });
            }
        }
        if self.conclusion.verdict == Verdict::Pass {
            let passed = |seq: &u32| {
                let mut tries = self.steps.iter().rev().filter(|step| step.seq == *seq);
                tries.next().is_some_and(|step| step.outcome == StepOutcome::Passed)
            };
            if let Some(seq) = (1..=steps.max(1)).find(|seq| !passed(seq)) {
                return Err(RecordError::Incomplete { seq, steps });
            }
        }
        let mut bytes = serde_json::to_vec_pretty(self).map_err(RecordError::Json)?;
        bytes.push(b'\n');
        Ok(bytes)
    }

    /// The record that these bytes are.
    ///
    /// # Errors
    /// [`RecordError::Json`]
    pub fn parse(bytes: &[u8]) -> Result<Self, RecordError> {
        serde_json::from_slice(bytes).map_err(RecordError::Json)
    }
}
