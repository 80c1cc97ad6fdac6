//! The lane's own side: carries a job out and tells of it. It ends no process and prints nothing.

use std::sync::{Arc, OnceLock};

use halfrow::board::Stop;
use halfrow::target::Target;
use halfrow::verdict::StoppedBy;

use super::acts::{Common, Try};
use super::progress::Told;
use super::{Job, Message};
use crate::clock;
use crate::plan::{Act, Plan, Step};
use crate::record::{StepOutcome, StepRecord};

/// Who wants the job to end early, as soon as somebody does.
#[derive(Clone, Debug, Default)]
pub struct StopRequest(Arc<OnceLock<StoppedBy>>);

impl StopRequest {
    /// Somebody wants it to end. The first one counts.
    pub fn ask(&self, by: StoppedBy) {
        // Whoever asked before has been heard.
        let _ = self.0.set(by);
    }

    fn stop(&self) -> Stop {
        let asked = Arc::clone(&self.0);
        Stop::when(move || asked.get().copied())
    }
}

/// Carries the job out, step by step, and tells of it. A step that does not pass is the last one.
pub fn carry_out(job: &Job, request: &StopRequest, tell: &(dyn Fn(&Message) + Sync)) {
    match prepared(job) {
        Ok((plan, target)) => {
            steps(job, &plan, &target, request, tell);
            tell(&Message::Done);
        }
        Err(why) => tell(&Message::Refused { why }),
    }
}

/// The plan as the run began with it.
fn prepared(job: &Job) -> Result<(Plan, Target), String> {
    let plan = Plan::parse(&job.plan, job.text.clone());
    let plan = plan.map_err(|error| format!("{:#}", anyhow::Error::from(error)))?;
    if plan.sha256 != job.sha256 {
        return Err(
            "a file that the plan names was changed while the run began; test the board again".to_owned()
        );
    }
    let target = job.target.parse().map_err(|error: halfrow::target::TargetError| error.to_string())?;
    Ok((plan, target))
}

fn steps(job: &Job, plan: &Plan, target: &Target, request: &StopRequest, tell: &(dyn Fn(&Message) + Sync)) {
    let selected = plan.variant(&job.variant);
    let (stop, limits) = (request.stop(), selected.limits.as_slice());
    let mut common = Common { plan, target, seed: job.seed, stop: &stop, limits, first: None };
    for (step, seq) in selected.steps.iter().zip(1..) {
        let mut attempt = 1;
        let passed = loop {
            let name = step.name.clone();
            tell(&Message::Step { seq, attempt, name });
            let record = tried(step, (seq, attempt), &common, tell);
            if common.first.is_none() {
                common.first.clone_from(&record.board);
            }
            let passed = record.outcome == StepOutcome::Passed;
            let again = !passed && record.cause.may_pass_off() && attempt <= step.retries;
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

fn tried(
    step: &Step,
    (seq, attempt): (u32, u32),
    common: &Common<'_>,
    tell: &(dyn Fn(&Message) + Sync),
) -> StepRecord {
    let started_ms = clock::now_ms();
    let within = step.timeout;
    let came = match &step.act {
        Act::Identity => common.identity(within),
        Act::Link { each } => common.link(*each, within),
        Act::Verify(judging) => common.verify(judging, within, &Told::by(tell)),
    };
    let Try { outcome, cause, exit, detail, remedy, measurements, suspects, board, evidence } = came;
    StepRecord {
        seq,
        attempt,
        name: step.name.clone(),
        kind: step.act.name().to_owned(),
        outcome,
        cause,
        exit_code: exit.code(),
        started_ms,
        ended_ms: clock::now_ms(),
        detail,
        remedy,
        measurements,
        suspects,
        board,
        evidence,
    }
}
