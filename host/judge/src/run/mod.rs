//! A run of `verify`: from the plan to the report.
//!
//! `steps` has the order. Each step adds its check to the findings or ends the run. Where each check is made:
//!
//! | check | in |
//! |---|---|
//! | `judge` | `golden` |
//! | `identity` | `steps`, `plan::misfit` |
//! | `link` | `steps`, with the bytes of `plan::patterns` |
//! | `upload`, `read-back` | `frames::upload` |
//! | `frames`, `latency` | prepared in `frames::prepared`, streamed in `streaming`, row by row in `row_judge`, judged in `what_came`; `lost_row` if a row does not come |
//! | `tables-after` | `frames::what_came` |
//! | `counters` | `frames::counters` |
//! | `at-speed` | `at_speed` |
//! | `rules` | `rules` |
//!
//! In addition: `plan` has what a run does, in what parts and at what price, and keeps it `within` a time; `sessions` waits for a
//! board that goes away, and does everything once more in a `second_look`; `findings` has the checks, what was `exercised`, and
//! why a run ended, of which `conclude` makes the report.

mod at_speed;
mod drawn;
mod findings;
mod frames;
mod golden;
mod options;
mod plan;
mod recorded;
mod rules;
mod sessions;
mod steps;
mod threads;

use tracing::error_span;

use crate::link::{Candidate, kinds};
use crate::progress::Progress;
use crate::result::{CheckName, FileHash, Problem};
use crate::target::Target;
use crate::verdict::Cause;

use findings::conclude::{self, Begun};
use findings::{End, Findings};
use frames::observations::Observations;
use plan::misfit::check_frames;
use sessions::Sessions;
pub(crate) use steps::NotAllJudged;

pub use crate::board::SessionIds;
pub(crate) use at_speed::FEW_AT_SPEED;
pub use findings::finished::{Finished, Lack, RECORDING_LOST, REPORT_LOST};
pub(crate) use frames::prepared::PrepareError;
pub(crate) use golden::{CannotJudge, GoldenError};
pub use options::RunOptions;
pub use plan::misfit::{Misfit, check_fit};
pub use plan::parts::{Part, Selection};
pub use plan::prices::{Prices, Rates, usual_capabilities};
pub use plan::variations::{Build, Vary};
pub use plan::within::WithinError;
pub use plan::{
    AtSpeed, DECOY, FrameSource, JUDGED, MOST_FRAMES, Plan, PlanLengthError, ScheduledFrame, Segment, Timing,
};
pub use recorded::{RecordedRun, RestoreError};
pub(crate) use threads::NoThread;

/// What the report says about the run besides its findings. The default draws its numbers.
#[derive(Clone, Debug, Default)]
pub struct Provenance {
    /// The command line.
    pub arguments: Vec<String>,
    /// Files that were read.
    pub files: Vec<FileHash>,
    /// Numbers drawn for this run; a replay has those of the recorded one.
    pub session_ids: SessionIds,
    /// Who tests, if a name is given.
    pub operator: Option<String>,
}

/// Judges the board of `candidate` by `plan`, and reports to `progress` what it does. Log lines of the run carry the target, so
/// that those of two runs on two threads can be told apart.
///
/// # Errors
/// [`Misfit`] when the plan has no frames or too many, a frame cannot be made or does not fit its tables, or the board cannot take
/// what it uploads: then there is no verdict and no report. Whatever else goes wrong is in the report.
pub fn verify(
    plan: &Plan,
    candidate: Candidate,
    options: &RunOptions,
    progress: &dyn Progress,
) -> Result<Finished, Misfit> {
    let span = error_span!("run", board = %candidate.target);
    span.in_scope(|| run_to_report(plan, candidate, options, progress))
}

/// The report of a run by `plan` that never began, for instance because the board of `target` cannot be opened. `problem` says
/// why, and `cause` is its class.
#[must_use]
pub fn not_begun(
    plan: &Plan,
    target: &Target,
    cause: Cause,
    problem: Problem,
    options: &RunOptions,
) -> Finished {
    let name = target.to_string();
    let findings = Findings::new(name.clone(), kinds::board_of(target));
    let link = Sessions::new(options, name, None).report();
    let end = End::error(CheckName::Identity, cause, problem);
    conclude::conclude(plan, findings, Observations::default(), link, Err(end), options, Begun::now())
}

fn run_to_report(
    plan: &Plan,
    candidate: Candidate,
    options: &RunOptions,
    progress: &dyn Progress,
) -> Result<Finished, Misfit> {
    check_frames(plan)?;
    let begun = Begun::now();
    let Candidate { target, kind, link, reopen } = candidate;
    let mut findings = Findings::new(target, kind);
    let mut sessions = Sessions::new(options, link.name(), reopen);
    let mut seen = Observations::default();
    let ended = steps::carry_out(plan, link, options, &mut sessions, progress, &mut findings, &mut seen);
    progress.done();
    match findings.misfit.take() {
        Some(misfit) => Err(misfit),
        None => Ok(conclude::conclude(plan, findings, seen, sessions.report(), ended, options, begun)),
    }
}
