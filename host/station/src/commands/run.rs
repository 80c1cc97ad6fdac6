//! `halfrow-station run`

use std::fs;
use std::path::{self, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use clap::Args;
use halfrow::Verdict;
use halfrow::target::Target;
use halfrow::verdict::StoppedBy;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::flag;

use super::Failure;
use crate::console;
use crate::exit::Exit;
use crate::lane::Message;
use crate::plan::Plan;
use crate::run::{self, Order, RunError, Saved};
use crate::store::{Folder, Store};

/// Judge one board by a plan, and save the result
///
/// The verdict is printed when it is on the disk and was read back. Exit codes: 0 PASS, 1 FAIL, 2 usage, 3 ERROR or a
/// result that could not be saved, 4 busy, 5 nothing judged, 6 identity or version refused, 129, 130 or 143
/// interrupted.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The station's folder, which is made if it is not there
    #[arg(long, value_name = "FOLDER", env = "HALFROW_STATION_DATA")]
    data: PathBuf,
    /// The plan
    #[arg(long, value_name = "FILE")]
    plan: PathBuf,
    /// The board's serial number
    #[arg(long)]
    serial: String,
    /// The board, as `halfrow boards` names it
    #[arg(long, value_name = "TARGET")]
    board: Target,
    /// The lane that the board is in
    #[arg(long, default_value = "1")]
    lane: String,
    /// Who tests
    #[arg(long, value_name = "NAME", env = "USER", default_value = "unknown")]
    operator: String,
    /// The station's name [default: this computer's]
    #[arg(long, value_name = "NAME", env = "HALFROW_STATION")]
    station: Option<String>,
    /// Kill the lane when it tells nothing for so long
    #[arg(long, value_name = "SECONDS", default_value = "60", value_parser = seconds)]
    silence: Duration,
}

fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().ok().filter(|seconds| (0.1..=86_400.0).contains(seconds));
    seconds.map(Duration::from_secs_f64).ok_or_else(|| "give a number of seconds, 0.1 to 86400".to_owned())
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let plan_file = path::absolute(&arguments.plan).map_err(Failure::call)?;
    let plan = Plan::load(&plan_file).map_err(Failure::call)?;
    plan.select(&arguments.serial).map_err(Failure::call)?;
    let program = std::env::current_exe().map_err(Failure::error)?;
    let signal = signals().map_err(Failure::error)?;
    let mut store = Store::open(&Folder::new(&arguments.data))?;
    for Saved { record, .. } in run::recover(&mut store)? {
        let (id, serial) = (&record.run.id, &record.run.serial);
        console::error(&format_args!("the run {id} of {serial} was found open, and is ERROR; test it again"));
    }
    let station = arguments.station.clone().unwrap_or_else(this_computer);
    let order = Order {
        plan: &plan,
        plan_file: &plan_file,
        serial: &arguments.serial,
        target: &arguments.board,
        station: &station,
        lane: &arguments.lane,
        operator: &arguments.operator,
        program: &program,
        silence: arguments.silence,
    };
    let stop = move || stopped_by(signal.load(Ordering::Relaxed));
    let ended = run::run(&mut store, &order, &stop, &mut tell);
    if let Err(RunError::Unsaved { .. }) = &ended {
        console::tell(&format!("UNSAVED {}: keep this board apart; it has no verdict", arguments.serial));
    }
    let saved = ended?;
    console::tell(&text(&saved));
    Ok(exit(&saved))
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Serial(error) => Self::call(error),
            error => Self::error(error),
        }
    }
}

/// What the lane tells, for those who want to know.
fn tell(message: &Message) {
    match message {
        Message::Step { seq, attempt, name } => tracing::info!("step {seq}, {name}, try {attempt}"),
        Message::Doing { what } => tracing::info!("{what}"),
        Message::Ended { step } => tracing::info!("{} {}: {}", step.name, step.outcome.name(), step.detail),
        Message::Rows { .. } | Message::Done | Message::Refused { .. } => {}
    }
}

fn text(saved: &Saved) -> String {
    let Saved { record, stored } = saved;
    let ended = &record.conclusion;
    let mut lines = vec![format!("{} {}: {}", ended.verdict, record.run.serial, ended.headline)];
    lines.extend(ended.remedy.iter().filter(|_| ended.verdict != Verdict::Pass).cloned());
    if let Some(identity) = record.steps.first().filter(|step| step.kind == "identity") {
        lines.push(format!("board     {}", identity.detail));
    }
    if record.marginal {
        lines.push("marginal  a step needed more than one try".to_owned());
    }
    if !record.production {
        lines.push("this plan takes any kind of board, so the run counts as no production".to_owned());
    }
    lines.push(format!("run       {}, the unit's judgement {}", record.run.id, stored.nth));
    lines.push(format!("record    {}", stored.record_sha256));
    lines.join("\n")
}

/// The exit code of what was read back.
fn exit(saved: &Saved) -> Exit {
    let all = [
        Exit::Pass,
        Exit::Fail,
        Exit::Busy,
        Exit::NothingJudged,
        Exit::Refused,
        Exit::HungUp,
        Exit::Interrupted,
        Exit::Terminated,
    ];
    all.into_iter().find(|exit| exit.code() == saved.stored.exit_code).unwrap_or(Exit::Error)
}

/// Holds the exit code of the last signal, and 0 before.
fn signals() -> std::io::Result<Arc<AtomicUsize>> {
    let last = Arc::new(AtomicUsize::new(0));
    for (signal, exit) in [(SIGINT, Exit::Interrupted), (SIGTERM, Exit::Terminated), (SIGHUP, Exit::HungUp)] {
        flag::register_usize(signal, Arc::clone(&last), exit.code().into())?;
    }
    Ok(last)
}

fn stopped_by(code: usize) -> Option<StoppedBy> {
    let by = [StoppedBy::Person, StoppedBy::System, StoppedBy::Disconnection];
    by.into_iter().find(|&by| usize::from(Exit::from(halfrow::Cause::Stopped(by)).code()) == code)
}

/// This computer's name.
fn this_computer() -> String {
    let name = fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
    let name = name.trim();
    if name.is_empty() { "station".to_owned() } else { name.to_owned() }
}
