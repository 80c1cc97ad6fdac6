//! The lane's own side: carries a job out and reports on it. It ends no process and prints nothing.

use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, OnceLock};
use std::time::Duration;

use halfrow::board::Stop;
use halfrow::target::Target;
use halfrow::verdict::StoppedBy;

use super::acts::{RunContext, Try};
use super::progress::ProgressMessages;
use super::{Control, LaneJob, Message, Ruling};
use crate::clock;
use crate::plan::{Plan, Step, StepKind};
use crate::record::{BoardSeen, StepOutcome, StepRecord};
use crate::said::{Said, Saying};

/// How often a lane that waits for the station checks whether it is to end.
const LOOK: Duration = Duration::from_millis(50);

/// Passes on what the station says while the job is under way.
#[derive(Clone, Debug)]
pub struct Orders {
    stop: Arc<OnceLock<StoppedBy>>,
    rulings: Sender<Ruling>,
}

/// What the station has said.
#[derive(Debug)]
pub struct Heeded {
    stop: Arc<OnceLock<StoppedBy>>,
    rulings: Receiver<Ruling>,
}

/// The two ends of the connection from whoever reads what the station says to the job.
#[must_use]
pub fn orders() -> (Orders, Heeded) {
    let (stop, (sender, rulings)) = (Arc::default(), mpsc::channel());
    (Orders { stop: Arc::clone(&stop), rulings: sender }, Heeded { stop, rulings })
}

impl Orders {
    /// Takes `control`, which the station has said.
    pub fn take(&self, control: Control) {
        match control {
            // Only the first one counts.
            Control::Stop(by) => drop(self.stop.set(by)),
            // A job that is over waits for no ruling.
            Control::Device(ruling) => drop(self.rulings.send(ruling)),
        }
    }
}

impl Heeded {
    fn stop(&self) -> Stop {
        let asked = Arc::clone(&self.stop);
        Stop::when(move || asked.get().copied())
    }

    /// The next ruling, or who wants the job to end, if that comes first.
    fn ruling(&self) -> Result<Ruling, StoppedBy> {
        loop {
            match self.rulings.recv_timeout(LOOK) {
                Ok(ruling) => return Ok(ruling),
                Err(RecvTimeoutError::Disconnected) => return Err(StoppedBy::System),
                Err(RecvTimeoutError::Timeout) => {}
            }
            if let Some(by) = self.stop.get() {
                return Err(*by);
            }
        }
    }
}

/// Carries the job out, step by step, and reports on it. A step that does not pass is the last one.
pub fn carry_out(job: &LaneJob, heeded: &Heeded, tell: &(dyn Fn(&Message) + Sync)) {
    tell(&Message::Begun { program: halfrow::VERSION.to_owned() });
    match prepared(job) {
        Ok((plan, target)) => {
            steps(job, &plan, &target, heeded, tell);
            tell(&Message::Done);
        }
        Err(why) => tell(&Message::Refused { why }),
    }
}

/// The plan, which must be the one with which the run began, and the board's target.
fn prepared(job: &LaneJob) -> Result<(Plan, Target), Said> {
    let plan = Plan::parse(&job.plan, job.text.clone());
    let plan = plan.map_err(|error| Said::of(&error))?;
    if plan.sha256 != job.sha256 {
        return Err(Saying::PlanChanged.into());
    }
    let target = job.target.parse().map_err(|error: halfrow::target::TargetError| Said::of(&error))?;
    Ok((plan, target))
}

fn steps(job: &LaneJob, plan: &Plan, target: &Target, heeded: &Heeded, tell: &(dyn Fn(&Message) + Sync)) {
    let selected = plan.variant(&job.variant);
    let (stop, is_mock) = (heeded.stop(), job.is_mock);
    let limits = if is_mock { &[] } else { selected.limits.as_slice() };
    let rule = |board: &BoardSeen| {
        tell(&Message::Identified { board: board.clone() });
        heeded.ruling()
    };
    let (seed, spool, first) = (job.seed, job.spool.as_path(), None);
    let mut context =
        RunContext { plan, target, is_mock, seed, stop: &stop, rule: &rule, limits, spool, first };
    for (step, seq) in selected.steps.iter().zip(1..) {
        let mut attempt = 1;
        let passed = loop {
            let name = step.name.clone();
            tell(&Message::Step { seq, attempt, name });
            let (mut record, is_incriminating) = tried(step, (seq, attempt), &context, tell);
            if context.first.is_none() {
                context.first.clone_from(&record.board);
            }
            let passed = record.outcome == StepOutcome::Passed;
            let may_repeat = !is_incriminating && may_repeat(step, &record, context.first.as_ref());
            let is_left = !passed && heeded.stop.get().is_none() && attempt <= step.retries;
            let again = is_left && may_repeat;
            if is_left && !may_repeat && record.cause.is_retryable() {
                record.not_repeated(is_incriminating);
            }
            tell(&Message::Ended { step: Box::new(record) });
            if !again {
                break passed;
            }
            attempt += 1;
        };
        if !passed {
            break;
        }
    }
}

/// Whether a step that came to this on the board that the run began with may be tried again without a person.
fn may_repeat(step: &Step, record: &StepRecord, first: Option<&BoardSeen>) -> bool {
    let is_lost = record.finding.as_ref().is_some_and(Said::is_of_lost_session);
    // A board is exchanged by being unplugged.
    let is_gone = record.finding.as_ref().is_some_and(Said::is_of_absent_board);
    // Only its own number proves that the board which comes back is the same one.
    let proves_itself = || first.is_some_and(|board| board.device.is_some());
    // A board that resets while it is judged may be at fault.
    let was_reset = is_lost && matches!(step.kind, StepKind::Verify(_));
    record.cause.is_retryable() && !was_reset && (!(is_lost || is_gone) || proves_itself())
}

/// The record of a try, and whether it holds anything against the board.
fn tried(
    step: &Step,
    (seq, attempt): (u32, u32),
    context: &RunContext<'_>,
    tell: &(dyn Fn(&Message) + Sync),
) -> (StepRecord, bool) {
    let started_ms = clock::now_ms();
    let within = step.timeout;
    let came = match &step.kind {
        StepKind::Identity => context.identity(within),
        StepKind::Link { each } => context.link(*each, within),
        StepKind::Verify(judging) => {
            context.verify(judging, (within, (seq, attempt)), &ProgressMessages::by(tell))
        }
    };
    let Try {
        outcome,
        cause,
        exit,
        finding,
        remedy,
        measurements,
        suspects,
        board,
        evidence,
        is_incriminating,
    } = came;
    let record = StepRecord {
        seq,
        attempt,
        name: step.name.clone(),
        kind: step.kind.name().to_owned(),
        outcome,
        cause,
        exit_code: exit.code(),
        started_ms,
        ended_ms: clock::now_ms(),
        detail: finding.to_string(),
        finding: Some(finding),
        remedy,
        measurements,
        suspects,
        board,
        evidence,
    };
    (record, is_incriminating)
}
