//! From the steps to the verdict.

use halfrow::Verdict;
use halfrow::verdict::{Cause, StoppedBy};
use serde::{Deserialize, Serialize};

use super::IDENTITY_NOT_CHECKED;
use super::measured::Measured;
use super::step::{DeviceSeen, RunCause, StepOutcome, StepRecord, last_tries};
use crate::exit::Exit;
use crate::said::{Said, Saying};

/// The codes of a run that ended because somebody wanted it to.
const STOPPED: [&str; 2] = ["stopped-by-signal", "run-stopped-before"];

/// The codes of limits that were missed, or of which nothing was measured.
const LIMITS: [&str; 2] = ["measurement-beyond-limit", "measurement-missing"];

/// The remedy for an ERROR about which nothing else is known.
pub(crate) const TEST_AGAIN: &str = "Test the board again.";

/// The result of a run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Conclusion {
    /// The verdict. It has no default.
    pub verdict: Verdict,
    /// Why.
    pub cause: RunCause,
    /// The exit code.
    pub exit_code: u8,
    /// The result in one sentence.
    pub headline: String,
    /// What to do next.
    pub remedy: Option<String>,
    /// The headline with its code.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub finding: Option<Said>,
}

impl Conclusion {
    /// Whether somebody else ended the run or had its board, which says nothing of what it was to judge.
    pub(crate) fn is_from_outside(&self) -> bool {
        self.is_busy()
            || matches!(Exit::of(self.exit_code), Some(Exit::HungUp | Exit::Interrupted | Exit::Terminated))
    }

    /// Whether somebody else had the board.
    pub(crate) fn is_busy(&self) -> bool {
        Exit::of(self.exit_code) == Some(Exit::Busy)
    }

    /// The conclusion of a run whose plan has `planned` steps: the worst result of any step's last try or of any
    /// measurement in `run`, where ERROR is worse than FAIL; PASS only if every step passed. `lane` says why steps are
    /// missing, if the lane did not reach the end of the plan by itself.
    #[must_use]
    pub fn of(planned: u32, steps: &[StepRecord], run: &[Measured], lane: Option<Self>) -> Self {
        let by_step = last_tries(steps).filter_map(Self::by_step);
        let by_run = run.iter().filter_map(Self::by_measurement);
        let missing = || {
            let passed = steps.iter().filter(|step| step.outcome == StepOutcome::Passed).count();
            let why = || Saying::StepsUnknown { passed, planned };
            (passed < planned as usize).then(|| Self::error(RunCause::Station, why()))
        };
        let mut worst: Vec<_> = by_step.chain(by_run).chain(lane).collect();
        // The sort is stable: of two equally bad ones the first counts.
        worst.sort_by_key(|conclusion| conclusion.verdict != Verdict::Error);
        let worst = worst.into_iter().next().or_else(missing);
        worst.unwrap_or_else(|| Self {
            verdict: Verdict::Pass,
            cause: RunCause::None,
            exit_code: RunCause::None.exit().code(),
            headline: telling(steps).map_or_else(String::new, |step| step.detail.clone()),
            remedy: None,
            finding: telling(steps).and_then(|step| step.finding.clone()),
        })
    }

    /// Whether the findings of the steps are not believed, because a limit says that the station is wrong.
    #[must_use]
    pub(crate) fn disbelieves_steps(&self) -> bool {
        let is_limit = |said: &Said| LIMITS.contains(&said.code.as_str());
        self.verdict == Verdict::Error && self.finding.as_ref().is_some_and(is_limit)
    }

    /// Adds [`IDENTITY_NOT_CHECKED`] to a PASS if it could not be checked whether the board has the scanned serial number.
    #[must_use]
    pub(crate) fn note_unchecked_identity(self, device: DeviceSeen) -> Self {
        if self.verdict == Verdict::Pass && device == DeviceSeen::NotChecked {
            return Self { headline: format!("{}; {IDENTITY_NOT_CHECKED}", self.headline), ..self };
        }
        self
    }

    /// Gives `why` as the reason of a run that the station stopped, with the station as the cause instead of the operator.
    #[must_use]
    pub(crate) fn stopped_since(self, why: Option<Said>) -> Self {
        let is_stopped = self.finding.as_ref().is_some_and(|said| STOPPED.contains(&said.code.as_str()));
        match why.filter(|_| is_stopped) {
            Some(why) => Self::error(RunCause::Station, why),
            None => self,
        }
    }

    /// An ERROR of this cause, which is one and is not the board.
    #[must_use]
    pub fn error(cause: RunCause, why: impl Into<Said>) -> Self {
        debug_assert!(!matches!(cause, RunCause::None | RunCause::Board));
        let why = why.into();
        let remedy = Some(TEST_AGAIN.to_owned());
        let (verdict, exit_code, headline) = (Verdict::Error, cause.exit().code(), why.to_string());
        Self { verdict, cause, exit_code, headline, remedy, finding: Some(why) }
    }

    /// An ERROR because somebody stopped the run before the board was touched.
    #[must_use]
    pub fn stopped(by: StoppedBy) -> Self {
        let (why, cause) = (Said::from(Saying::StoppedBefore), Cause::Stopped(by));
        let exit_code = Exit::from(cause).code();
        Self { exit_code, ..Self::error(RunCause::of(cause, &why.code), why) }
    }

    fn by_step(step: &StepRecord) -> Option<Self> {
        let verdict = match step.outcome {
            StepOutcome::Passed | StepOutcome::Skipped => return None,
            StepOutcome::Failed => Verdict::Fail,
            StepOutcome::Error => Verdict::Error,
        };
        Some(Self {
            verdict,
            cause: step.cause,
            exit_code: step.exit_code,
            headline: step.detail.clone(),
            remedy: step.remedy.clone(),
            finding: step.finding.clone(),
        })
    }

    fn by_measurement(measured: &Measured) -> Option<Self> {
        let cause = measured.fault()?;
        let (headline, finding) = (measured.sentence(), measured.said());
        Some(match cause {
            RunCause::Board => {
                let (verdict, exit_code) = (Verdict::Fail, cause.exit().code());
                Self { verdict, cause, exit_code, headline, remedy: None, finding: Some(finding) }
            }
            cause => {
                let remedy = finding.remedy().map(str::to_owned);
                Self { remedy, ..Self::error(cause, finding) }
            }
        })
    }
}

/// The step that says what a PASS saw: the last that judged, or else the last that read the identity, whatever followed it.
fn telling(steps: &[StepRecord]) -> Option<&StepRecord> {
    let passed = steps.iter().filter(|step| step.outcome == StepOutcome::Passed);
    passed.max_by_key(|step| ["identity", "verify"].iter().position(|kind| *kind == step.kind))
}

impl RunCause {
    /// The exit code of a result that it caused, unless the judge or who stopped the run gives one.
    pub(crate) const fn exit(self) -> Exit {
        match self {
            Self::None => Exit::Pass,
            Self::Board => Exit::Fail,
            Self::Refused => Exit::Refused,
            Self::Link | Self::Station | Self::Operator | Self::Crash => Exit::Error,
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A step whose second try passed, one that failed, and one that was skipped.
    pub(crate) fn steps() -> Vec<StepRecord> {
        vec![
            step(1, 1, StepOutcome::Error, RunCause::Link),
            step(1, 2, StepOutcome::Passed, RunCause::None),
            step(2, 1, StepOutcome::Failed, RunCause::Board),
            step(3, 1, StepOutcome::Skipped, RunCause::None),
        ]
    }

    pub(crate) fn step(seq: u32, attempt: u32, outcome: StepOutcome, cause: RunCause) -> StepRecord {
        StepRecord {
            seq,
            attempt,
            name: format!("step {seq}"),
            kind: "verify".to_owned(),
            outcome,
            cause,
            exit_code: seq as u8,
            started_ms: 1,
            ended_ms: 2,
            detail: format!("step {seq}, try {attempt}"),
            finding: None,
            remedy: None,
            measurements: Vec::new(),
            suspects: Vec::new(),
            board: None,
            evidence: None,
        }
    }

    fn of(planned: u32, steps: &[StepRecord], lane: Option<Conclusion>) -> (Verdict, RunCause) {
        let conclusion = Conclusion::of(planned, steps, &[], lane);
        (conclusion.verdict, conclusion.cause)
    }

    #[test]
    fn a_pass_needs_every_step_of_the_plan() {
        let passed = |seq| step(seq, 1, StepOutcome::Passed, RunCause::None);
        assert_eq!(of(2, &[passed(1), passed(2)], None), (Verdict::Pass, RunCause::None));
        assert_eq!(of(3, &[passed(1), passed(2)], None), (Verdict::Error, RunCause::Station));
        assert_eq!(of(1, &[], None), (Verdict::Error, RunCause::Station));
        let skipped = step(2, 1, StepOutcome::Skipped, RunCause::None);
        assert_eq!(of(2, &[passed(1), skipped], None), (Verdict::Error, RunCause::Station));
        let died = Conclusion::error(RunCause::Crash, Saying::LaneEndless);
        assert_eq!(of(2, &[passed(1), passed(2)], Some(died)), (Verdict::Error, RunCause::Crash));
    }

    /// Only the judging says how much was judged, and that a board is no hardware.
    #[test]
    fn a_pass_says_what_the_last_step_saw_that_judged_or_else_read_the_identity() {
        let said = |kinds: &[&str]| {
            let passed = |(seq, kind): (u32, &&str)| StepRecord {
                kind: (*kind).to_owned(),
                finding: Some(Said::uncoded(found(seq))),
                ..step(seq, 1, StepOutcome::Passed, RunCause::None)
            };
            let steps: Vec<_> = (1..).zip(kinds).map(passed).collect();
            let Conclusion { headline, finding, .. } = Conclusion::of(kinds.len() as u32, &steps, &[], None);
            (headline, finding.unwrap().message)
        };
        for (kinds, seq) in [
            (&["identity", "verify", "link"][..], 2),
            (&["verify", "verify", "identity"], 2),
            (&["link", "identity", "link"], 2),
            (&["link", "link"], 2),
        ] {
            assert_eq!(said(kinds), (format!("step {seq}, try 1"), found(seq)), "{kinds:?}");
        }
    }

    fn found(seq: u32) -> String {
        format!("found by step {seq}")
    }

    #[test]
    fn the_last_try_of_a_step_counts_and_an_error_is_worse_than_a_fail() {
        let error = |attempt| step(1, attempt, StepOutcome::Error, RunCause::Link);
        let passed = step(1, 2, StepOutcome::Passed, RunCause::None);
        assert_eq!(of(1, &[error(1), passed], None), (Verdict::Pass, RunCause::None));
        assert_eq!(of(1, &[error(1), error(2)], None), (Verdict::Error, RunCause::Link));
        let failed = step(1, 1, StepOutcome::Failed, RunCause::Board);
        assert_eq!(of(1, std::slice::from_ref(&failed), None), (Verdict::Fail, RunCause::Board));
        let later = step(2, 1, StepOutcome::Error, RunCause::Station);
        assert_eq!(of(2, &[failed.clone(), later], None), (Verdict::Error, RunCause::Station));
        let hung = Conclusion::error(RunCause::Crash, Saying::LaneEndless);
        assert_eq!(of(1, &[failed], Some(hung)), (Verdict::Error, RunCause::Crash));
    }

    #[test]
    fn a_run_that_was_stopped_gives_the_reason_and_no_other_does() {
        let said = |code: &str| Said { code: code.to_owned(), ..Said::from(Saying::PlanChanged) };
        let since = |code| {
            let stopped = Conclusion { exit_code: 130, ..Conclusion::error(RunCause::Operator, said(code)) };
            stopped.stopped_since(Some(said("shared-board-taken")))
        };
        for code in STOPPED {
            let came = Conclusion::error(RunCause::Station, said("shared-board-taken"));
            assert_eq!((since(code), came.exit_code), (came, 3));
        }
        assert_eq!(since("lane-died").finding, Some(said("lane-died")));
        let stopped = Conclusion::stopped(StoppedBy::Person);
        assert_eq!(stopped.clone().stopped_since(None), stopped);
    }

    #[test]
    fn a_limit_on_the_whole_run_counts_like_one_on_a_step() {
        use crate::plan::limits::{Blame, Limit, Maker, Measurement};
        use crate::record::judged;
        let measurement = Measurement::named("run.seconds").unwrap();
        let passed = step(1, 1, StepOutcome::Passed, RunCause::None);
        let came = |blames| {
            let limit = Limit { measurement, least: None, most: Some(60.0), blames };
            let run = judged(Maker::Run, &[("run.seconds", Some(61.0))], &[limit]);
            Conclusion::of(1, std::slice::from_ref(&passed), &run, None).verdict
        };
        let verdicts = [Blame::Board, Blame::Station, Blame::Nobody].map(came);
        assert_eq!(verdicts, [Verdict::Fail, Verdict::Error, Verdict::Pass]);
    }
}
