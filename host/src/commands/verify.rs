//! `halfrow verify`

mod recorded;

use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use clap::builder::FalseyValueParser;
use serde::Serialize;
use serde_json::json;

use super::board::BoardArguments;
use super::document::print_result;
use super::inputs::{InputArguments, file_hash, frame_sources};
use super::optics::{self, LensArguments};
use super::table_file::TableArgument;
use super::{Context, Failure, print};
use crate::frames::Builtin;
use crate::link::{Candidate, Recorder, Unfinished};
use crate::progress;
use crate::report::{self, ReportFolder};
use crate::result::{Problem, Report};
use crate::session::{self, Circumstances, Finished, FrameSource, Plan, Timing};
use crate::settings::Settings;
use crate::verdict::{Exit, Verdict};

/// Judge a board: stream frames through it and compare every sample with the reference
///
/// Without --board the built-in mock board is judged. Exit codes: 0 PASS, 1 FAIL, 2 usage, 3 ERROR, 4 busy, 5 nothing judged,
/// 6 identity or version refused, 130 or 143 interrupted.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    board: BoardArguments,
    /// A frame to stream instead of the built-in ones: a file, or builtin:NAME; may be given several times
    #[arg(long, value_name = "FILE", env = "HALFROW_FRAME")]
    frame: Vec<String>,
    #[command(flatten)]
    tables: TableArgument,
    /// The kernel: nearest, linear, keys, hermite, hermite-balanced, sharp5, sharp7, or a file, instead of the table file's
    #[arg(long, value_name = "NAME|FILE", env = "HALFROW_KERNEL")]
    kernel: Option<String>,
    /// Write a report (JSON, JUnit, HTML) into this folder
    #[arg(long, value_name = "FOLDER", env = "HALFROW_REPORT")]
    report: Option<PathBuf>,
    /// Keep every byte of the run with its time, for replay:FILE
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Go on when the board goes away and comes back within so many seconds [30 if no number is given]
    #[arg(long, value_name = "SECONDS", num_args = 0..=1, require_equals = true, default_missing_value = "30")]
    #[arg(env = "HALFROW_RECONNECT", conflicts_with = "record")]
    reconnect: Option<f64>,
    /// Replace a previous report or recording
    #[arg(long, env = "HALFROW_OVERWRITE", value_parser = FalseyValueParser::new())]
    overwrite: bool,
    /// Stream the frames this often
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    repeat: u32,
    /// Stop at the first frame that differs
    #[arg(long)]
    fail_fast: bool,
    /// Refuse to judge anything but hardware
    #[arg(long, env = "HALFROW_REQUIRE_HARDWARE", value_parser = FalseyValueParser::new())]
    require_hardware: bool,
    /// Only list what would be streamed
    #[arg(long)]
    list: bool,
    /// Seed of noise, gaps and link test
    #[arg(long, value_name = "SEED", env = "HALFROW_SEED")]
    seed: Option<u64>,
    #[command(flatten)]
    input: InputArguments,
    #[command(flatten)]
    lens: LensArguments,
}

/// A recording that was asked for and is not there.
pub(super) const RECORDING_LOST: &str = "recording-lost";
/// A report that was asked for and is not there.
pub(super) const REPORT_LOST: &str = "report-lost";

pub(super) fn run(arguments: &Arguments, context: &Context) -> Result<Exit, Failure> {
    let settings = &context.settings;
    let recording = arguments.board.recording(settings)?;
    let (plan, circumstances) = match &recording {
        Some(recording) => recorded::restore(recording, arguments.requires_hardware(settings))?,
        None => (arguments.plan(settings)?, arguments.circumstances(settings)?),
    };
    plan.check_length()?;
    let candidate = arguments.board.candidate(settings)?;
    if arguments.list {
        return list(&plan, context.json);
    }
    let overwrite = arguments.overwrite || settings.overwrite.unwrap_or(false);
    let folder = arguments.report.as_ref().or(settings.report.as_ref());
    let folder = folder.map(|path| ReportFolder::prepare(path, overwrite)).transpose()?;
    let mut unfinished = Unfinished::default();
    let candidate = match &arguments.record {
        None => candidate,
        Some(path) => {
            let run = recorded::RecordedRun::of(&plan, &circumstances);
            let link = Recorder::create(candidate.link, path, &run, overwrite)?;
            unfinished = link.unfinished();
            Candidate { link: Box::new(link), ..candidate }
        }
    };
    let stop = arguments.board.stop(plan.timeout)?;
    let watched = progress::for_stderr(context.quiet || context.json);
    let mut finished = session::verify(&plan, candidate, &circumstances, &stop, watched.as_ref());
    if finished.report.exit_code == Exit::Usage {
        // The call does not fit the board: there is no verdict, and so nothing to report on.
        return Err(finished.report.finding.as_problem().into());
    }
    if let Some(error) = unfinished.get() {
        let causes = vec![Problem::of(error)];
        lose(&mut finished.report, RECORDING_LOST, "the recording could not be written", causes, "--record");
    }
    let written = folder.map_or(Ok(()), |folder| folder.commit(&finished.report, &finished.evidence));
    if let Err(error) = written {
        let causes = Problem::of(&error).chain();
        lose(&mut finished.report, REPORT_LOST, "the report could not be written", causes, "--report");
    }
    conclude(&finished, context.json)
}

/// A result that could not be written is none, even when all samples were equal.
fn lose(report: &mut Report, code: &str, what: &str, causes: Vec<Problem>, option: &str) {
    let remedy = Some(format!("Free some space or choose another place with {option}, then run again."));
    report.finding = Problem { remedy, causes, ..Problem::new(code, what) }.into();
    report.verdict = Verdict::Error;
    report.exit_code = Exit::Error;
}

fn conclude(finished: &Finished, as_json: bool) -> Result<Exit, Failure> {
    let report = &finished.report;
    if as_json {
        print(&report::json(report).map_err(Failure::error)?)?;
    } else {
        print(report::text(report).trim_end())?;
    }
    Ok(report.exit_code)
}

/// A frame that would be streamed.
#[derive(Serialize)]
struct Listed {
    number: u16,
    name: String,
    tables: &'static str,
    timing: &'static str,
}

/// Prints what would be streamed.
fn list(plan: &Plan, as_json: bool) -> Result<Exit, Failure> {
    let listed = listing(plan);
    if as_json {
        print_result("verify", Exit::Pass, None, json!({ "listed": listed }))?;
        return Ok(Exit::Pass);
    }
    let line = |Listed { number, name, tables, timing }: &Listed| {
        format!("{number:>4}  {name:<24} {tables:<6} tables, {timing}")
    };
    print(&listed.iter().map(line).collect::<Vec<_>>().join("\n"))?;
    Ok(Exit::Pass)
}

fn listing(plan: &Plan) -> Vec<Listed> {
    let mut listed = Vec::new();
    for segment in plan.schedule(2) {
        let timing = match segment.timing {
            Timing::Least => "least blanking",
            Timing::Sensor => "sensor blanking",
            Timing::Gaps(_) => "gaps",
        };
        listed.extend(segment.frames.iter().map(|frame| {
            let tables = if frame.generation == session::DECOY { "decoy" } else { "judged" };
            Listed { number: frame.number, name: frame.source.name(), tables, timing }
        }));
    }
    listed
}

impl Arguments {
    fn plan(&self, settings: &Settings) -> Result<Plan, Failure> {
        let file = self.tables.file(&self.lens, settings)?;
        let kernel = self.kernel.as_deref().or(settings.kernel.as_deref());
        let chosen = optics::choose(file, &self.lens, kernel)?;
        let geometry = chosen.tables.geometry();
        chosen.tables.check_ring(geometry.width().next_power_of_two())?;
        let how = self.input.read_options(geometry, self.lens.phase);
        let names = self.frame_names(settings);
        let frames = if names.is_empty() {
            Builtin::ALL.into_iter().map(FrameSource::Builtin).collect()
        } else {
            frame_sources(names, &how, geometry)?
        };
        Ok(Plan {
            lens: chosen.optics.lens,
            centre_y: chosen.optics.centre_y,
            phase: self.lens.phase,
            tables: chosen.tables,
            kernel: chosen.kernel,
            tables_source: chosen.source,
            rows_outside_circle: chosen.rows_outside_circle,
            frames,
            repeat: self.repeat,
            fail_fast: self.fail_fast,
            require_hardware: self.requires_hardware(settings),
            take_over: self.board.take_over,
            seed: self.seed.or(settings.seed).unwrap_or(1),
            timeout: self.board.timeout(settings)?,
            retry_limit: self.board.retry_limit(settings),
            reconnect: self.patience(settings)?,
            keep_pictures: self.report.is_some() || settings.report.is_some(),
        })
    }

    /// How long a board may stay away.
    fn patience(&self, settings: &Settings) -> Result<Option<Duration>, Failure> {
        let seconds = self.reconnect.or(settings.reconnect).filter(|_| self.record.is_none());
        let patience = seconds.map(Duration::try_from_secs_f64).transpose();
        patience.map_err(|_| anyhow::anyhow!("--reconnect takes a number of seconds, 0 or more").into())
    }

    fn frame_names<'a>(&'a self, settings: &'a Settings) -> &'a [String] {
        if self.frame.is_empty() { settings.frame.as_deref().unwrap_or_default() } else { &self.frame }
    }

    fn requires_hardware(&self, settings: &Settings) -> bool {
        self.require_hardware || settings.require_hardware.unwrap_or(false)
    }

    fn circumstances(&self, settings: &Settings) -> Result<Circumstances, Failure> {
        let tables = self.tables.file(&self.lens, settings)?.map(PathBuf::from);
        let names = self.frame_names(settings).iter();
        let frames = names.filter(|name| !name.starts_with("builtin:")).map(PathBuf::from);
        let lens = self.lens.file().map(PathBuf::from);
        let files = tables.into_iter().chain(lens).chain(frames);
        Ok(Circumstances {
            arguments: std::env::args().collect(),
            files: files.map(|path| file_hash(&path)).collect::<Result<_, _>>()?,
            draws: session::Draws::draw(),
        })
    }
}
