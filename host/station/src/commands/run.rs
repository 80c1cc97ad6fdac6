//! `halfrow-station run`

use std::fs;
use std::path::{self, Path, PathBuf};
use std::time::Duration;

use clap::Args;
use halfrow::Verdict;
use halfrow::link;
use halfrow::report::wording::says;
use halfrow::target::Target;
use halfrow::verdict::StoppedBy;
use halfrow::words::plain_lines;
use halfrow_program::number::seconds;
use serde_json::json;

use super::beginning::{Disk, Signal, may_have, recovered};
use super::why;
use super::{Failure, document};
use crate::clock;
use crate::console;
use crate::exit::Exit;
use crate::labgrid::LaneBoard;
use crate::lane::supervisor::OWN_PROGRAM;
use crate::lane::{MEMORIES_MIB, MEMORY_MIB, Message};
use crate::plan::{Bad, Plan, mock};
use crate::record::{Record, StepOutcome, in_one_line};
use crate::run::{self, Order, RunError, Saved, Stage, Watch};
use crate::settings::{LANE_NAME, is_lane_name};
use crate::store::{AgainError, Folder, InLane, SharedStore};

/// clap's own says nothing of `--mock`, which stands for two options.
const USAGE: &str =
    "halfrow-station run [OPTIONS] --data <FOLDER> --plan <FILE> <--serial <SERIAL> --board <TARGET>|--mock>";

/// Judge one board by a plan, and save the result
///
/// The verdict is printed when it is on the disk and was read back. Exit codes: 0 PASS, 1 FAIL, 2 usage, 3 ERROR or a
/// result that could not be saved, 4 busy, 5 nothing judged, 6 identity or version refused, 129, 130 or 143
/// interrupted.
#[derive(Debug, Args)]
#[command(override_usage = USAGE)]
pub(super) struct Arguments {
    /// The station's folder, which is made if it is not there
    #[arg(long, value_name = "FOLDER", env = "HALFROW_STATION_DATA")]
    data: PathBuf,
    /// The plan
    #[arg(long, value_name = "FILE")]
    plan: PathBuf,
    /// The board's serial number
    #[arg(long, required_unless_present = "mock")]
    serial: Option<String>,
    /// The board, as `halfrow boards` names it
    #[arg(long, value_name = "TARGET", required_unless_present = "mock")]
    board: Option<Target>,
    /// Judge the mock board with a drawn fault instead, to check the shift; for plans with `bad = "HR:MOCK"`
    #[arg(long, conflicts_with_all = ["serial", "board"])]
    mock: bool,
    /// The lane that the board is in
    #[arg(long, default_value = "1", value_parser = lane)]
    lane: String,
    /// Who tests
    #[arg(long, value_name = "NAME", env = "USER", default_value = "unknown")]
    operator: String,
    /// The station's name [default: this computer's]
    #[arg(long, value_name = "NAME", env = "HALFROW_STATION", value_parser = why::name)]
    station: Option<String>,
    /// Kill the lane when it sends nothing for this long, 0.1 to 86400 seconds
    #[arg(long, value_name = "SECONDS", default_value = "60", value_parser = seconds(0.1..=86_400.0))]
    silence: Duration,
    /// How much memory the lane may have, in MiB of addresses, 64 to 1048576
    #[arg(long, value_name = "MIB", default_value_t = MEMORY_MIB, value_parser = memory)]
    memory: u64,
    /// Test the board again although it passed already; for plans with `again = "ask"`
    #[arg(long)]
    again: bool,
    #[command(flatten)]
    disk: Disk,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
}

fn lane(text: &str) -> Result<String, String> {
    if is_lane_name(text) { Ok(text.to_owned()) } else { Err(format!("give {LANE_NAME}")) }
}

fn memory(text: &str) -> Result<u64, String> {
    let mib = text.parse().ok().filter(|mib| MEMORIES_MIB.contains(mib));
    mib.ok_or_else(|| format!("give {} to {} MiB", MEMORIES_MIB.start(), MEMORIES_MIB.end()))
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let plan_file = path::absolute(&arguments.plan).map_err(Failure::call)?;
    let plan = Plan::load(&plan_file)?;
    let (serial, board) = arguments.subject(&plan)?;
    let board = LaneBoard::Own(board);
    let signal = Signal::heed()?;
    let mut store = arguments.disk.opens(&arguments.data)?;
    let (recovered, stuck) = recovered(&mut store)?;
    if stuck.iter().any(|run| may_have(run, &arguments.lane, &board)) {
        return Err(Failure::error(NotLetGo { lane: arguments.lane.clone() }));
    }
    let station = arguments.station.clone().unwrap_or_else(this_computer);
    refused_again(store.folder(), &plan, &serial, arguments)?;
    let place = InLane::of(&station, &arguments.lane, &plan);
    let counts = store.folder().counts(&place, &serial, clock::now_ms())?;
    let order = Order {
        plan: &plan,
        plan_file: &plan_file,
        serial: &serial,
        board: &board,
        station: &station,
        lane: &arguments.lane,
        operator: &arguments.operator,
        program: Path::new(OWN_PROGRAM),
        counts,
        job: None,
        silence: arguments.silence,
        memory_mib: arguments.memory,
    };
    // Closing the database takes a while, and the verdict does not wait for it.
    let store = SharedStore::new(store);
    let ended = run::run(&store, &order, &mut SignalWatch { signal });
    if let Err(RunError::Unsaved { .. }) = &ended
        && !arguments.json
    {
        console::tell_line(&format!("UNSAVED {serial}: keep this board apart; it has no verdict"));
    }
    let saved = ended?;
    let exit = exit(&saved);
    console::tell(&if arguments.json { document(&saved, &recovered, exit)? } else { text(&saved, &plan) });
    Ok(exit)
}

impl Arguments {
    /// The serial number and the board, which the plan accepts, or those of the mock.
    fn subject(&self, plan: &Plan) -> Result<(String, Target), Failure> {
        let is_checked_by_mock = plan.production.shift.as_ref().is_some_and(|shift| shift.bad == Bad::Mock);
        match (&self.serial, &self.board) {
            (Some(serial), Some(board)) => {
                plan.select(serial)?;
                link::check(board).map_err(Failure::call)?;
                Ok((serial.clone(), board.clone()))
            }
            _ if is_checked_by_mock => {
                Ok((mock::serial(&self.lane), "mock".parse().map_err(Failure::error)?))
            }
            _ => Err(Failure::call(NoMock)),
        }
    }
}

/// The plan uses no mock board to check a shift.
#[derive(Debug, thiserror::Error)]
#[error(
    "no mock board checks the shifts of this plan; write bad = \"{}\" into its [shift], or give --serial and --board",
    mock::BARCODE
)]
pub(super) struct NoMock;

/// The process of an earlier run may still have the board.
#[derive(Debug, thiserror::Error)]
#[error(
    "the process of an earlier run may still have the board in lane {lane}, and cannot be killed; restart the computer"
)]
pub(super) struct NotLetGo {
    pub(super) lane: String,
}

fn refused_again(folder: &Folder, plan: &Plan, serial: &str, arguments: &Arguments) -> Result<(), Failure> {
    match folder.again(plan, serial, "say --again", false)? {
        None => Ok(()),
        Some(AgainError::Asked { .. }) if arguments.again => Ok(()),
        Some(error) => Err(Failure::call(error)),
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Serial(error) => Self::call(error),
            error => Self::error(error),
        }
    }
}

/// Watches a run: signals end it, and what happens is logged.
struct SignalWatch {
    signal: Signal,
}

impl Watch for SignalWatch {
    fn stop(&self) -> Option<StoppedBy> {
        self.signal.by()
    }

    fn hear(&mut self, stage: Stage<'_>) {
        match stage {
            Stage::Begun(run) => tracing::info!("run {}", run.id),
            Stage::AwaitsPlace(name) => tracing::info!("waiting for the place {name}"),
            Stage::Told(message) => log(message),
            Stage::Saving { .. } => tracing::info!("the result is being saved"),
        }
    }
}

fn log(message: &Message) {
    match message {
        Message::Step { seq, attempt, name } => tracing::info!("step {seq}, {name}, try {attempt}"),
        Message::Frame { name } => tracing::info!("{name}"),
        Message::Judging { step } => tracing::info!("{step}"),
        Message::AtSpeed(judged) => tracing::info!("{judged}"),
        Message::Ended { step } => tracing::info!("{} {}: {}", step.name, step.outcome, step.detail),
        Message::Identified { board } => tracing::info!("the board says it is {}", board.name),
        Message::Begun { .. } | Message::Rows { .. } | Message::Done | Message::Refused { .. } => {}
    }
}

fn document(saved: &Saved, recovered: &[Saved], exit: Exit) -> Result<String, Failure> {
    let Saved { record, stored, .. } = saved;
    let (ended, plan) = (&record.conclusion, &record.plan);
    let recovered: Vec<_> = recovered
        .iter()
        .map(|Saved { record: Record { run, .. }, .. }| json!({ "run": run.id, "serial": run.serial }))
        .collect();
    let rest = json!({
        "board": record.board,
        "run": record.run,
        "plan": { "name": plan.name, "version": plan.version, "sha256": plan.sha256 },
        "cause": ended.cause,
        "headline": ended.headline,
        "remedy": ended.remedy,
        "finding": ended.finding,
        "device": record.device,
        "production": record.production,
        "marginal": record.marginal,
        "nth": stored.nth,
        "ended_ms": record.ended_ms,
        "seconds": record.seconds,
        "suspects": record.suspects,
        "record_sha256": stored.record_sha256,
        "recovered": recovered,
    });
    document::text("run", exit, Some(ended.verdict), rest)
}

fn text(saved: &Saved, plan: &Plan) -> String {
    let Saved { record, stored, .. } = saved;
    let ended = &record.conclusion;
    let mut lines = vec![format!("{} {}: {}", ended.verdict, record.run.serial, ended.headline)];
    if ended.verdict == Verdict::Fail && is_known_bad(plan, record) {
        lines.push("as it should be: it checks the shift, and is known to be bad".to_owned());
    } else {
        let is_new = |remedy: &&String| ended.verdict != Verdict::Pass && !says(&ended.headline, remedy);
        lines.extend(ended.remedy.iter().filter(is_new).cloned());
    }
    let identity =
        record.steps.first().filter(|step| step.kind == "identity" && step.outcome == StepOutcome::Passed);
    if let Some(identity) = identity {
        lines.push(format!("board     {}", identity.detail));
    }
    lines.extend(
        record.not_exercised().iter().map(|(step, parts)| format!("untested  {}", in_one_line(step, parts))),
    );
    if record.marginal {
        lines.push("marginal  a step needed more than one try".to_owned());
    }
    if !record.production {
        lines.push(format!("it counts as no production: {}", why_no_production(plan, record)));
    }
    let judgement = match ended.verdict {
        Verdict::Error => "which is no judgement of the unit".to_owned(),
        _ if stored.nth == 0 => "which is in no yield".to_owned(),
        _ => format!("the unit's judgement {}", stored.nth),
    };
    lines.push(format!("run       {}, {judgement}", record.run.id));
    lines.push(format!("record    {}", stored.record_sha256));
    plain_lines(lines)
}

fn is_known_bad(plan: &Plan, Record { run, .. }: &Record) -> bool {
    plan.production.shift.as_ref().is_some_and(|shift| shift.bad.serial(&run.lane) == run.serial)
}

fn why_no_production(plan: &Plan, record: &Record) -> &'static str {
    if !plan.production.require_hardware {
        "its plan takes any kind of board"
    } else if record.board.as_ref().is_some_and(|board| !board.is_hardware()) {
        "the board is no hardware"
    } else if plan.production.is_reference(&record.run.serial) {
        "the unit checks shifts"
    } else {
        "this shift is not checked yet"
    }
}

/// The exit code that was read back.
fn exit(saved: &Saved) -> Exit {
    Exit::of(saved.stored.exit_code).filter(|exit| exit.verdict().is_some()).unwrap_or(Exit::Error)
}

/// This computer's name.
fn this_computer() -> String {
    let name = fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
    let name = name.trim();
    if name.is_empty() { "station".to_owned() } else { name.to_owned() }
}
