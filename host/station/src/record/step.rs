//! The result of a step of a run.

use halfrow::result::codes;
use halfrow::target::BoardKind;
use halfrow::verdict::{Cause, StoppedBy};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use strum::{AsRefStr, Display};

use super::measured::Measured;
use crate::exit::Exit;
use crate::plan::Step;
use crate::said::{Said, Saying};

/// One try of one step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepRecord {
    /// Its place in the plan, from 1.
    pub seq: u32,
    /// Which try, from 1.
    pub attempt: u32,
    /// Its name.
    pub name: String,
    /// What it does: `identity`, `link` or `verify`.
    pub kind: String,
    /// Its outcome.
    pub outcome: StepOutcome,
    /// Why.
    pub cause: RunCause,
    /// The exit code of a run that ends with it.
    pub exit_code: u8,
    /// When it began, in milliseconds since 1970, UTC.
    pub started_ms: i64,
    /// When it ended.
    pub ended_ms: i64,
    /// What was seen, in one sentence.
    pub detail: String,
    /// The same with its code.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub finding: Option<Said>,
    /// What to do next.
    pub remedy: Option<String>,
    /// What was measured.
    pub measurements: Vec<Measured>,
    /// The suspected parts, the likeliest first.
    pub suspects: Vec<SuspectRecord>,
    /// The board, if it identified itself.
    pub board: Option<BoardSeen>,
    /// Everything that the judge reported: the report of `verify`, the figures of `link`.
    pub evidence: Option<Value>,
}

impl StepRecord {
    /// Adds to an ERROR why nothing repeats the step without a person, though the plan has a retry left: the board
    /// `was_wrong`, or else it or its connection was away.
    pub(crate) fn not_repeated(&mut self, was_wrong: bool) {
        let Some(finding) = &mut self.finding else { return };
        let why = if was_wrong { Saying::NotRepeatedWrong } else { Saying::NotRepeatedLost };
        finding.causes.push(why.into());
        self.detail = finding.to_string();
    }

    /// The record of a step that was not reached before the run ended, at `at_ms`.
    #[must_use]
    pub fn skipped(seq: u32, step: &Step, at_ms: i64) -> Self {
        Self {
            seq,
            attempt: 1,
            name: step.name.clone(),
            kind: step.kind.name().to_owned(),
            outcome: StepOutcome::Skipped,
            cause: RunCause::None,
            exit_code: Exit::NothingJudged.code(),
            started_ms: at_ms,
            ended_ms: at_ms,
            detail: Saying::StepNotReached.to_string(),
            finding: Some(Saying::StepNotReached.into()),
            remedy: None,
            measurements: Vec::new(),
            suspects: Vec::new(),
            board: None,
            evidence: None,
        }
    }
}

/// The last try of each step, which is the one that counts.
pub(crate) fn last_tries(steps: &[StepRecord]) -> impl Iterator<Item = &StepRecord> {
    let is_later = |step: &StepRecord, than: &StepRecord| step.seq == than.seq && step.attempt > than.attempt;
    steps.iter().filter(move |step| !steps.iter().any(|other| is_later(other, step)))
}

/// The outcome of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, AsRefStr, Display)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum StepOutcome {
    /// As it should be.
    Passed,
    /// The board is wrong.
    Failed,
    /// It could not be judged.
    Error,
    /// It was not reached.
    Skipped,
}

/// Who or what caused a result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, AsRefStr, Display)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum RunCause {
    /// PASS.
    None,
    /// FAIL: the board.
    Board,
    /// The link to it.
    Link,
    /// The station, or this computer.
    Station,
    /// Whoever stopped the run, or scanned the label of another board.
    Operator,
    /// The program or the computer ended in the middle of it.
    Crash,
    /// The board is not one that this plan may judge, or a value that has a limit could not be measured.
    Refused,
}

impl RunCause {
    /// The cause of the judge's result; `code` is that of its finding or error.
    #[must_use]
    pub fn of(cause: Cause, code: &str) -> Self {
        match cause {
            Cause::Equal => Self::None,
            Cause::Different => Self::Board,
            Cause::Station if is_of_link(code) => Self::Link,
            Cause::Station | Cause::Busy | Cause::NothingJudged => Self::Station,
            Cause::Refused => Self::Refused,
            Cause::Stopped(StoppedBy::Person) => Self::Operator,
            Cause::Stopped(StoppedBy::System | StoppedBy::Disconnection | StoppedBy::Caller) => Self::Station,
        }
    }

    /// Whether a step that ended for this cause may be tried again if nothing else is against it; a FAIL never is.
    #[must_use]
    pub(crate) const fn is_retryable(self) -> bool {
        matches!(self, Self::Link | Self::Station)
    }
}

/// Whether an error of the judge with this code is one of the link.
fn is_of_link(code: &str) -> bool {
    const OF_LINK: [&str; 5] = ["BoardError", "LinkError", "SerialError", "TcpError", "UsbError"];
    let lists = codes::LISTS.into_iter().flatten().filter(|list| OF_LINK.contains(&list.error));
    lists.flat_map(|list| list.codes).any(|(known, _)| *known == code)
}

/// A board that identified itself.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct BoardSeen {
    /// `mock`, `sim`, `replay` or `hardware`.
    pub kind: String,
    /// Its name.
    pub name: String,
    /// The FPGA's own number, in hexadecimal; none where it has none.
    pub device: Option<String>,
    /// The commit of its build, in hexadecimal.
    pub build: String,
}

impl BoardSeen {
    /// Whether it is real hardware, and not a board that a program simulates or replays.
    #[must_use]
    pub(crate) fn is_hardware(&self) -> bool {
        self.kind == BoardKind::Hardware.to_string()
    }
}

/// What the store knows of a device together with the scanned serial number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DeviceSeen {
    /// Not checked: the board reports no number, or the plan asks for none.
    NotChecked,
    /// Neither was bound before.
    New,
    /// They are bound to each other.
    Known,
}

/// A suspected part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SuspectRecord {
    /// The kind of part.
    pub part: String,
    /// Where it is.
    pub place: String,
    /// The share of what is wrong that it explains, 0 to 1.
    pub explained: f64,
    /// What a technician should do with this board.
    pub technician: String,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_of_the_link_is_told_from_one_of_the_station() {
        assert_eq!(RunCause::of(Cause::Station, "no-answer"), RunCause::Link);
        assert_eq!(RunCause::of(Cause::Station, "link-closed"), RunCause::Link);
        assert_eq!(RunCause::of(Cause::Station, "golden-samples-wrong"), RunCause::Station);
        assert_eq!(RunCause::of(Cause::Stopped(StoppedBy::Person), "stopped-by-signal"), RunCause::Operator);
        assert_eq!(RunCause::of(Cause::Stopped(StoppedBy::Caller), "stopped-by-signal"), RunCause::Station);
        assert!(!RunCause::Board.is_retryable() && !RunCause::Refused.is_retryable());
    }
}
