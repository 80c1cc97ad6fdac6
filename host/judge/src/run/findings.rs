//! What a run has found so far, and why it ended where it did.

use std::collections::BTreeMap;
use std::mem;
use std::time::{Duration, Instant};

use super::plan::Generation;
use super::seen::Seen;
use super::{Misfit, RunOptions};
use crate::board::{Board, BoardError, Status, Tally};
use crate::result::{
    BoardReport, Check, CheckName, Doubt, Finding, LinkReport, NotExercised, Outcome, Problem, Reconnection,
    SoakReport, Suspect, WithinReport,
};
use crate::target::BoardKind;
use crate::verdict::Cause;

/// Why a run ended before its last step, or with a board that is wrong.
#[derive(Clone, Debug)]
pub(super) enum End {
    /// The board is wrong.
    Failed { check: CheckName, finding: Finding, suspects: Vec<Suspect> },
    /// It could not be judged.
    Error { check: CheckName, cause: Cause, finding: Finding, unreachable: bool, outage: bool, answer: bool },
}

impl End {
    /// The run could not go on since the board could not be driven.
    pub(super) fn board(check: CheckName, error: &BoardError) -> Self {
        let unreachable =
            matches!(error, BoardError::Link { .. } | BoardError::NoAnswer { .. } | BoardError::SessionLost);
        let (cause, finding) = (error.cause(), Problem::of(error).into());
        let (outage, answer) = (error.is_outage(), error.is_answer());
        Self::Error { check, cause, finding, unreachable, outage, answer }
    }

    pub(super) fn error(check: CheckName, cause: Cause, finding: impl Into<Finding>) -> Self {
        let finding = finding.into();
        Self::Error { check, cause, finding, unreachable: false, outage: false, answer: false }
    }

    pub(super) fn failed(check: CheckName, finding: Finding) -> Self {
        Self::Failed { check, finding, suspects: Vec::new() }
    }

    /// The check that ended the run.
    pub(super) fn check(&self) -> (CheckName, Outcome, &Finding) {
        match self {
            Self::Failed { check, finding, .. } => (*check, Outcome::Failed, finding),
            Self::Error { check, finding, .. } => (*check, Outcome::Error, finding),
        }
    }

    pub(super) fn is_failed(&self) -> bool {
        matches!(self, Self::Failed { .. })
    }

    /// Whether the board said what no sound board says behind what the run asked of it.
    pub(super) fn is_answer(&self) -> bool {
        matches!(self, Self::Error { answer: true, .. })
    }

    pub(super) fn is_unreachable(&self) -> bool {
        matches!(self, Self::Error { unreachable: true, .. })
    }

    /// Whether the board is gone and may come back.
    pub(super) fn is_outage(&self) -> bool {
        matches!(self, Self::Error { outage: true, .. })
    }
}

/// What was asked of a board in a check.
pub(super) trait During<T> {
    /// Ends the run in `check` if the board could not be driven.
    fn during(self, check: CheckName) -> Result<T, End>;
}

impl<T> During<T> for Result<T, BoardError> {
    fn during(self, check: CheckName) -> Result<T, End> {
        self.map_err(|error| End::board(check, &error))
    }
}

/// What went over links that broke.
#[derive(Default)]
pub(super) struct Earlier {
    pub(super) tally: Tally,
    pub(super) seconds: Duration,
}

/// What one look at the board has found, of which a second one knows nothing.
#[derive(Default)]
pub(super) struct Look {
    /// Empty while a segment streams: its judge has what was seen until then ([`Run::stream`](super::steps::Run::stream)), so neither
    /// a place among all frames nor a verdict follows from it there.
    pub(super) seen: Seen,
    /// Rows that the board should have counted since it was greeted.
    pub(super) rows_counted: usize,
    /// The least that it should have counted of rows that it sent again.
    pub(super) repeats_counted: u32,
    /// Whether something that is not judged yet was found wrong over a link that broke.
    pub(super) found: bool,
    /// Why that may have come from the link.
    pub(super) doubt: Option<Doubt>,
    /// What was left untouched of a board that is right.
    pub(super) not_exercised: Vec<NotExercised>,
    /// Whether counters were not compared for what the board alone says of its link.
    pub(super) leaves_counters_out: bool,
    /// Whether something was found wrong that no link brings about, whatever else it has done.
    pub(super) beyond_links: bool,
    /// Whether a board came back that has no number to be known by.
    pub(super) is_unknown: bool,
    /// What was left untouched at the full pixel clock.
    pub(super) untested_at_speed: Vec<NotExercised>,
    /// Tables that frames in corners were made with, at the full pixel clock.
    pub(super) corners: Vec<Generation>,
    /// Generations of the plan that whole frames were made with, at the full pixel clock.
    pub(super) whole_at_speed: Vec<u8>,
}

/// What a run has found so far.
pub(super) struct Findings {
    pub(super) board: BoardReport,
    pub(super) checks: Vec<Check>,
    /// What every check has taken so far, and since when the next one counts.
    spent: BTreeMap<CheckName, Duration>,
    since: Instant,
    pub(super) tally: Tally,
    pub(super) link: LinkReport,
    pub(super) earlier: Earlier,
    pub(super) look: Look,
    /// Whether the run was made again since counters were wrong that a link moves as well.
    pub(super) counters_doubted: bool,
    /// Bursts that were begun.
    pub(super) bursts: u32,
    /// What was taken of a run that must keep within a time.
    pub(super) within: Option<WithinReport>,
    /// What a soak came to.
    pub(super) soak: Option<SoakReport>,
    /// Why the board cannot have what the plan uploads.
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

    /// Whether a check was made and found nothing.
    pub(super) fn has_passed(&self, name: CheckName) -> bool {
        self.checks.iter().any(|check| check.name == name && check.outcome == Outcome::Passed)
    }

    /// Takes the outcome of a check; of one that is made again the last word stands, and the times add up.
    pub(super) fn note(&mut self, name: CheckName, outcome: Outcome, finding: Finding) {
        self.lap(name);
        let seconds = self.spent.get(&name).map_or(0.0, Duration::as_secs_f64);
        self.checks.retain(|earlier| earlier.name != name);
        self.checks.push(Check { name, outcome, finding, seconds });
    }

    /// Counts the time since the last lap to a check.
    pub(super) fn lap(&mut self, name: CheckName) {
        let now = Instant::now();
        *self.spent.entry(name).or_default() += now.duration_since(self.since);
        self.since = now;
    }

    /// Leaves out the time since the last lap: it is told elsewhere.
    pub(super) fn begin_lap(&mut self) {
        self.since = Instant::now();
    }

    /// Forgets what was found of the open board, for a look in another session; names of bursts do not come again.
    pub(super) fn begin_again(&mut self) {
        self.look = Look::default();
        self.checks.retain(|check| matches!(check.name, CheckName::Judge | CheckName::Identity));
    }

    /// Takes the check that ended the run.
    pub(super) fn note_end(&mut self, end: &End) {
        let (name, outcome, finding) = end.check();
        self.note(name, outcome, finding.clone());
    }

    /// What is wrong beside that which ends the run.
    pub(super) fn also_wrong(&mut self, ends: impl Iterator<Item = End>) {
        ends.for_each(|end| self.note_end(&end));
    }

    /// Takes what the board says of itself.
    pub(super) fn note_identity(&mut self, board: &Board) {
        self.board = BoardReport::of(board, self.board.kind, mem::take(&mut self.board.target));
    }

    /// Takes the link's counts at the end of the run.
    pub(super) fn note_link(&mut self, board: &Board) {
        self.tally = self.earlier.tally;
        self.tally += board.tally();
        self.link.retry_limit = board.retry_limit();
        self.link.seconds = (self.earlier.seconds + board.now()).as_secs_f64();
    }

    /// Takes the counts of a link that broke. Of what was found wrong before, nothing else will tell what the link did.
    pub(super) fn keep_counts(&mut self, board: &Board) {
        if self.look.found || !self.look.seen.is_right() {
            let doubt = Doubt::of_session(board).unwrap_or(Doubt::PacketsUncounted {});
            self.look.doubt.get_or_insert(doubt);
        }
        self.earlier.tally += board.tally();
        self.earlier.seconds += board.now();
        (self.look.rows_counted, self.look.repeats_counted) = (0, 0);
    }

    /// Takes note that the board came back that went away for this `reason`.
    pub(super) fn note_return(&mut self, reason: Problem, away: Duration) {
        self.earlier.seconds += away;
        let back = Reconnection { reason, seconds_away: away.as_secs_f64(), kept_tables: None };
        self.link.reconnections.push(back);
    }

    pub(super) fn note_status(&mut self, status: &Status) {
        self.link.damaged_out = u64::from(status.crc_errors) + u64::from(status.framing_errors);
    }
}
