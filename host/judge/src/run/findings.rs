//! What a run has found so far.

use std::mem;
use std::time::Duration;

use super::checks::Checks;
use super::{Misfit, RunOptions};
use crate::board::{Board, Status, Tally};
use crate::result::{BoardReport, Doubt, LinkReport, Problem, Reconnection, SoakReport, WithinReport};
use crate::target::BoardKind;

/// What went over earlier links, which broke.
#[derive(Default)]
pub(super) struct Earlier {
    pub(super) tally: Tally,
    pub(super) seconds: Duration,
}

/// What was found in one session, besides the checks and what was seen of frames.
#[derive(Default)]
pub(super) struct Attempt {
    /// Rows that the board should have counted since HELLO.
    pub(super) rows_counted: usize,
    /// The least number of rows that it should have counted as sent again.
    pub(super) repeats_counted: u32,
    /// Whether something was seen wrong that is not judged yet.
    pub(super) is_wrong: bool,
    /// Why the link may have caused it.
    pub(super) doubt: Option<Doubt>,
    /// Whether some counters were not compared only because the board, unlike the host, says that its link is poor.
    pub(super) leaves_counters_out: bool,
    /// Whether something was found wrong that no link can cause, whatever else the link did.
    pub(super) beyond_links: bool,
    /// Whether a board came back that has no serial number to identify it.
    pub(super) came_back_unnumbered: bool,
}

/// What a run has found so far.
pub(super) struct Findings {
    pub(super) board: BoardReport,
    pub(super) checks: Checks,
    pub(super) tally: Tally,
    pub(super) link: LinkReport,
    pub(super) earlier: Earlier,
    pub(super) attempt: Attempt,
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
            checks: Checks::new(),
            tally: Tally::default(),
            link,
            earlier: Earlier::default(),
            attempt: Attempt::default(),
            counters_doubted: false,
            bursts: 0,
            within: None,
            soak: None,
            misfit: None,
        }
    }

    /// Forgets what was found of the open board, for a look in another session. The number of bursts stays, so that none
    /// gets the name of an earlier one.
    pub(super) fn begin_again(&mut self) {
        self.attempt = Attempt::default();
        self.checks.begin_again();
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

    /// Notes the counts of a link that broke. If something was seen wrong before, nothing will show later what that link
    /// did, so a doubt is noted too.
    pub(super) fn keep_counts(&mut self, board: &Board) {
        if self.attempt.is_wrong {
            let doubt = Doubt::of_session(board).unwrap_or(Doubt::PacketsUncounted {});
            self.attempt.doubt.get_or_insert(doubt);
        }
        self.earlier.tally += board.tally();
        self.earlier.seconds += board.now();
        (self.attempt.rows_counted, self.attempt.repeats_counted) = (0, 0);
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
