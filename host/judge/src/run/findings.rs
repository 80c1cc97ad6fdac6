//! What a run has found so far, and why it ended where it did.

use std::time::Duration;

use super::judge::Seen;
use super::{Candidate, Misfit, RunOptions};
use crate::board::{Board, BoardError, Status, Tally};
use crate::report::{BoardReport, Check, Identity, LinkReport, Outcome, Suspect};
use crate::verdict::Cause;

/// Every check, in the order of the run.
pub(super) const CHECKS: [&str; 9] =
    ["judge", "identity", "link", "upload", "read-back", "frames", "latency", "tables after", "counters"];

/// Why a run ended before its last step, or with a board that is wrong.
#[derive(Clone, Debug)]
pub(super) enum End {
    /// The board is wrong.
    Failed { check: &'static str, headline: String, remedy: String, suspects: Vec<Suspect> },
    /// It could not be judged.
    Error {
        check: &'static str,
        cause: Cause,
        headline: String,
        remedy: Option<String>,
        unreachable: bool,
        outage: bool,
    },
}

impl End {
    /// The run could not go on since the board could not be driven.
    pub(super) fn board(check: &'static str, error: &BoardError) -> Self {
        let unreachable =
            matches!(error, BoardError::Link { .. } | BoardError::NoAnswer { .. } | BoardError::SessionLost);
        let (cause, headline, outage) = (error.cause(), chain(error), error.is_outage());
        Self::Error { check, cause, headline, remedy: None, unreachable, outage }
    }

    pub(super) fn error(check: &'static str, cause: Cause, headline: String) -> Self {
        Self::Error { check, cause, headline, remedy: None, unreachable: false, outage: false }
    }

    pub(super) fn failed(check: &'static str, headline: String, remedy: &str) -> Self {
        Self::Failed { check, headline, remedy: remedy.to_owned(), suspects: Vec::new() }
    }

    /// The check that ended the run.
    pub(super) fn check(&self) -> Check {
        let (name, outcome, detail) = match self {
            Self::Failed { check, headline, .. } => (check, Outcome::Failed, headline),
            Self::Error { check, headline, .. } => (check, Outcome::Error, headline),
        };
        Check { name, outcome, detail: detail.clone() }
    }

    pub(super) fn is_unreachable(&self) -> bool {
        matches!(self, Self::Error { unreachable: true, .. })
    }

    /// Whether the board is gone and may come back.
    pub(super) fn is_outage(&self) -> bool {
        matches!(self, Self::Error { outage: true, .. })
    }
}

/// An error with its causes, in one line.
pub(crate) fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        text = format!("{text}: {error}");
        cause = error.source();
    }
    text
}

/// What went over links that broke.
#[derive(Default)]
pub(super) struct Earlier {
    pub(super) tally: Tally,
    pub(super) seconds: Duration,
}

/// What a run has found so far.
pub(super) struct Findings {
    pub(super) board: BoardReport,
    pub(super) checks: Vec<Check>,
    pub(super) seen: Seen,
    pub(super) tally: Tally,
    pub(super) link: LinkReport,
    pub(super) earlier: Earlier,
    /// Rows that the board should have counted since it was greeted.
    pub(super) rows_counted: usize,
    /// Why the board cannot have what the plan uploads.
    pub(super) misfit: Option<Misfit>,
}

impl Findings {
    pub(super) fn new(options: &RunOptions, candidate: &Candidate) -> Self {
        let link = LinkReport {
            name: candidate.link.name(),
            retry_limit: options.retry_limit.of(0),
            ..LinkReport::default()
        };
        Self {
            board: BoardReport { kind: candidate.kind, target: candidate.target.clone(), identity: None },
            checks: Vec::new(),
            seen: Seen::default(),
            tally: Tally::default(),
            link,
            earlier: Earlier::default(),
            rows_counted: 0,
            misfit: None,
        }
    }

    pub(super) fn passed(&mut self, name: &'static str, detail: String) {
        self.note(Check { name, outcome: Outcome::Passed, detail });
    }

    /// Takes the outcome of a check; of one that is made again the last word stands.
    pub(super) fn note(&mut self, check: Check) {
        self.checks.retain(|earlier| earlier.name != check.name);
        self.checks.push(check);
    }

    /// What is wrong beside that which ends the run.
    pub(super) fn also_wrong(&mut self, ends: impl Iterator<Item = End>) {
        ends.for_each(|end| self.note(end.check()));
    }

    /// Takes what the board says of itself.
    pub(super) fn note_identity(&mut self, board: &Board) {
        self.board.kind = self.board.kind.confirmed_by(board.capabilities.nature);
        self.board.identity = Some(Identity::of(&board.welcome, &board.capabilities));
    }

    /// Takes the link's counts at the end of the run.
    pub(super) fn note_link(&mut self, board: &Board) {
        self.tally = self.earlier.tally;
        self.tally += board.tally();
        self.link.retry_limit = board.retry_limit();
        self.link.seconds = (self.earlier.seconds + board.now()).as_secs_f64();
    }

    /// Takes the counts of a link that broke.
    pub(super) fn keep_counts(&mut self, board: &Board) {
        self.earlier.tally += board.tally();
        self.earlier.seconds += board.now();
        self.rows_counted = 0;
    }

    pub(super) fn note_status(&mut self, status: &Status) {
        self.link.damaged_out = u64::from(status.crc_errors) + u64::from(status.framing_errors);
    }
}
