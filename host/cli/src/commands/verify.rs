//! `halfrow verify`

mod recorded;

use std::ffi::{OsStr, OsString};
use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use clap::builder::FalseyValueParser;
use serde::Serialize;
use serde_json::json;

use super::board::BoardArguments;
use super::document::print_result;
use super::files::Files;
use super::given::{Decider, Given};
use super::inputs::{FrameName, InputArguments, file_hash, frame_sources};
use super::optics::{self, Chosen, LensArguments};
use super::table_file::TableArgument;
use super::{Context, Failure, print};
use crate::settings::Settings;
use crate::{console, progress};
use halfrow::frames::{Builtin, check_regular};
use halfrow::link::{Candidate, Lost, Recorder, Recording, RecordingFile};
use halfrow::report::{self, ReportError, ReportFolder};
use halfrow::result::{Problem, Report};
use halfrow::run::{self, Circumstances, Finished, FrameSource, Plan, Timing};
use halfrow::verdict::{Exit, Verdict};

/// Judge a board: stream frames through it and compare every sample with the reference
///
/// Without --board the built-in mock board is judged. Exit codes: 0 PASS, 1 FAIL, 2 usage, 3 ERROR, 4 busy, 5 nothing judged,
/// 6 identity or version refused, 129, 130 or 143 interrupted.
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
    /// The kernel: nearest, linear, keys, hermite, hermite-balanced, sharp5, sharp7, or a file, instead of the table file's
    #[arg(long, value_name = "NAME|FILE", env = "HALFROW_KERNEL")]
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
    let (plan, circumstances) = arguments.planned(recording.as_ref(), settings)?;
    if arguments.list {
        arguments.board.candidate_of(settings, recording)?;
        return list(&plan, context.json);
    }
    let outputs = arguments.outputs(context)?;
    let mut candidate = arguments.board.candidate_of(settings, recording)?;
    let mut lost = Lost::default();
    if let Some(file) = outputs.recording {
        let run = recorded::RecordedRun::of(&plan, &circumstances);
        let link = Recorder::begin(candidate.link, file, &run).map_err(Failure::error)?;
        lost = link.lost();
        candidate = Candidate { link: Box::new(link), ..candidate };
    }
    let stop = arguments.board.stop(settings, plan.timeout)?;
    let watched = progress::for_stderr(context.quiet || context.json);
    let mut finished = run::verify(&plan, candidate, &circumstances, &stop, watched.as_ref());
    if finished.report.exit_code == Exit::Usage {
        // The call does not fit the board: there is no verdict, and so nothing to report on.
        return Err(finished.report.finding.as_problem().into());
    }
    if let Some(error) = lost.get() {
        let what = Problem::new(RECORDING_LOST, "the recording could not be written");
        // Its sentence says what its own causes do.
        let causes = vec![Problem { causes: Vec::new(), ..Problem::of(error) }];
        lose(&mut finished.report, Problem { causes, ..what }, ANOTHER_RECORDING);
    }
    if let Some(folder) = outputs.report {
        write_report(folder, &mut finished);
    }
    conclude(&finished, context.json)
}

fn write_report(folder: ReportFolder, finished: &mut Finished) {
    if let Err(error) = folder.commit(&finished.report, &finished.evidence) {
        let remedy = if matches!(error, ReportError::Exists { .. }) { ANOTHER_REPORT } else { ROOM };
        let what = Problem::new(REPORT_LOST, "the report could not be written");
        let causes = Problem::of(&error).chain();
        lose(&mut finished.report, Problem { causes, ..what }, remedy);
    }
}

/// What a run writes, with its places taken.
struct Outputs {
    report: Option<ReportFolder>,
    recording: Option<RecordingFile>,
}

const ROOM: &str = "Free some space or choose another place with --report, then run again.";
const ANOTHER_REPORT: &str = "Name another folder with --report, or give --overwrite, then run again.";
const ANOTHER_RECORDING: &str = "Free some space or choose another place with --record, then run again.";

/// A PASS whose files could not be written is none. Any other verdict stands, and stderr says what it lacks.
fn lose(report: &mut Report, what: Problem, remedy: &str) {
    if report.verdict != Verdict::Pass {
        console::error(&what);
        return;
    }
    report.finding = Problem { remedy: Some(remedy.to_owned()), ..what }.into();
    report.verdict = Verdict::Error;
    report.exit_code = Exit::Error;
}

fn conclude(finished: &Finished, as_json: bool) -> Result<Exit, Failure> {
    let report = &finished.report;
    if as_json {
        console::tell(&report::json(report).map_err(Failure::error)?);
    } else {
        console::tell(report::text(report).trim_end());
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
            let tables = if frame.generation == run::DECOY { "decoy" } else { "judged" };
            Listed { number: frame.number, name: frame.source.name(), tables, timing }
        }));
    }
    listed
}

impl Arguments {
    /// What is to be streamed, or was when `recording` was made, and where it comes from.
    fn planned(
        &self,
        recording: Option<&Recording>,
        settings: &Settings,
    ) -> Result<(Plan, Circumstances), Failure> {
        let (plan, circumstances) = match recording {
            Some(recording) => {
                self.given.refuse_void(Decider::Recording, &settings.keys())?;
                recorded::restore(recording, self.requires_hardware(settings), self.has_report(settings))?
            }
            None => self.plan(settings)?,
        };
        self.board.check_fault(settings, &plan)?;
        plan.check_length()?;
        Ok((plan, circumstances))
    }

    /// What the options say is to be streamed, and where it comes from.
    fn plan(&self, settings: &Settings) -> Result<(Plan, Circumstances), Failure> {
        let frames = FrameName::all(&self.frame_names(settings))?;
        let files: Vec<_> = frames.iter().filter_map(FrameName::file).map(PathBuf::from).collect();
        if files.is_empty() {
            self.given.refuse_void(Decider::NoFrameFile, &[])?;
        }
        let lens = self.lens.file().map(PathBuf::from);
        // Each file is hashed, too.
        files
            .iter()
            .chain(&lens)
            .chain(self.tables.path(settings))
            .try_for_each(|path| check_regular(path))?;
        let tables = self.tables.read(&self.given, &self.lens, settings)?;
        let kernel = self.kernel.as_deref().or(settings.kernel.as_deref().map(OsStr::new));
        let chosen = optics::choose(tables, &self.lens, kernel)?;
        let table_file = chosen.file.clone();
        let plan = self.plan_of(chosen, frames, settings)?;
        let files = table_file.iter().chain(&lens).chain(&files);
        let circumstances = Circumstances {
            arguments: std::env::args_os().map(|argument| argument.to_string_lossy().into_owned()).collect(),
            files: files.map(|path| file_hash(path)).collect::<Result<_, _>>()?,
            draws: run::Draws::draw(),
        };
        Ok((plan, circumstances))
    }

    fn plan_of(&self, chosen: Chosen, frames: Vec<FrameName>, settings: &Settings) -> Result<Plan, Failure> {
        let geometry = chosen.tables.geometry();
        chosen.tables.check_ring(geometry.width().next_power_of_two())?;
        let how = self.input.read_options(geometry, self.lens.phase);
        let frames = if frames.is_empty() {
            Builtin::ALL.into_iter().map(FrameSource::Builtin).collect()
        } else {
            frame_sources(frames, &how, geometry)?
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
            keep_pictures: self.has_report(settings),
        })
    }

    /// How long a board may stay away.
    fn patience(&self, settings: &Settings) -> Result<Option<Duration>, Failure> {
        let seconds = self.reconnect.or(settings.reconnect).filter(|_| self.record.is_none());
        let patience = seconds.map(Duration::try_from_secs_f64).transpose();
        patience.map_err(|_| anyhow::anyhow!("--reconnect takes a number of seconds, 0 or more").into())
    }

    /// Looks at all that is read and written, and takes the places of what is written.
    fn outputs(&self, context: &Context) -> Result<Outputs, Failure> {
        let settings = &context.settings;
        let overwrite = self.overwrite || settings.overwrite.unwrap_or(false);
        let report = self.report.as_deref().or(settings.report.as_deref());
        Files::new(overwrite)
            .reads(&context.settings_file)
            .reads(self.input_files(settings)?)
            .reads_kernel(self.kernel.as_deref().or(settings.kernel.as_deref().map(OsStr::new)))
            .reads(self.board.replayed(settings)?)
            .writes("--record", &self.record)
            .writes_report("--report", report)
            .check()?;
        Ok(Outputs {
            report: report.map(|path| ReportFolder::prepare(path, overwrite)).transpose()?,
            recording: self
                .record
                .as_ref()
                .map(|path| RecordingFile::prepare(path, overwrite))
                .transpose()?,
        })
    }

    /// Tables, lens and frames that are files.
    fn input_files(&self, settings: &Settings) -> Result<Vec<PathBuf>, Failure> {
        let frames = FrameName::all(&self.frame_names(settings))?;
        let frames = frames.iter().filter_map(FrameName::file).map(PathBuf::from);
        let tables = self.tables.path(settings).map(PathBuf::from);
        Ok(tables.into_iter().chain(self.lens.file().map(PathBuf::from)).chain(frames).collect())
    }

    fn frame_names(&self, settings: &Settings) -> Vec<OsString> {
        match settings.frame.as_deref() {
            Some(names) if self.frame.is_empty() => names.iter().map(OsString::from).collect(),
            _ => self.frame.clone(),
        }
    }

    fn has_report(&self, settings: &Settings) -> bool {
        self.report.is_some() || settings.report.is_some()
    }

    fn requires_hardware(&self, settings: &Settings) -> bool {
        self.require_hardware || settings.require_hardware.unwrap_or(false)
    }
}
