//! From the steps to the verdict.

use halfrow::Verdict;
use serde::{Deserialize, Serialize};

use super::step::{Measured, RunCause, StepOutcome, StepRecord};
use crate::exit::Exit;

/// What a run came to.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Conclusion {
    /// The verdict. It has no default.
    pub verdict: Verdict,
    /// Why.
    pub cause: RunCause,
    /// The exit code.
    pub exit_code: u8,
    /// It in one sentence.
    pub headline: String,
    /// What to do next.
    pub remedy: Option<String>,
}

impl Conclusion {
    /// Of a plan of `planned` steps: the worst that the last try of a step came to, an ERROR being worse than a FAIL; PASS only
    /// if every step passed. `lane` says why there are no more steps, if the lane did not come to the plan's end by itself.
    #[must_use]
    pub fn of(planned: u32, steps: &[StepRecord], run: &[Measured], lane: Option<Self>) -> Self {
        let is_last = |step: &StepRecord| {
            !steps.iter().any(|other| other.seq == step.seq && other.attempt > step.attempt)
        };
        let ended = steps.iter().filter(|step| is_last(step));
        let by_step = ended.filter_map(Self::by_step);
        let by_run = run.iter().filter_map(Self::by_measurement);
        let missing = || {
            let passed = steps.iter().filter(|step| step.outcome == StepOutcome::Passed).count();
            let why = || format!("{passed} of {planned} steps passed, and of the others nothing is known");
            (passed < planned as usize).then(|| Self::error(RunCause::Station, why()))
        };
        let mut worst: Vec<_> = by_step.chain(by_run).chain(lane).collect();
        // Of two that are as bad the first came first.
        worst.sort_by_key(|conclusion| conclusion.verdict != Verdict::Error);
        let worst = worst.into_iter().next().or_else(missing);
        worst.unwrap_or_else(|| Self {
            verdict: Verdict::Pass,
            cause: RunCause::None,
            exit_code: Exit::Pass.code(),
            headline: steps.last().map_or_else(String::new, |step| step.detail.clone()),
            remedy: None,
        })
    }

    /// An ERROR of this cause.
    #[must_use]
    pub fn error(cause: RunCause, headline: impl Into<String>) -> Self {
        let exit = if cause == RunCause::Refused { Exit::Refused } else { Exit::Error };
        let remedy = Some("Test the board again.".to_owned());
        Self { verdict: Verdict::Error, cause, exit_code: exit.code(), headline: headline.into(), remedy }
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
        })
    }

    fn by_measurement(measured: &Measured) -> Option<Self> {
        let cause = measured.fault()?;
        let headline = measured.sentence();
        Some(match cause {
            RunCause::Board => {
                let (verdict, exit_code) = (Verdict::Fail, Exit::Fail.code());
                Self { verdict, cause, exit_code, headline, remedy: None }
            }
            cause => Self::error(cause, headline),
        })
    }
}
