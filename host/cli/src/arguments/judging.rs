//! The options of every command that judges a board, and how such a run ends.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use halfrow_program::files::prepare_files;
use halfrow_program::number::{any, whole_number};

use super::board::{BoardArguments, check_fault, wrong_board};
use super::given::{Given, yes_or_no};
use super::optics::{self, LensArguments};
use super::table_file::{NamedTables, TableArgument};
use crate::commands::{Context, codes};
use crate::exit::Exit;
use crate::failure::Failure;
use crate::settings::Settings;
use crate::{console, flags, text};
use halfrow::call::{self, FilesError, Input};
use halfrow::files::check_regular;
use halfrow::link::{self, Candidate, Recording, RecordingFile};
use halfrow::optics::Chosen;
use halfrow::report::{self, ReportFolder};
use halfrow::result::FileHash;
use halfrow::run::{self, Lack, Plan, Provenance, RecordedRun, RunOptions};
use halfrow::target::Target;

/// How long a board may stay away if no number is given.
const PATIENCE: Duration = Duration::from_secs(30);

#[derive(Debug, Args)]
pub(crate) struct RunArguments {
    #[command(flatten)]
    tables: TableArgument,
    #[arg(long, value_name = "NAME|FILE", help = optics::kernel_help(", instead of the table file's"), env = "HALFROW_KERNEL")]
    kernel: Option<OsString>,
    /// Write a report (JSON, JUnit, HTML) into this folder
    #[arg(long, value_name = "FOLDER", env = "HALFROW_REPORT")]
    report: Option<PathBuf>,
    /// Who tests, for the report
    #[arg(long, value_name = "NAME", env = "HALFROW_OPERATOR")]
    operator: Option<String>,
    /// Go on when the board goes away and comes back within this many seconds, at most 1e9 [without a number: 30, and 300 in a soak]
    #[arg(long, value_name = "SECONDS", num_args = 0..=1, require_equals = true)]
    #[arg(env = "HALFROW_RECONNECT", value_parser = any::<f64>("a number of seconds"))]
    reconnect: Option<Option<f64>>,
    /// Replace what an earlier run has written
    #[arg(long, value_name = "YES|NO", num_args = 0..=1, require_equals = true, default_missing_value = "yes")]
    #[arg(env = "HALFROW_OVERWRITE", value_parser = yes_or_no(), hide_possible_values = true)]
    overwrite: Option<bool>,
    /// Refuse to judge anything but hardware
    #[arg(long, value_name = "YES|NO", num_args = 0..=1, require_equals = true, default_missing_value = "yes")]
    #[arg(env = "HALFROW_REQUIRE_HARDWARE", value_parser = yes_or_no(), hide_possible_values = true)]
    require_hardware: Option<bool>,
    /// Seed of built-in frames, gaps, link test and the frames that the board makes [default: 1]
    #[arg(long, value_name = "SEED", env = "HALFROW_SEED", value_parser = whole_number())]
    seed: Option<u64>,
    #[command(flatten)]
    pub(crate) board: BoardArguments,
    #[command(flatten)]
    pub(crate) lens: LensArguments,
}

/// A run as a call asks for it.
pub(crate) struct Planned {
    pub(crate) plan: Plan,
    pub(crate) options: RunOptions,
    /// The recording of the run to judge again, if it is one.
    pub(crate) recording: Option<Recording>,
    /// The files that the plan was made from.
    pub(crate) inputs: Vec<PathBuf>,
}

/// Where a run writes. The places are taken.
struct Outputs {
    /// The report's folder.
    report: Option<ReportFolder>,
    /// The recording's file.
    recording: Option<RecordingFile>,
}

impl RunArguments {
    /// The table file to judge with; none if the lens options make the tables.
    pub(crate) fn table_file(
        &self,
        given: &Given,
        settings: &Settings,
    ) -> Result<Option<NamedTables>, Failure> {
        self.tables.read(given, &self.lens, settings)
    }

    /// The tables and kernel to judge with, from `tables` if given, and the files that they and the lens were read from.
    pub(crate) fn chosen(
        &self,
        tables: Option<NamedTables>,
        settings: &Settings,
    ) -> Result<(Chosen, Vec<Input>), Failure> {
        let of_tables = tables.as_ref().map(|tables| tables.input.clone());
        let chosen = optics::choose(tables, &self.lens, self.kernel(settings))?;
        let inputs = [of_tables, chosen.optics.file.clone(), chosen.kernel_file.clone()];
        Ok((chosen, inputs.into_iter().flatten().collect()))
    }

    fn kernel<'a>(&'a self, settings: &'a Settings) -> Option<&'a OsStr> {
        self.kernel.as_deref().or(settings.kernel.as_deref().map(OsStr::new))
    }

    /// The files of the tables and the lens.
    pub(crate) fn input_files(&self, settings: &Settings) -> Vec<PathBuf> {
        let tables = self.tables.path(settings).map(PathBuf::as_path);
        tables.into_iter().chain(self.lens.file()).map(PathBuf::from).collect()
    }

    /// Refuses files of tables and lens that cannot be read twice.
    pub(crate) fn check_inputs(&self, settings: &Settings) -> Result<(), Failure> {
        self.lens.file().map_or(Ok(()), check_regular).map_err(Failure::call)?;
        let tables = self.tables.path(settings).map(PathBuf::as_path);
        tables.map_or(Ok(()), check_regular).map_err(|error| Failure::call(error).in_value_of("--tables"))
    }

    pub(crate) fn seed(&self, settings: &Settings) -> u64 {
        self.seed.or(settings.seed).unwrap_or(1)
    }

    /// Who tests; none if nobody is named.
    pub(crate) fn operator(&self) -> Option<String> {
        self.operator.clone().filter(|name| !name.trim().is_empty())
    }

    /// How long a board may stay away: as the call says, with `usual` if it gives no number, else as the settings say; none if
    /// neither says anything.
    pub(crate) fn patience(
        &self,
        settings: Option<f64>,
        usual: Duration,
    ) -> Result<Option<Duration>, Failure> {
        let named = self.reconnect.map(|named| named.unwrap_or(usual.as_secs_f64()));
        seconds("--reconnect", named.or(settings))
    }

    /// The options of a run that judges with what was read from `inputs`, apart from what ends it early.
    pub(crate) fn options(&self, inputs: Vec<Input>, settings: &Settings) -> Result<RunOptions, Failure> {
        let provenance = Provenance {
            arguments: std::env::args_os().map(|argument| argument.to_string_lossy().into_owned()).collect(),
            files: inputs.into_iter().map(FileHash::from).collect(),
            session_ids: run::SessionIds::draw(),
            operator: self.operator(),
        };
        Ok(RunOptions {
            timeout: self.board.timeout(settings)?,
            retry_limit: self.board.retry_limit(settings),
            reconnect: self.patience(settings.reconnect, PATIENCE)?,
            take_over: self.board.take_over,
            require_hardware: self.requires_hardware(settings),
            keep_equal: self.report_path(settings).is_some(),
            provenance,
            ..RunOptions::default()
        })
    }

    pub(crate) fn requires_hardware(&self, settings: &Settings) -> bool {
        self.require_hardware.or(settings.require_hardware).unwrap_or(false)
    }

    fn overwrites(&self, settings: &Settings) -> bool {
        self.overwrite.or(settings.overwrite).unwrap_or(false)
    }

    fn report_path<'a>(&'a self, settings: &'a Settings) -> Option<&'a Path> {
        self.report.as_deref().or(settings.report.as_deref())
    }

    /// Judges the board that is named, or the one in the recording, and records the run to `record`.
    ///
    /// A pool is asked for a board last, so that no wrong call waits for one or takes one from others.
    pub(crate) fn judge(
        &self,
        planned: Planned,
        record: Option<&Path>,
        context: &Context,
    ) -> Result<Exit, Failure> {
        let Planned { plan, options, recording, inputs } = planned;
        let settings = &context.settings;
        self.check_files(inputs, record, context)?;
        let leased = self.board.target(settings);
        if let Ok(target) = &leased {
            check_fault(target, &plan)?;
        }
        let outputs = self.outputs(record, context)?;
        let (target, candidate) = match leased {
            Ok(target) => (target, self.board.candidate_of(settings, recording)),
            Err(failure) => (self.board.named(settings)?, Err(failure)),
        };
        // Not before: while the call waits for a board or a connection, there is no run whose time passes or that a signal must
        // end in order.
        let options = RunOptions { stop: self.board.stop(settings)?, ..options };
        judge_and_report(candidate, &plan, &options, &target, outputs, context)
    }

    /// Checks everything that the run reads, including `inputs`, and writes.
    fn check_files(
        &self,
        inputs: Vec<PathBuf>,
        record: Option<&Path>,
        context: &Context,
    ) -> Result<(), Failure> {
        let settings = &context.settings;
        prepare_files(
            &self
                .board
                .files(self.overwrites(settings), context)?
                .reads(inputs)
                .reads_kernel(self.kernel(settings))
                .writes_claimed("--record", record)
                .writes_report("--report", self.report_path(settings)),
        )
        .map_err(|error| match (error.option(), &error) {
            (Some(link::WRITTEN_FILE), _) => wrong_board(Failure::call(error)),
            (Some(option), _) => Failure::call(error).in_value_of(option),
            (None, FilesError::Report(_)) => Failure::call(error).in_value_of("--report"),
            (None, _) => Failure::call(error),
        })
    }

    /// Takes the places that the run writes to.
    fn outputs(&self, record: Option<&Path>, context: &Context) -> Result<Outputs, Failure> {
        let settings = &context.settings;
        let overwrite = self.overwrites(settings);
        let report = self.report_path(settings);
        let report = report.map(|path| ReportFolder::prepare(path, overwrite)).transpose();
        let recording = record.map(|path| RecordingFile::prepare(path, overwrite)).transpose();
        let report = report.map_err(|error| Failure::call(error).in_value_of("--report"))?;
        Ok(Outputs { report, recording: recording.map_err(Failure::call)? })
    }
}

/// The time that `option` gives in seconds.
pub(crate) fn seconds(option: &'static str, seconds: Option<f64>) -> Result<Option<Duration>, Failure> {
    call::seconds(option, seconds).map_err(|error| Failure::call(error).in_value_of(option))
}

/// The most time that `option` gives, in seconds.
pub(crate) fn time_limit(option: &'static str, seconds: Option<f64>) -> Result<Option<Duration>, Failure> {
    call::time_limit(option, seconds).map_err(|error| Failure::call(error).in_value_of(option))
}

/// Judges the board of `candidate`, which `target` names, writes the report, if there is a folder for it, and prints it.
fn judge_and_report(
    candidate: Result<Candidate, Failure>,
    plan: &Plan,
    options: &RunOptions,
    target: &Target,
    outputs: Outputs,
    context: &Context,
) -> Result<Exit, Failure> {
    let Outputs { report: folder, recording } = outputs;
    let judged = candidate.and_then(|candidate| {
        let (candidate, lost) =
            RecordedRun::begin(plan, options, candidate, recording).map_err(Failure::error)?;
        let watched = context.progress();
        Ok((run::verify(plan, candidate, options, watched.as_ref())?, lost))
    });
    let (mut finished, lost) = match judged {
        Ok(judged) => judged,
        Err(failure) => return Err(not_begun(failure, plan, options, target, folder)),
    };
    let lacks = [finished.note_recording(&lost), folder.and_then(|folder| finished.commit(folder).err())];
    lacks.iter().flatten().for_each(tell);
    let report = &finished.report;
    if context.json {
        console::tell(report::json(report).map_err(Failure::error)?.trim_end());
    } else {
        console::tell(text::render(report).trim_end());
    }
    Ok(report.cause.into())
}

/// Writes the report of a run that never began, for example because its board cannot be opened, so that nobody mistakes an
/// earlier report for its own; and returns the failure. A wrong call is no run and has no report.
fn not_begun(
    failure: Failure,
    plan: &Plan,
    options: &RunOptions,
    target: &Target,
    folder: Option<ReportFolder>,
) -> Failure {
    let Some(cause) = failure.exit.cause() else { return failure };
    let problem = codes::problem(failure.exit, &failure.error);
    if let Some(folder) = folder
        && let Err(lack) = run::not_begun(plan, target, cause, problem, options).commit(folder)
    {
        tell(&lack);
    }
    failure
}

/// Says on stderr what is missing beside a verdict that stands.
fn tell(lack: &Lack) {
    if !lack.is_told {
        console::error(&flags::named(&lack.to_string()));
    }
}
