//! `halfrow load`

mod error;
mod loader;
mod record;

use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

use clap::Args;
use clap::builder::PossibleValuesParser;
use halfrow_program::number::seconds;
use serde::Serialize;
use serde_json::json;

use self::loader::Call;
use self::record::Record;
use super::{Context, Failure};
use crate::arguments::board::wrong_board;
use crate::arguments::given::Given;
use crate::bitstreams::{BOARDS, BitstreamBoard};
use crate::call_error::CallError;
use crate::document::result_text;
use crate::exit::Exit;
use crate::{console, pool, signals};
use halfrow::board::{Board, BoardError, OpenOptions, Stop, WhenHeld};
use halfrow::link::{self, Class, kinds};
use halfrow::result::BoardReport;
use halfrow::target::{BoardKind, Target};
use halfrow::verdict::{Cause, StoppedBy};
use halfrow::words::plain_lines;

pub(super) use error::LoadError;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    given: Given,
    /// The bitstream, as a board's build script leaves it: top.bit, with top.bit.json beside it
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// The board that is loaded, as `halfrow boards` lists it [default: the one that the file beside FILE names]
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(BOARDS.map(|board| board.name)))]
    onto: Option<String>,
    /// The loaded board behind its link: it is greeted, and must be of the file's build
    #[arg(long, value_name = "TARGET", env = "HALFROW_BOARD", value_parser = crate::arguments::board::target())]
    board: Option<Target>,
    /// The longest that loading may take, and the board until it answers, 0.1 to 86400 seconds
    #[arg(long, value_name = "SECONDS", default_value = "120", value_parser = seconds(0.1..=86_400.0))]
    deadline: Duration,
    /// What else openFPGALoader is called with, as `-- --ftdi-serial NUMBER` of one board among several
    #[arg(last = true, value_name = "OPTIONS")]
    options: Vec<String>,
}

/// What was loaded, and how.
#[derive(Serialize)]
struct Loaded<'a> {
    file: String,
    onto: &'static str,
    command: Vec<String>,
    record: Option<&'a Record>,
    /// Whether the board's build was compared with the file's. If so, it is the same.
    compared: bool,
}

pub(super) fn run(arguments: &Arguments, context: &Context) -> Result<Exit, Failure> {
    let record = record::read(&arguments.file).map_err(Failure::call)?;
    let onto = onto(arguments, record.as_ref()).map_err(Failure::call)?;
    let board = arguments.loaded_board(context)?;
    if let Some(warning) = warning(&arguments.file, record.as_ref()) {
        console::diagnose(&format_args!("warning: {warning}"));
    }
    let stopped = signals::heed();
    let device = record.as_ref().map(|record| record.device.as_str());
    let call = Call::new(onto, device, &arguments.file, &arguments.options);
    call.run(arguments.deadline, &context.child_output(), &stopped)?;
    let report = board.map(|target| greeted(&target, arguments.deadline, stopped)).transpose()?;
    let compared = match (&report, &record) {
        (Some(report), Some(record)) => compare(report, record)?,
        _ => false,
    };
    let loaded = Loaded {
        file: arguments.file.display().to_string(),
        onto: onto.name,
        command: call.words(),
        record: record.as_ref(),
        compared,
    };
    if context.json {
        console::tell(&result_text("load", Exit::Pass, report.as_ref(), json!({ "loaded": loaded }))?);
    } else {
        console::tell(&text(&loaded, report.as_ref()));
    }
    Ok(Exit::Pass)
}

impl Arguments {
    /// The board that is greeted once it is loaded. It is checked here, since it would be too late then.
    fn loaded_board(&self, context: &Context) -> Result<Option<Target>, Failure> {
        let target = match (&self.board, &context.settings.board) {
            (None, None) => return Ok(None),
            (None, Some(text)) => text.parse().map_err(Failure::call).map_err(wrong_board)?,
            (Some(target), _) => target.clone(),
        };
        if target.kind != pool::POOL && kinds::board_of(&target) != BoardKind::Replay {
            link::check(&target).map_err(wrong_board)?;
        }
        let Some(unfit) = unfit(&target) else { return Ok(Some(target)) };
        let (settings, keys) = (context.settings_file.as_deref(), context.settings.keys());
        match self.given.place("board", settings, &keys) {
            None => Err(wrong_board(Failure::call(unfit))),
            // It is the board of every call, most of which load nothing.
            Some(place) => {
                tracing::info!("{place} is passed over: {unfit}");
                Ok(None)
            }
        }
    }
}

/// Why what is at `target` is never a board that has just been loaded, if so.
fn unfit(target: &Target) -> Option<anyhow::Error> {
    let name = || target.to_string();
    match kinds::board_of(target) {
        _ if target.kind == pool::POOL => Some(LoadError::OfPool { target: name() }.into()),
        BoardKind::Hardware => None,
        BoardKind::Replay => Some(CallError::RecordingAnswersNothingNew.into()),
        _ => Some(LoadError::BuiltIn { target: name() }.into()),
    }
}

/// The board that the call or the record names.
fn onto(arguments: &Arguments, record: Option<&Record>) -> Result<&'static BitstreamBoard, LoadError> {
    let path = arguments.file.clone();
    match (arguments.onto.as_deref(), record.map(|record| record.board.as_str())) {
        (Some(named), Some(board)) if named != board => {
            Err(LoadError::OtherBoard { path, board: board.to_owned(), named: named.to_owned() })
        }
        (None, None) => Err(LoadError::Nameless { path, known: BitstreamBoard::names() }),
        (named, recorded) => {
            let board = named.or(recorded).unwrap_or_default();
            let (known, name) = (BitstreamBoard::names(), board.to_owned());
            BitstreamBoard::named(board).ok_or(LoadError::UnknownBoard { path, board: name, known })
        }
    }
}

/// Why a bitstream cannot be identified, if so.
fn warning(file: &Path, record: Option<&Record>) -> Option<String> {
    match record {
        None => Some(format!(
            "there is no {} beside it, so nothing tells which build {} is, and nothing can be compared",
            record::place(file).display(),
            file.display()
        )),
        Some(record) if record.modified => Some(format!(
            "{} was built from sources that are in no commit; its build {} names the one before",
            file.display(),
            record.build
        )),
        Some(_) => None,
    }
}

/// What the board at `target` reports, as soon as it answers. Its link may come and go while it is loaded.
fn greeted(
    target: &Target,
    limit: Duration,
    stopped: impl Fn() -> Option<StoppedBy> + Copy + Send + Sync + 'static,
) -> Result<BoardReport, Failure> {
    let stop = Stop::when(stopped);
    let deadline = Instant::now() + limit;
    let mut last = None;
    loop {
        let left = deadline.saturating_duration_since(Instant::now());
        let (failure, next) = match greet(target, stop.clone().wall_limit(Some(left))) {
            Ok(report) => return Ok(report),
            Err(failed) => failed,
        };
        if let Some(by) = stopped() {
            return Err(Failure::of(Cause::Stopped(by).into(), LoadError::NotAwaited { by }));
        }
        match next {
            Next::Never => return Err(failure),
            // The failure of a complete try says more than that the last one had no time.
            Next::TooLate => return Err(last.unwrap_or(failure)),
            Next::MayDiffer if Instant::now() >= deadline => return Err(failure),
            Next::MayDiffer => last = Some(failure),
        }
        thread::sleep(Duration::from_millis(100));
    }
}

/// Whether another try may help.
enum Next {
    Never,
    MayDiffer,
    TooLate,
}

/// One try, ended early by `stop`; with a failure, whether another try may help.
fn greet(target: &Target, stop: Stop) -> Result<BoardReport, (Failure, Next)> {
    let again = |may_differ| if may_differ { Next::MayDiffer } else { Next::Never };
    let candidate = link::open(target).map_err(|error| {
        let next = again(error.class() != Class::Call);
        (error.into(), next)
    })?;
    let options = OpenOptions { when_held: WhenHeld::Leave, stop, ..OpenOptions::default() };
    let report = |board: &mut Board| {
        BoardReport::of(board.welcome(), board.capabilities(), candidate.kind, candidate.target)
    };
    Board::with(candidate.link, &options, report).map_err(|failed| {
        let is_cut = matches!(failed.error, BoardError::Timeout { .. });
        let failure = Failure::from(failed);
        let next = if is_cut { Next::TooLate } else { again(failure.exit == Exit::Error) };
        (failure, next)
    })
}

/// Refuses a board whose build is not the file's.
fn compare(report: &BoardReport, record: &Record) -> Result<bool, Failure> {
    let board = report.identity.as_ref().map(|identity| identity.build.clone()).unwrap_or_default();
    if board.eq_ignore_ascii_case(&record.build) {
        return Ok(true);
    }
    let (target, file) = (report.target.to_string(), record.build.clone());
    Err(Failure::refused(LoadError::OtherBuild { target, board, file }))
}

fn text(loaded: &Loaded<'_>, board: Option<&BoardReport>) -> String {
    let mut lines = vec![format!("{:<12} {} into {}", "loaded", loaded.file, loaded.onto)];
    if let Some(Record { kind, device, build, tools, .. }) = loaded.record {
        lines.push(format!("{:<12} {build}: {kind} for {device}, by {tools}", "build"));
    }
    if let Some(BoardReport { kind, target, identity: Some(identity) }) = board {
        let same = if loaded.compared { ", which is the file's" } else { "" };
        lines.push(format!(
            "{:<12} {target} ({kind}) answers: {}, build {}{same}",
            "board", identity.name, identity.build
        ));
    } else {
        lines.push(format!("{:<12} not asked; --board TARGET compares its build with the file's", "board"));
    }
    plain_lines(lines)
}
