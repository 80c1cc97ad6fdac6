//! `halfrow verify`

use std::ffi::{OsStr, OsString};
use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use clap::builder::FalseyValueParser;
use serde::Serialize;

use super::board::BoardArguments;
use super::document::print_result;
use super::files::Files;
use super::given::{Decider, Given};
use super::inputs::{FrameName, InputArguments, file_hash, frame_sources};
use super::optics::{self, LensArguments};
use super::table_file::TableArgument;
use super::{CallError, Context, Failure, print};
use crate::exit::Exit;
use crate::settings::Settings;
use crate::{console, flags, json, progress, text};
use halfrow::frames::{Builtin, check_regular};
use halfrow::link::{Candidate, Lost, Recorder, Recording, RecordingFile};
use halfrow::optics::Chosen;
use halfrow::report::ReportFolder;
use halfrow::result::Variation;
use halfrow::run::{
    self, Build, Circumstances, Finished, FrameSource, Lack, Plan, RecordedRun, RestoreError, RunOptions,
    Timing, Vary,
};

#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    given: Given,
    #[command(flatten)]
    board: BoardArguments,
    /// A frame to stream instead of the built-in ones: a file, or builtin:NAME; may be given several times
    #[arg(long, value_name = "FILE", env = "HALFROW_FRAME")]
    frame: Vec<OsString>,
    #[command(flatten)]
    tables: TableArgument,
    #[arg(long, value_name = "NAME|FILE", help = optics::kernel_help(", instead of the table file's"), env = "HALFROW_KERNEL")]
    kernel: Option<OsString>,
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
    /// Let the board make frames at its full pixel clock for so many seconds of that clock, 0 for none
    /// [default: 3 on hardware, three frames on any other board]
    #[arg(long, value_name = "SECONDS", env = "HALFROW_AT_SPEED")]
    at_speed: Option<f64>,
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

pub(super) fn run(arguments: &Arguments, context: &Context) -> Result<Exit, Failure> {
    let settings = &context.settings;
    let recording = arguments.board.recording(settings)?;
    let frames = arguments.frames(settings)?;
    let files = arguments.input_files(&frames, settings);
    let (plan, options) = arguments.planned(recording.as_ref(), frames, &files, settings)?;
    if arguments.list {
        arguments.board.candidate_of(settings, recording)?;
        return list(&plan, context.json);
    }
    let outputs = arguments.outputs(files, context)?;
    let mut candidate = arguments.board.candidate_of(settings, recording)?;
    let mut lost = Lost::default();
    if let Some(file) = outputs.recording {
        let run = RecordedRun::of(&plan, &options);
        let link = Recorder::begin(candidate.link, file, &run).map_err(Failure::error)?;
        lost = link.lost();
        candidate = Candidate { link: Box::new(link), ..candidate };
    }
    let watched = progress::for_stderr(context.quiet || context.json);
    let mut finished = run::verify(&plan, candidate, &options, watched.as_ref())?;
    if let Some(error) = lost.get() {
        tell(&finished.lose_recording(error));
    }
    if let Some(Err(lack)) = outputs.report.map(|folder| finished.commit(folder)) {
        tell(&lack);
    }
    conclude(&finished, context.json)
}

/// Says what a verdict that stands lacks.
fn tell(lack: &Lack) {
    if !lack.is_told {
        console::error(&flags::named(&lack.to_string()));
    }
}

impl From<RestoreError> for Failure {
    fn from(error: RestoreError) -> Self {
        if error.is_other_datapath() { Self::refused(error) } else { Self::call(error) }
    }
}

/// The time of an `option` in seconds.
fn seconds(option: &'static str, seconds: Option<f64>) -> Result<Option<Duration>, Failure> {
    let time = seconds.map(Duration::try_from_secs_f64).transpose();
    time.map_err(|_| Failure::call(CallError::Seconds { option }))
}

/// What a run writes, with its places taken.
struct Outputs {
    report: Option<ReportFolder>,
    recording: Option<RecordingFile>,
}

fn conclude(finished: &Finished, as_json: bool) -> Result<Exit, Failure> {
    let report = &finished.report;
    if as_json {
        console::tell(&json::report(report).map_err(Failure::error)?);
    } else {
        console::tell(text::render(report).trim_end());
    }
    Ok(report.cause.into())
}

/// A frame that would be streamed.
#[derive(Serialize)]
struct Listed {
    number: u16,
    name: String,
    tables: &'static str,
    timing: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    variation: Option<Variation>,
}

/// Prints what would be streamed.
fn list(plan: &Plan, as_json: bool) -> Result<Exit, Failure> {
    let listed = listing(plan);
    if as_json {
        print_result("verify", Exit::Pass, None, serde_json::json!({ "listed": listed }))?;
        return Ok(Exit::Pass);
    }
    let line = |Listed { number, name, tables, timing, variation }: &Listed| {
        let variation = variation.map_or_else(String::new, |variation| format!(", {variation}"));
        format!("{number:>4}  {name:<24} {tables:<6} tables, {timing}{variation}")
    };
    print(&listed.iter().map(line).collect::<Vec<_>>().join("\n"))?;
    Ok(Exit::Pass)
}

fn listing(plan: &Plan) -> Vec<Listed> {
    let mut listed = Vec::new();
    for segment in plan.schedule(&Build::full(plan.tables.geometry().width())) {
        let timing = match segment.timing {
            Timing::Least => "least blanking",
            Timing::Sensor => "sensor blanking",
            Timing::Gaps(_) => "gaps",
        };
        let variation = plan.variation(&segment.geometry);
        listed.extend(segment.frames.iter().map(|frame| {
            let tables = if frame.generation == run::DECOY { "decoy" } else { "judged" };
            Listed { number: frame.number, name: frame.source.name(), tables, timing, variation }
        }));
    }
    listed
}

impl Arguments {
    /// What is to be streamed, or was when `recording` was made, and where it comes from.
    fn planned(
        &self,
        recording: Option<&Recording>,
        frames: Vec<FrameName>,
        files: &[PathBuf],
        settings: &Settings,
    ) -> Result<(Plan, RunOptions), Failure> {
        let (plan, options) = match recording {
            Some(recording) => {
                self.given.refuse_void(Decider::Recording, &settings.keys()).map_err(Failure::call)?;
                let (plan, options) = RecordedRun::restore(recording)?;
                let require_hardware = self.requires_hardware(settings);
                (plan, RunOptions { require_hardware, stop: self.board.stop(settings)?, ..options })
            }
            None => self.plan(frames, files, settings)?,
        };
        self.board.check_fault(settings, &plan)?;
        plan.check_length().map_err(Failure::call)?;
        Ok((plan, options))
    }

    /// What the options say is to be streamed, and where it comes from.
    fn plan(
        &self,
        frames: Vec<FrameName>,
        files: &[PathBuf],
        settings: &Settings,
    ) -> Result<(Plan, RunOptions), Failure> {
        if frames.iter().all(|frame| frame.file().is_none()) {
            self.given.refuse_void(Decider::NoFrameFile, &[]).map_err(Failure::call)?;
        }
        // Each is read more than once, since its hash is reported.
        files.iter().try_for_each(|path| check_regular(path)).map_err(Failure::call)?;
        let tables = self.tables.read(&self.given, &self.lens, settings)?;
        let kernel = self.kernel.as_deref().or(settings.kernel.as_deref().map(OsStr::new));
        let passed_over = self.tables.path(settings).filter(|_| tables.is_none());
        let files = files.iter().filter(|path| Some(*path) != passed_over);
        let is_free = tables.is_none() && frames.is_empty();
        let chosen = optics::choose(tables, &self.lens, kernel)?;
        let plan = Plan { vary: self.vary(is_free), ..self.plan_of(chosen, frames, settings)? };
        let circumstances = Circumstances {
            arguments: std::env::args_os().map(|argument| argument.to_string_lossy().into_owned()).collect(),
            files: files.map(|path| file_hash(path)).collect::<Result<_, _>>().map_err(Failure::call)?,
            draws: run::Draws::draw(),
        };
        Ok((plan, self.options(circumstances, settings)?))
    }

    /// What is varied in a run of which neither tables nor frames are named: what the call does not say.
    fn vary(&self, is_free: bool) -> Vary {
        let has_centre = self.given.is_flag("centre_x") || self.lens.file().is_some();
        Vary { centre: is_free && !has_centre, depth: is_free && !self.given.is_flag("bits") }
    }

    fn plan_of(&self, chosen: Chosen, frames: Vec<FrameName>, settings: &Settings) -> Result<Plan, Failure> {
        let geometry = chosen.tables.geometry();
        chosen.tables.check_ring(geometry.width().next_power_of_two()).map_err(Failure::call)?;
        let how = self.input.read_options(geometry, self.lens.phase);
        let frames = if frames.is_empty() {
            Builtin::ALL.into_iter().map(FrameSource::Builtin).collect()
        } else {
            frame_sources(frames, &how, geometry).map_err(Failure::call)?
        };
        Ok(Plan {
            frames,
            repeat: self.repeat,
            at_speed: seconds("--at-speed", self.at_speed.or(settings.at_speed))?,
            fail_fast: self.fail_fast,
            seed: self.seed.or(settings.seed).unwrap_or(1),
            ..chosen.plan(self.lens.phase)
        })
    }

    fn options(&self, circumstances: Circumstances, settings: &Settings) -> Result<RunOptions, Failure> {
        Ok(RunOptions {
            timeout: self.board.timeout(settings)?,
            stop: self.board.stop(settings)?,
            retry_limit: self.board.retry_limit(settings),
            reconnect: self.patience(settings)?,
            take_over: self.board.take_over,
            require_hardware: self.requires_hardware(settings),
            keep_equal: self.has_report(settings),
            circumstances,
            ..RunOptions::default()
        })
    }

    /// How long a board may stay away.
    fn patience(&self, settings: &Settings) -> Result<Option<Duration>, Failure> {
        let seconds = self.reconnect.or(settings.reconnect).filter(|_| self.record.is_none());
        self::seconds("--reconnect", seconds)
    }

    /// Looks at all that is read and written, and takes the places of what is written.
    fn outputs(&self, inputs: Vec<PathBuf>, context: &Context) -> Result<Outputs, Failure> {
        let settings = &context.settings;
        let overwrite = self.overwrite || settings.overwrite.unwrap_or(false);
        let report = self.report.as_deref().or(settings.report.as_deref());
        Files::new(overwrite)
            .reads(&context.settings_file)
            .reads(inputs)
            .reads_kernel(self.kernel.as_deref().or(settings.kernel.as_deref().map(OsStr::new)))
            .reads(self.board.replayed(settings)?)
            .writes_claimed("--record", self.record.as_deref())
            .writes_report("--report", report)
            .check()
            .map_err(Failure::call)?;
        Ok(Outputs {
            report: report
                .map(|path| ReportFolder::prepare(path, overwrite))
                .transpose()
                .map_err(Failure::call)?
                .map(|folder| folder.with_json(json::report)),
            recording: self
                .record
                .as_ref()
                .map(|path| RecordingFile::prepare(path, overwrite))
                .transpose()
                .map_err(Failure::call)?,
        })
    }

    /// The frames that are named; none stands for the built-in ones.
    fn frames(&self, settings: &Settings) -> Result<Vec<FrameName>, Failure> {
        match settings.frame.as_deref() {
            Some(names) if self.frame.is_empty() => FrameName::all(names),
            _ => FrameName::all(&self.frame),
        }
        .map_err(Failure::call)
    }

    /// Tables, lens and frames that are files.
    fn input_files(&self, frames: &[FrameName], settings: &Settings) -> Vec<PathBuf> {
        let frames = frames.iter().filter_map(FrameName::file);
        let tables = self.tables.path(settings).map(PathBuf::as_path);
        tables.into_iter().chain(self.lens.file()).chain(frames).map(PathBuf::from).collect()
    }

    fn has_report(&self, settings: &Settings) -> bool {
        self.report.is_some() || settings.report.is_some()
    }

    fn requires_hardware(&self, settings: &Settings) -> bool {
        self.require_hardware || settings.require_hardware.unwrap_or(false)
    }
}
