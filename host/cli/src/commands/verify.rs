//! `halfrow verify`

use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use clap::builder::FalseyValueParser;

use super::board::{self, BoardArguments};
use super::inputs::{InputArguments, file_hash, frame_sources};
use super::optics::{self, LensArguments};
use super::table_file::TableArgument;
use super::{Context, Failure, print, wrong_call};
use crate::exit::Exit;
use crate::settings::Settings;
use crate::{flags, json, progress, text};
use halfrow::frames::Builtin;
use halfrow::link::{Candidate, Recorder, Unfinished};
use halfrow::report::ReportFolder;
use halfrow::run::{
    self, Circumstances, Finished, FrameSource, Plan, RecordedRun, RestoreError, RunOptions, Timing,
};

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
    /// Print the result as JSON
    #[arg(long)]
    pub(super) json: bool,
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

pub(super) fn run(arguments: &Arguments, context: &Context) -> Result<Exit, Failure> {
    let settings = &context.settings;
    let (plan, options) = arguments.planned(settings)?;
    plan.check_length().map_err(Failure::call)?;
    let candidate = arguments.board.candidate(settings)?;
    if arguments.list {
        print(&listing(&plan))?;
        return Ok(Exit::Pass);
    }
    let overwrite = arguments.overwrite || settings.overwrite.unwrap_or(false);
    let folder = arguments.report.as_ref().or(settings.report.as_ref());
    let folder = folder.map(|path| ReportFolder::prepare(path, overwrite)).transpose();
    let folder = folder.map_err(Failure::call)?.map(|folder| folder.with_json(json::report));
    let mut unfinished = Unfinished::default();
    let candidate = match &arguments.record {
        None => candidate,
        Some(path) => {
            let run = RecordedRun::of(&plan, &options);
            let link = Recorder::create(candidate.link, path, &run, overwrite).map_err(Failure::call)?;
            unfinished = link.unfinished();
            Candidate { link: Box::new(link), ..candidate }
        }
    };
    let watched = progress::for_stderr(context.quiet || arguments.json);
    let mut finished = run::verify(&plan, candidate, &options, watched.as_ref())?;
    if let Some(error) = unfinished.get()
        && !finished.lose_recording(error)
    {
        lack(error);
    }
    let verdict = finished.report.verdict;
    let written = folder.map_or(Ok(()), |folder| finished.commit(folder));
    if let Err(error) = written
        && finished.report.verdict == verdict
    {
        lack(&error);
    }
    conclude(&finished, arguments.json)
}

/// Says what a verdict that stands lacks.
fn lack(error: &dyn std::error::Error) {
    anstream::eprintln!("error: {}", flags::named(&error.to_string()));
}

impl From<RestoreError> for Failure {
    fn from(error: RestoreError) -> Self {
        if error.is_other_datapath() { Self::refused(error) } else { Self::call(error) }
    }
}

fn conclude(finished: &Finished, as_json: bool) -> Result<Exit, Failure> {
    let report = &finished.report;
    if as_json {
        print(&json::report(report).map_err(Failure::error)?)?;
    } else {
        print(text::render(report).trim_end())?;
    }
    Ok(report.cause.into())
}

fn listing(plan: &Plan) -> String {
    let mut lines = Vec::new();
    for segment in plan.schedule(2) {
        let timing = match segment.timing {
            Timing::Least => "least blanking",
            Timing::Sensor => "sensor blanking",
            Timing::Gaps(_) => "gaps",
        };
        lines.extend(segment.frames.iter().map(|frame| {
            let tables = if frame.generation == run::DECOY { "decoy" } else { "judged" };
            format!("{:>4}  {:<24} {tables:<6} tables, {timing}", frame.number, frame.source.name())
        }));
    }
    lines.join("\n")
}

impl Arguments {
    /// What is to be done, and how: as the call says, or as a recording does.
    fn planned(&self, settings: &Settings) -> Result<(Plan, RunOptions), Failure> {
        let Some(recording) = self.board.recording(settings)? else {
            return Ok((self.plan(settings)?, self.options(settings)?));
        };
        let (plan, options) = RecordedRun::restore(&recording)?;
        let require_hardware = self.requires_hardware(settings);
        Ok((plan, RunOptions { require_hardware, stop: board::stop()?, ..options }))
    }

    fn plan(&self, settings: &Settings) -> Result<Plan, Failure> {
        let file = self.tables.file(&self.lens, settings).map_err(Failure::call)?;
        let kernel = self.kernel.as_deref().or(settings.kernel.as_deref());
        let chosen = optics::choose(file, &self.lens, kernel)?;
        let geometry = chosen.tables.geometry();
        chosen.tables.check_ring(geometry.width().next_power_of_two()).map_err(Failure::call)?;
        let how = self.input.read_options(geometry, self.lens.phase);
        let names = self.frame_names(settings);
        let frames = if names.is_empty() {
            Builtin::ALL.into_iter().map(FrameSource::Builtin).collect()
        } else {
            frame_sources(names, &how, geometry).map_err(Failure::call)?
        };
        Ok(Plan {
            frames,
            repeat: self.repeat,
            fail_fast: self.fail_fast,
            seed: self.seed.or(settings.seed).unwrap_or(1),
            ..chosen.plan(self.lens.phase)
        })
    }

    fn options(&self, settings: &Settings) -> Result<RunOptions, Failure> {
        Ok(RunOptions {
            timeout: self.board.timeout(settings)?,
            stop: board::stop()?,
            retry_limit: self.board.retry_limit(settings),
            reconnect: self.patience(settings)?,
            take_over: self.board.take_over,
            require_hardware: self.requires_hardware(settings),
            keep_equal: self.report.is_some() || settings.report.is_some(),
            circumstances: self.circumstances(settings)?,
            ..RunOptions::default()
        })
    }

    /// How long a board may stay away.
    fn patience(&self, settings: &Settings) -> Result<Option<Duration>, Failure> {
        let seconds = self.reconnect.or(settings.reconnect).filter(|_| self.record.is_none());
        let patience = seconds.map(Duration::try_from_secs_f64).transpose();
        patience.map_err(|_| wrong_call!("--reconnect takes a number of seconds, 0 or more"))
    }

    fn frame_names<'a>(&'a self, settings: &'a Settings) -> &'a [String] {
        if self.frame.is_empty() { settings.frame.as_deref().unwrap_or_default() } else { &self.frame }
    }

    fn requires_hardware(&self, settings: &Settings) -> bool {
        self.require_hardware || settings.require_hardware.unwrap_or(false)
    }

    fn circumstances(&self, settings: &Settings) -> Result<Circumstances, Failure> {
        let tables = self.tables.file(&self.lens, settings).map_err(Failure::call)?.map(PathBuf::from);
        let names = self.frame_names(settings).iter();
        let frames = names.filter(|name| !name.starts_with("builtin:")).map(PathBuf::from);
        let lens = self.lens.file().map(PathBuf::from);
        let files = tables.into_iter().chain(lens).chain(frames);
        Ok(Circumstances {
            arguments: std::env::args().collect(),
            files: files.map(|path| file_hash(&path)).collect::<Result<_, _>>().map_err(Failure::call)?,
            draws: run::Draws::draw(),
        })
    }
}
