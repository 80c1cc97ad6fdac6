//! The options of the board and its link, which several commands share.

use std::time::Duration;

use clap::builder::{OsStringValueParser, TypedValueParser};
use clap::{Arg, Args};

use halfrow_mock::{BurstBuild, Options, Streamed};
use halfrow_program::number::{any, number};

use super::judging::time_limit;
use crate::call_error::CallError;
use crate::commands::Context;
use crate::failure::Failure;
use crate::pool::{self, POOL};
use crate::settings::Settings;
use crate::signals;
use halfrow::board::{BoardNature, Bursts, Capabilities, OpenOptions, RetryLimit, Stop, WhenHeld};
use halfrow::call::Files;
use halfrow::link::{self, Candidate, Recording, kinds};
use halfrow::run::{AtSpeed, Build, JUDGED, Plan, usual_capabilities};
use halfrow::target::{BoardKind, Target, TargetError};
use halfrow::verdict::StoppedBy;

/// Which board, and how patiently.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Board")]
pub(crate) struct BoardArguments {
    #[arg(long, value_name = "TARGET", env = "HALFROW_BOARD", help = help(Replays::No, MOCK), value_parser = target())]
    board: Option<Target>,
    /// Stop after this many seconds, at most 1e9, by this computer's clock or the link's, whichever comes first
    /// [default: no limit]
    #[arg(long, value_name = "SECONDS", env = "HALFROW_TIMEOUT", value_parser = any::<f64>("a number of seconds"))]
    timeout: Option<f64>,
    /// Packets that may be sent again: 16, plus this percentage, 0 to 100, of all that are sent
    /// [default: 5; `link` has none]
    #[arg(long, value_name = "PERCENT", env = "HALFROW_RETRY_LIMIT", value_parser = number("percent", 0.0..=100.0))]
    retry_limit: Option<f64>,
    /// Take the board over from another host that holds it
    #[arg(long)]
    pub(crate) take_over: bool,
}

/// The end of the help of most commands: what they do if no board is named.
pub(crate) const MOCK: &str = " [default: mock]";

/// Whether a command works with a recording, which answers only what it was asked when it was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Replays {
    Yes,
    No,
}

/// The targets that a command takes by itself, as they are written.
pub(crate) fn own_forms(replays: Replays) -> String {
    let takes = |kind: &&kinds::Kind| replays == Replays::Yes || kind.board != BoardKind::Replay;
    kinds::KINDS.iter().filter(takes).flat_map(kinds::Kind::targets).collect::<Vec<_>>().join(", ")
}

/// The same of a command that also takes boards of a pool.
pub(crate) fn forms(replays: Replays) -> String {
    format!("{}, or pool:KIND", own_forms(replays))
}

/// The help of `--board`. `without` is its end: what the command does if no board is named.
fn help(replays: Replays, without: &str) -> String {
    format!("The board: {}, which a plant shares; see `halfrow boards`{without}", forms(replays))
}

/// `argument`, with that help if it is `--board`. For use on every argument: clap moves one that is changed by itself to the end.
pub(crate) fn helped(argument: Arg, replays: Replays, without: &str) -> Arg {
    if argument.get_id() == "board" { argument.help(help(replays, without)) } else { argument }
}

/// Refuses a recording where a board must answer new requests.
pub(crate) fn refuse_recording(target: &Target) -> Result<(), Failure> {
    match kinds::board_of(target) {
        BoardKind::Replay => Err(wrong_board(Failure::call(CallError::RecordingAnswersNothingNew))),
        _ => Ok(()),
    }
}

/// Checks that `target` is written correctly. Its device need not exist, and a pool is not asked.
pub(crate) fn check(target: &Target) -> Result<(), Failure> {
    if target.kind == POOL { Ok(()) } else { link::check(target).map_err(wrong_board) }
}

/// Refuses a fault of the mock board `target` that has no effect in a run of `plan`.
pub(crate) fn check_fault(target: &Target, plan: &Plan) -> Result<(), Failure> {
    let Some((fault, build)) = link::fault(target).map_err(wrong_board)? else { return Ok(()) };
    let judged = plan
        .schedule(&Build::full(plan.tables.geometry().width()))
        .into_iter()
        .flat_map(|segment| segment.frames);
    let frames = judged.filter(|frame| frame.generation == JUDGED).count();
    let tables = &plan.tables;
    let grid = tables.shape().map(|_| tables.entries().len());
    let (width, height) = (tables.geometry().width(), tables.geometry().height());
    let at_speed = plan.at_speed != AtSpeed::Off;
    let capabilities = mock_capabilities(&build, plan);
    let (made, of_rules) = (plan.tallest_made(&capabilities), plan.rows_of_rules(&capabilities));
    // A target has at most one fault of the board, which is this one, and one of the pipe.
    let is_harmed = target.options.iter().filter(|(key, _)| key == "fault").count() > 1;
    let played = plan.geometries(&capabilities);
    let centres = played.iter().map(|geometry| (geometry.width(), geometry.centre2())).collect();
    let bits = played.iter().map(|geometry| geometry.depth().bits()).max().unwrap_or(0);
    let streamed =
        Streamed { width, height, grid, frames, at_speed, of_rules, made, centres, bits, is_harmed };
    match fault.without_effect(&streamed, &build) {
        None => Ok(()),
        Some(why) => Err(wrong_board(Failure::call(CallError::FaultWithoutEffect {
            target: target.to_string(),
            reason: why.to_string(),
        }))),
    }
}

/// What the size of frames that a mock board makes depends on.
fn mock_capabilities(build: &Options, plan: &Plan) -> Capabilities {
    let usual = usual_capabilities(plan, BoardNature::Mock);
    let Options { max_width, max_height, bursts: made, .. } = *build;
    let bursts = usual.bursts.filter(|_| made != BurstBuild::None);
    let bursts = bursts.map(|bursts| Bursts { trap: made == BurstBuild::Trapped, ..bursts });
    Capabilities { max_width, max_height, ring: build.ring_size(), bursts, ..usual }
}

/// `failure`, attributed to the value of `--board`.
pub(crate) fn wrong_board(failure: impl Into<Failure>) -> Failure {
    failure.into().in_value_of("--board")
}

/// Reads a target; it must be text in UTF-8.
pub(crate) fn target() -> impl TypedValueParser<Value = Target> {
    OsStringValueParser::new().try_map(|text| match text.into_string() {
        Ok(text) => text.parse().map_err(|error: TargetError| error.to_string()),
        Err(_) => Err("a target is text in UTF-8; give the file another name, or link to it".to_owned()),
    })
}

impl BoardArguments {
    /// Whether a board was named at all.
    pub(crate) fn is_named(&self, settings: &Settings) -> bool {
        self.board.is_some() || settings.board.is_some()
    }

    /// The list of what a call reads and writes, with what its board reads and writes.
    pub(crate) fn files(&self, overwrite: bool, context: &Context) -> Result<Files, Failure> {
        let target = self.named(&context.settings)?;
        Ok(context
            .files(overwrite)
            .reads(link::recording_file(&target))
            .writes_claimed(link::WRITTEN_FILE, link::written_file(&target)))
    }

    /// Like [`Self::files`], for a call that only asks a board if `is_asked`.
    pub(crate) fn files_if(
        &self,
        is_asked: bool,
        overwrite: bool,
        context: &Context,
    ) -> Result<Files, Failure> {
        if is_asked { self.files(overwrite, context) } else { Ok(context.files(overwrite)) }
    }

    /// The target that is named: a board, or a pool of some kind; by default the mock.
    pub(crate) fn named(&self, settings: &Settings) -> Result<Target, Failure> {
        let target = match (&self.board, &settings.board) {
            (Some(target), _) => target.clone(),
            (None, Some(text)) => text.parse().map_err(Failure::call).map_err(wrong_board)?,
            (None, None) => Target::mock(),
        };
        pool::kind(&target).map_err(Failure::call).map_err(wrong_board)?;
        Ok(target)
    }

    /// The board that is named, or the one that was leased from the pool that is named. The first call waits for that, so
    /// everything else that the program is called with must have been checked.
    pub(crate) fn target(&self, settings: &Settings) -> Result<Target, Failure> {
        self.timeout(settings)?;
        pool::resolved(self.named(settings)?).map_err(Failure::error)
    }

    /// The link to the board that is named, which must not be a recording. The default is the mock; no board is ever guessed.
    pub(crate) fn candidate(&self, settings: &Settings) -> Result<Candidate, Failure> {
        let target = self.target(settings)?;
        refuse_recording(&target)?;
        link::open(&target).map_err(wrong_board)
    }

    /// The link to the board that is named, or to the one in `recording` if there is one.
    pub(crate) fn candidate_of(
        &self,
        settings: &Settings,
        recording: Option<Recording>,
    ) -> Result<Candidate, Failure> {
        match recording {
            None => self.candidate(settings),
            Some(recording) => link::replay(&self.target(settings)?, recording).map_err(wrong_board),
        }
    }

    /// The recording, if the target is one. A pool lends none.
    pub(crate) fn recording(&self, settings: &Settings) -> Result<Option<Recording>, Failure> {
        link::recording(&self.named(settings)?).map_err(wrong_board)
    }

    pub(crate) fn open_options(&self, settings: &Settings) -> Result<OpenOptions, Failure> {
        Ok(OpenOptions {
            when_held: WhenHeld::wanted(self.take_over),
            retry_limit: self.retry_limit(settings),
            stop: self.stop(settings)?.link_limit(self.timeout(settings)?),
            ..OpenOptions::default()
        })
    }

    /// Like [`Self::open_options`], for measuring a link: without a retry limit, unless the call itself gives one.
    pub(crate) fn measuring_options(&self, settings: &Settings) -> Result<OpenOptions, Failure> {
        let options = self.open_options(settings)?;
        let retry_limit = if self.retry_limit.is_some() { options.retry_limit } else { RetryLimit::NONE };
        Ok(OpenOptions { retry_limit, ..options })
    }

    /// What ends the run early: a signal, the loss of a board of a pool, or the call's limit on this computer's clock.
    pub(crate) fn stop(&self, settings: &Settings) -> Result<Stop, Failure> {
        let stopped = signals::heed();
        let lost = || pool::is_lost().then_some(StoppedBy::Caller);
        let stop = Stop::when(move || stopped().or_else(lost));
        Ok(stop.wall_limit(self.timeout(settings)?))
    }

    pub(crate) fn timeout(&self, settings: &Settings) -> Result<Option<Duration>, Failure> {
        time_limit("--timeout", self.timeout.or(settings.timeout))
    }

    pub(crate) fn retry_limit(&self, settings: &Settings) -> RetryLimit {
        self.retry_limit.or(settings.retry_limit).map(RetryLimit::of_percent).unwrap_or_default()
    }
}
