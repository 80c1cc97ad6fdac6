//! A run of `verify`: from the plan to the report.
//!
//! The steps stand in `steps` in their order; each adds its check to the findings or ends the run.

mod after;
mod conclude;
mod findings;
mod golden;
mod judge;
mod legal;
mod lost_row;
mod patterns;
mod pauses;
mod plan;
mod prepared;
mod reconnect;
mod second_look;
mod steps;
mod streaming;
mod upload;

use crate::board::{OpenOptions, Stop};
use crate::link::{Candidate, Link};
use crate::progress::Progress;
use crate::result::{Evidence, FileHash, Report};

use findings::{End, Findings};
use reconnect::WayBack;
use steps::{MAX_LATENCY, Run};

pub use golden::{CannotJudge, GoldenError, judge_the_judge};
pub use plan::{
    DECOY, FrameSource, Generation, JUDGED, MOST_FRAMES, Plan, SENSOR_BLANKING, ScheduledFrame, Segment,
    Timing, TooManyFrames,
};
pub(crate) use prepared::PrepareError;
pub use steps::{Misfit, misfit};

/// What the report says of the run beside its findings.
#[derive(Clone, Debug, Default)]
pub struct Circumstances {
    /// The command line.
    pub arguments: Vec<String>,
    /// Files that were read.
    pub files: Vec<FileHash>,
    /// Numbers drawn for this run; a replay has those of the recorded one.
    pub draws: Draws,
}

/// Numbers that a run draws at random.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Draws {
    /// The session's nonce.
    pub nonce: u32,
    /// This host.
    pub host: u32,
}

impl Draws {
    /// Draws them from the operating system's randomness.
    #[must_use]
    pub fn draw() -> Self {
        use std::hash::{BuildHasher, RandomState};
        // A hasher's keys come from the operating system.
        let drawn = RandomState::new().hash_one(std::process::id());
        Self { nonce: drawn as u32, host: (drawn >> 32) as u32 }
    }
}

/// A run that is over.
pub struct Finished {
    /// What it found.
    pub report: Report,
    /// Frames for pictures.
    pub evidence: Vec<Evidence>,
}

/// Judges a board by `plan`.
#[must_use]
pub fn verify(
    plan: &Plan,
    candidate: Candidate,
    circumstances: &Circumstances,
    stop: &Stop,
    progress: &dyn Progress,
) -> Finished {
    let started = jiff::Timestamp::now();
    let mut findings = Findings::new(plan, &candidate);
    let Draws { nonce, host } = circumstances.draws;
    let options = OpenOptions {
        nonce,
        host,
        take_over: plan.take_over,
        polite: false,
        retry_limit: plan.retry_limit,
        stop: stop.clone(),
    };
    let way_back = WayBack { target: candidate.target, patience: plan.reconnect, options };
    let end = run(plan, candidate.link, &way_back, progress, &mut findings).err();
    progress.done();
    conclude::conclude(plan, findings, end, circumstances, started)
}

fn run(
    plan: &Plan,
    link: Box<dyn Link>,
    way_back: &WayBack,
    progress: &dyn Progress,
    findings: &mut Findings,
) -> Result<(), End> {
    progress.step("judging the judge");
    steps::judge_the_judge(findings)?;
    progress.step("opening the board");
    let mut board = way_back.open(link, findings)?;
    tracing::info!("session {} with {}", board.welcome.session, board.capabilities.name);
    let generations = plan.generations(board.capabilities.taps);
    let end = Run { plan, board: &mut board, generations, way_back, progress, findings }.all_steps();
    findings.note_link(&board);
    // Whatever happened, the next run must find the board free; a board that is gone need not be asked again.
    let reachable = !matches!(&end, Err(end) if end.is_unreachable());
    if reachable && let Err(error) = board.close() {
        tracing::debug!("the session was not closed: {error}");
    }
    end
}
