//! What a run has found so far, and why it ended.

use std::collections::BTreeMap;
use std::mem;
use std::time::{Duration, Instant};

use super::observations::Observations;
use super::plan::Generation;
use super::{Misfit, RunOptions};
use crate::board::{Board, BoardError, Status, Tally};
use crate::result::{
    BoardReport, Check, CheckName, Doubt, Finding, LinkReport, NotExercised, Outcome, Problem, Reconnection,
    SoakReport, Suspect, WithinReport,
};
use crate::target::BoardKind;
use crate::verdict::Cause;

/// Why a run ended before its last step, or with a wrong board.
#[derive(Clone, Debug)]
pub(super) enum End {
    /// The board is wrong.
    Failed { check: CheckName, finding: Finding, suspects: Vec<Suspect> },
    /// It could not be judged.
    Error { check: CheckName, cause: Cause, finding: Finding, shown: Shown },
}

/// What the board's error shows by which a run ends; nothing if it ends for another reason.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Shown {
    unreachable: bool,
    outage: bool,
    answer: bool,
    no_credit: bool,
}

impl Shown {
    fn by(error: &BoardError) -> Self {
        use BoardError::{Link, NoAnswer, SessionLost, TurnedAway};
        Self {
            unreachable: matches!(error, Link { .. } | TurnedAway(_) | NoAnswer { .. } | SessionLost),
            outage: error.is_outage(),
            answer: error.is_answer(),
            no_credit: error.is_without_credit(),
        }
    }
}

impl End {
    /// The run could not go on because the board could not be driven.
    pub(super) fn board(check: CheckName, error: &BoardError) -> Self {
        let (cause, finding) = (error.cause(), Problem::of(error).into());
        Self::Error { check, cause, finding, shown: Shown::by(error) }
    }

    pub(super) fn error(check: CheckName, cause: Cause, finding: impl Into<Finding>) -> Self {
        Self::Error { check, cause, finding: finding.into(), shown: Shown::default() }
    }

    pub(super) fn failed(check: CheckName, finding: Finding) -> Self {
        Self::Failed { check, finding, suspects: Vec::new() }
    }

    /// The check that ended the run.
    pub(super) fn name(&self) -> CheckName {
        match self {
            Self::Failed { check, .. } | Self::Error { check, .. } => *check,
        }
    }

    /// That check's outcome.
    pub(super) fn outcome(&self) -> Outcome {
        match self {
            Self::Failed { .. } => Outcome::Failed,
            Self::Error { .. } => Outcome::Error,
        }
    }

    /// What it found.
    pub(super) fn finding(&self) -> &Finding {
        match self {
            Self::Failed { finding, .. } | Self::Error { finding, .. } => finding,
        }
    }

    pub(super) fn is_failed(&self) -> bool {
        matches!(self, Self::Failed { .. })
    }

    /// Whether the board gave an answer that no sound board gives after what the run asked of it.
    pub(super) fn is_answer(&self) -> bool {
        matches!(self, Self::Error { shown: Shown { answer: true, .. }, .. })
    }

    /// Whether the board refused a row of the run because it was beyond the window.
    pub(super) fn is_without_credit(&self) -> bool {
        matches!(self, Self::Error { shown: Shown { no_credit: true, .. }, .. })
    }

    pub(super) fn is_unreachable(&self) -> bool {
        matches!(self, Self::Error { shown: Shown { unreachable: true, .. }, .. })
    }

    /// Whether the board went away and may come back.
    pub(super) fn is_outage(&self) -> bool {
        matches!(self, Self::Error { shown: Shown { outage: true, .. }, .. })
    }
}

/// The result of asking a board something in a check.
pub(super) trait During<T> {
    /// Ends the run in `check` if the board could not be driven.
    fn during(self, check: CheckName) -> Result<T, End>;
}

impl<T> During<T> for Result<T, BoardError> {
    fn during(self, check: CheckName) -> Result<T, End> {
        self.map_err(|error| End::board(check, &error))
    }
}

/// What went over earlier links, which broke.
#[derive(Default)]
pub(super) struct Earlier {
    pub(super) tally: Tally,
    pub(super) seconds: Duration,
}

/// What one look at the board has found. A second look begins with an empty one.
#[derive(Default)]
pub(super) struct Look {
    /// What was seen of all frames. It is empty while a segment is streamed, because the segment's judge has it then
    /// ([`Run::stream`](super::steps::Run::stream)): do not take a frame's index or a verdict from it there.
    pub(super) seen: Observations,
    /// Rows that the board should have counted since HELLO.
    pub(super) rows_counted: usize,
    /// The least number of rows that it should have counted as sent again.
    pub(super) repeats_counted: u32,
    /// Whether something was found wrong over a link that broke, and is not judged yet.
    pub(super) found_over_broken_link: bool,
    /// Why the link may have caused it.
    pub(super) doubt: Option<Doubt>,
    /// What was not exercised of a board that is right.
    pub(super) not_exercised: Vec<NotExercised>,
    /// Whether some counters were not compared only because the board, unlike the host, says that its link is poor.
    pub(super) leaves_counters_out: bool,
    /// Whether something was found wrong that no link can cause, whatever else the link did.
    pub(super) beyond_links: bool,
    /// Whether a board came back that has no serial number to identify it.
    pub(super) came_back_unnumbered: bool,
    /// What was not exercised at the full pixel clock.
    pub(super) untested_at_speed: Vec<NotExercised>,
    /// The tables with which frames were made in corners, at the full pixel clock.
    pub(super) corners: Vec<Generation>,
    /// The plan's generations with which whole frames were made at the full pixel clock.
    pub(super) whole_at_speed: Vec<u8>,
}

/// What a run has found so far.
pub(super) struct Findings {
    pub(super) board: BoardReport,
    pub(super) checks: Vec<Check>,
    /// The time that every check has taken so far.
    spent: BTreeMap<CheckName, Duration>,
    since: Instant,
    pub(super) tally: Tally,
    pub(super) link: LinkReport,
    pub(super) earlier: Earlier,
    pub(super) look: Look,
    /// Whether the run was made again because counters were wrong that a link can also change.
    pub(super) counters_doubted: bool,
    /// How many bursts were begun.
    pub(super) bursts: u32,
    /// What was taken of a run that must keep within a time; none for any other run.
    pub(super) within: Option<WithinReport>,
    /// The result of a soak; none for any other run.
    pub(super) soak: Option<SoakReport>,
    /// Why the board cannot take what the plan uploads, if it cannot.
    pub(super) misfit: Option<Misfit>,
}

impl Findings {
    pub(super) fn new(options: &RunOptions, target: &str, kind: BoardKind, link: String) -> Self {
        let link = LinkReport { name: link, retry_limit: options.retry_limit.of(0), ..LinkReport::default() };
        Self {
            board: BoardReport { kind, target: target.to_owned(), identity: None },
            checks: Vec::new(),
            spent: BTreeMap::new(),
            since: Instant::now(),
            tally: Tally::default(),
            link,
            earlier: Earlier::default(),
            look: Look::default(),
            counters_doubted: false,
            bursts: 0,
            within: None,
            soak: None,
            misfit: None,
        }
    }

    pub(super) fn passed(&mut self, name: CheckName, finding: Finding) {
        self.note(name, Outcome::Passed, finding);
    }

    /// Whether a check was made and passed.
    pub(super) fn has_passed(&self, name: CheckName) -> bool {
        self.checks.iter().any(|check| check.name == name && check.outcome == Outcome::Passed)
    }

    /// Notes the outcome of a check. If a check is made again, its last outcome stands, and its times add up.
    pub(super) fn note(&mut self, name: CheckName, outcome: Outcome, finding: Finding) {
        self.lap(name);
        let seconds = self.spent.get(&name).map_or(0.0, Duration::as_secs_f64);
        self.checks.retain(|earlier| earlier.name != name);
        self.checks.push(Check { name, outcome, finding, seconds });
    }

    /// Adds the time since the last lap to a check.
    pub(super) fn lap(&mut self, name: CheckName) {
        let now = Instant::now();
        *self.spent.entry(name).or_default() += now.duration_since(self.since);
        self.since = now;
    }

    /// Drops the time since the last lap, which is reported elsewhere.
    pub(super) fn begin_lap(&mut self) {
        self.since = Instant::now();
    }

    /// Forgets what was found of the open board, for a look in another session. The number of bursts stays, so that none
    /// gets the name of an earlier one.
    pub(super) fn begin_again(&mut self) {
        self.look = Look::default();
        self.checks.retain(|check| matches!(check.name, CheckName::Judge | CheckName::Identity));
    }

    /// Notes the check that ended the run. After an upload that failed, what was read back was of earlier tables.
    pub(super) fn note_end(&mut self, end: &End) {
        if end.name() == CheckName::Upload {
            self.checks.retain(|check| check.name != CheckName::ReadBack);
        }
        self.note(end.name(), end.outcome(), end.finding().clone());
    }

    /// Notes what is wrong in addition to what ends the run.
    pub(super) fn also_wrong(&mut self, ends: impl Iterator<Item = End>) {
        ends.for_each(|end| self.note_end(&end));
    }

    /// Notes what the board says about itself.
    pub(super) fn note_identity(&mut self, board: &Board) {
        self.board = BoardReport::of(board, self.board.kind, mem::take(&mut self.board.target));
    }

    /// Notes the link's counts at the end of the run.
    pub(super) fn note_link(&mut self, board: &Board) {
        self.tally = self.earlier.tally;
        self.tally += board.tally();
        self.link.retry_limit = board.retry_limit();
        self.link.seconds = (self.earlier.seconds + board.now()).as_secs_f64();
    }

    /// Notes the counts of a link that broke. If something was found wrong before, nothing will show later what that link
    /// did, so a doubt is noted too.
    pub(super) fn keep_counts(&mut self, board: &Board) {
        if self.look.found_over_broken_link || !self.look.seen.is_right() {
            let doubt = Doubt::of_session(board).unwrap_or(Doubt::PacketsUncounted {});
            self.look.doubt.get_or_insert(doubt);
        }
        self.earlier.tally += board.tally();
        self.earlier.seconds += board.now();
        (self.look.rows_counted, self.look.repeats_counted) = (0, 0);
    }

    /// Notes that the board, which had gone away for this `reason`, came back.
    pub(super) fn note_return(&mut self, reason: Problem, away: Duration) {
        self.earlier.seconds += away;
        let back = Reconnection { reason, seconds_away: away.as_secs_f64(), kept_tables: None };
        self.link.reconnections.push(back);
    }

    pub(super) fn note_status(&mut self, status: &Status) {
        self.link.damaged_out = status.damaged().into();
    }
}
