//! The record of a run: one JSON file with all that is known of it. The tables of the store are its index.

mod blobs;
mod conclude;
mod ended;
mod measured;
mod not_exercised;
mod step;
mod unnamed;

use std::time::Duration;

use halfrow::Verdict;
use halfrow::result::FileHash;
use serde::{Deserialize, Serialize};

use crate::plan::Production;
use crate::plan::mock::is_mock;

pub use blobs::{BlobError, Blobs};
pub(crate) use blobs::{Piece, is_hash, made_within, synced};
pub use conclude::Conclusion;
pub(crate) use conclude::TEST_AGAIN;
pub use measured::{Measured, MeasuredOutcome, judged};
pub(crate) use not_exercised::in_one_line;
pub(crate) use step::last_tries;
pub use step::{BoardSeen, DeviceSeen, RunCause, StepOutcome, StepRecord, SuspectRecord};
pub(crate) use unnamed::UnnamedRecord;

/// What a PASS says if it could not be checked whether the board has the scanned serial number.
pub(crate) const IDENTITY_NOT_CHECKED: &str = "identity not checked";

/// The version of the record's format.
pub const SCHEMA: u32 = 1;

/// A run that is over, however it ended. Unknown keys, which a later program may have added, are skipped at every level. This
/// loses nothing: the bytes are checked against their hash, and a record that was read is never written again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// [`SCHEMA`]
    pub schema: u32,
    /// What was known before the board was touched.
    pub run: RunHead,
    /// When it ended, in milliseconds since 1970, UTC.
    pub ended_ms: i64,
    /// How long it took by a monotonic clock, in seconds; none after a crash.
    pub seconds: Option<f64>,
    /// Its result.
    pub conclusion: Conclusion,
    /// The plan, complete.
    pub plan: PlanRecord,
    /// Whether the run counts as production: the plan takes only hardware, the unit does not serve to check shifts, and the
    /// shift was checked.
    pub production: bool,
    /// Whether a step needed more than one try.
    pub marginal: bool,
    /// The board, if it identified itself.
    pub board: Option<BoardSeen>,
    /// What the store knew of the board's device before it was judged.
    pub device: DeviceSeen,
    /// Every try of every step, in order.
    pub steps: Vec<StepRecord>,
    /// Measurements of the run as a whole.
    pub measurements: Vec<Measured>,
    /// The suspected parts, the likeliest first.
    pub suspects: Vec<SuspectRecord>,
    /// Further evidence, each under its hash.
    pub attachments: Vec<Attachment>,
    /// The program that judged, and the commit that it was built from.
    pub program: String,
}

/// What is known of a run before the board is touched.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
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
    /// The number of this run as holder of its lane; it only grows.
    pub fence: i64,
    /// When it began, in milliseconds since 1970, UTC.
    pub started_ms: i64,
    /// The job that it belongs to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub job: Option<JobClaim>,
}

/// A station's claim of a job of the plant.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct JobClaim {
    /// The job, a UUID of version 7.
    pub id: String,
    /// The number of the claim, higher than that of every earlier claim of the job. Only the run of the last claim counts.
    pub fence: i64,
}

/// The plan of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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

/// Evidence in addition to the record.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Attachment {
    /// Its name within the run.
    pub name: String,
    /// SHA-256 of its bytes.
    pub sha256: String,
    /// How many bytes it has.
    pub bytes: u64,
    /// Its media type.
    pub media_type: String,
}

/// A record that must not be stored.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// A measurement came to something that is not a number.
    #[error(
        "the measurement {name} came to {value}, which is no number; report this with the plan and the board"
    )]
    NotANumber {
        /// The measurement.
        name: String,
        /// Its value.
        value: f64,
    },
    /// The record says PASS, but lacks the outcome of a step of the plan.
    #[error(
        "the record says PASS and has no outcome of step {seq} of {steps}; run the board again, and report this"
    )]
    Incomplete {
        /// The step.
        seq: u32,
        /// How many steps the plan has.
        steps: u32,
    },
    /// The record has a schema that this program does not read.
    #[error(
        "the record is of schema {schema}, and this program reads schema {SCHEMA}; use the halfrow-station that made it"
    )]
    OtherSchema {
        /// Its schema.
        schema: u32,
    },
    /// The record could not be written as JSON, or not read.
    #[error(
        "the record is not what schema {SCHEMA} is to this program; use the halfrow-station that made it, and if this is the one, report \
         this with the record"
    )]
    Json(#[source] serde_json::Error),
}

impl Record {
    /// The bytes to store, for a plan of `steps` steps.
    ///
    /// # Errors
    /// [`RecordError`] when a measurement is no finite number, or a PASS has no outcome of a step.
    pub fn bytes(&self, steps: u32) -> Result<Vec<u8>, RecordError> {
        let measured = self.steps.iter().flat_map(|step| &step.measurements).chain(&self.measurements);
        for Measured { name, value, .. } in measured {
            if let Some(value) = value.filter(|value| !value.is_finite()) {
                return Err(RecordError::NotANumber { name: name.clone(), value });
            }
        }
        if self.conclusion.verdict == Verdict::Pass {
            let passed = |seq: &u32| {
                let last = last_tries(&self.steps).filter(|step| step.seq == *seq).last();
                last.is_some_and(|step| step.outcome == StepOutcome::Passed)
            };
            if let Some(seq) = (1..=steps.max(1)).find(|seq| !passed(seq)) {
                return Err(RecordError::Incomplete { seq, steps });
            }
        }
        let mut bytes = serde_json::to_vec_pretty(self).map_err(RecordError::Json)?;
        bytes.push(b'\n');
        Ok(bytes)
    }

    /// How long it took. After a crash this is by the computer's clock, and none if that was set back meanwhile.
    #[must_use]
    pub fn took(&self) -> Option<Duration> {
        self.seconds.map_or_else(
            || between(self.run.started_ms, self.ended_ms),
            |seconds| Duration::try_from_secs_f64(seconds).ok(),
        )
    }

    /// How long one of its steps took by the computer's clock; none if that would be negative or longer than the run, because the
    /// clock was set meanwhile.
    #[must_use]
    pub(crate) fn took_for(&self, step: &StepRecord) -> Option<Duration> {
        let whole = self.seconds.unwrap_or(f64::INFINITY) + SLACK;
        between(step.started_ms, step.ended_ms).filter(|took| took.as_secs_f64() <= whole)
    }

    /// The device that this run binds to its serial number, if it judged the board and neither of the two was bound before.
    #[must_use]
    pub fn binds(&self) -> Option<&str> {
        let is_new = self.device == DeviceSeen::New && self.conclusion.verdict != Verdict::Error;
        self.board.as_ref().filter(|_| is_new)?.device.as_deref()
    }

    /// Whether its unit checks shifts by its plan, and so is no product: it counts nowhere.
    pub(crate) fn is_of_reference(&self) -> bool {
        self.is_reference_by(Production::of_text(&self.plan.text).as_ref())
    }

    /// The same by what its plan demands, for whoever has read that before.
    pub(crate) fn is_reference_by(&self, production: Option<&Production>) -> bool {
        let serial = &self.run.serial;
        is_mock(serial) || production.is_some_and(|production| production.is_reference(serial))
    }

    /// Parses a record.
    ///
    /// # Errors
    /// [`RecordError::OtherSchema`], [`RecordError::Json`]
    pub fn parse(bytes: &[u8]) -> Result<Self, RecordError> {
        let record = serde_json::from_slice::<Self>(bytes);
        let schema = match &record {
            Ok(record) => record.schema,
            Err(_) => serde_json::from_slice(bytes).map_or(SCHEMA, |Numbered { schema }| schema),
        };
        if schema == SCHEMA {
            record.map_err(RecordError::Json)
        } else {
            Err(RecordError::OtherSchema { schema })
        }
    }
}

/// What records of every schema have in common.
#[derive(Deserialize)]
struct Numbered {
    schema: u32,
}

/// By how many seconds the clock of a run and that of its steps may differ without being set.
const SLACK: f64 = 1.0;

fn between(from_ms: i64, to_ms: i64) -> Option<Duration> {
    u64::try_from(to_ms.checked_sub(from_ms)?).ok().map(Duration::from_millis)
}

#[cfg(test)]
pub(crate) mod tests {
    pub(crate) use super::conclude::tests::{step, steps};

    use std::fmt::Display;

    use serde::de::DeserializeOwned;
    use serde_json::json;

    use super::*;
    use crate::plan::check_digit::CheckDigit;
    use crate::plan::limits::{Blame, Maker};

    pub(crate) fn pass() -> Record {
        let run = RunHead {
            id: "017f22e2-79b0-7cc3-98c4-dc0c0c07398f".to_owned(),
            station: "12".to_owned(),
            lane: "1".to_owned(),
            unit_id: "017f22e2-79b0-7cc3-98c4-dc0c0c073990".to_owned(),
            product: "CAM-A".to_owned(),
            serial: "CA1".to_owned(),
            variant: String::new(),
            operator: "weber".to_owned(),
            target: "mock".to_owned(),
            fence: 1,
            started_ms: 1,
            job: None,
        };
        let [sha256, name, version, text] = ["0", "n", "1", "t"].map(str::to_owned);
        Record {
            schema: SCHEMA,
            run,
            ended_ms: 2,
            seconds: Some(0.001),
            conclusion: Conclusion {
                verdict: Verdict::Pass,
                cause: RunCause::None,
                exit_code: 0,
                headline: "all is right".to_owned(),
                remedy: None,
                finding: None,
            },
            plan: PlanRecord { sha256, name, version, text, files: Some(Vec::new()) },
            production: true,
            marginal: false,
            board: None,
            device: DeviceSeen::NotChecked,
            steps: Vec::new(),
            measurements: judged(Maker::Run, &[("run.seconds", Some(0.001))], &[]),
            suspects: Vec::new(),
            attachments: Vec::new(),
            program: "halfrow".to_owned(),
        }
    }

    #[test]
    fn a_pass_without_an_outcome_of_a_step_is_not_stored() {
        assert!(matches!(pass().bytes(1), Err(RecordError::Incomplete { seq: 1, steps: 1 })));
        let mut error = pass();
        error.conclusion = Conclusion::error(RunCause::Crash, crate::said::Saying::LaneEndless);
        let bytes = error.bytes(1).unwrap();
        assert_eq!(Record::parse(&bytes).unwrap(), error);
    }

    #[test]
    fn the_last_try_of_a_step_is_the_one_with_the_highest_number() {
        let stored = |steps| Record { steps, ..pass() }.bytes(1);
        let passed = |attempt| step(1, attempt, StepOutcome::Passed, RunCause::None);
        let error = |attempt| step(1, attempt, StepOutcome::Error, RunCause::Link);
        assert!(stored(vec![passed(2), error(1)]).is_ok());
        assert!(matches!(stored(vec![error(2), passed(1)]), Err(RecordError::Incomplete { .. })));
    }

    /// Pages and tables call a value by its name, and records hold what serde makes of it.
    #[test]
    fn a_value_is_called_what_it_is_stored_as() {
        fn named<T: DeserializeOwned + Display>() {
            let unknown = serde_json::from_str::<T>(r#""?""#).err().unwrap().to_string();
            // It goes on with all that there are: unknown variant `?`, expected one of `passed`, `failed`, …
            let all: Vec<_> = unknown.split('`').skip(3).step_by(2).collect();
            assert!(!all.is_empty(), "{unknown}");
            for one in all {
                assert_eq!(serde_json::from_value::<T>(json!(one)).unwrap().to_string(), one);
            }
        }
        named::<StepOutcome>();
        named::<RunCause>();
        named::<MeasuredOutcome>();
        named::<Blame>();
        named::<CheckDigit>();
        named::<Verdict>();
    }

    /// JSON has no such number: it would become `null`, which says that nothing was measured.
    #[test]
    fn a_measurement_that_is_no_number_is_not_stored() {
        let mut record = pass();
        record.conclusion = Conclusion::error(RunCause::Crash, crate::said::Saying::LaneEndless);
        for wrong in [f64::NAN, f64::INFINITY] {
            record.measurements[0].value = Some(wrong);
            assert!(matches!(record.bytes(1), Err(RecordError::NotANumber { .. })));
        }
    }
}
