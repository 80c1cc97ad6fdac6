//! What a run has found so far, and the report made of it.

mod checks;
pub(super) mod conclude;
mod end;
pub(super) mod exercised;
pub(super) mod finished;
pub(super) mod levels;

use std::mem;

use crate::board::Board;
use crate::result::{BoardReport, CheckName, Doubt, Problem, SoakReport, WithinReport};
use crate::run::Misfit;
use crate::target::BoardKind;
use crate::verdict::Cause;
use checks::Checks;

pub(super) use end::{During, End};

/// What was found since the run, or its last second look, began, besides the checks and what was seen of frames.
#[derive(Default)]
pub(crate) struct Attempt {
    /// Rows that the board should have counted since HELLO.
    pub(crate) rows_counted: usize,
    /// The least number of rows that it should have counted as sent again.
    pub(crate) repeats_counted: u32,
    /// Whether something was seen wrong that is not judged yet.
    pub(crate) seen_wrong: bool,
    /// Why the link may have caused it.
    pub(crate) doubt: Option<Doubt>,
    /// Whether the board refused something amid the frames, after rows that were wrong. It counts that refusal.
    pub(crate) refused: bool,
    /// Whether some counters were not compared only because the board, unlike the host, says that its link is poor.
    pub(crate) leaves_counters_out: bool,
    /// Whether a board came back that has no serial number to identify it.
    pub(crate) came_back_unnumbered: bool,
}

/// What a run has found so far.
pub(crate) struct Findings {
    pub(crate) board: BoardReport,
    pub(crate) checks: Checks,
    pub(crate) attempt: Attempt,
    /// What was taken of a run that must keep within a time; none for any other run.
    pub(crate) within: Option<WithinReport>,
    /// The result of a soak; none for any other run.
    pub(crate) soak: Option<SoakReport>,
    /// Why the board cannot take what the plan uploads, if it cannot.
    pub(crate) misfit: Option<Misfit>,
}

impl Attempt {
    /// Notes that the link to `board` broke. If something was seen wrong before, nothing will show later what that link did, so
    /// a doubt is noted too.
    pub(crate) fn link_broke(&mut self, board: &Board) {
        if self.seen_wrong {
            let doubt = Doubt::of_session(board).unwrap_or(Doubt::PacketsUncounted {});
            self.doubt.get_or_insert(doubt);
        }
        (self.rows_counted, self.repeats_counted) = (0, 0);
    }
}

impl Findings {
    pub(crate) fn new(target: String, kind: BoardKind) -> Self {
        Self {
            board: BoardReport { kind, target, identity: None },
            checks: Checks::new(),
            attempt: Attempt::default(),
            within: None,
            soak: None,
            misfit: None,
        }
    }

    /// Forgets what was found of the open board, for a look in another session.
    pub(crate) fn begin_again(&mut self) {
        self.attempt = Attempt::default();
        self.checks.begin_again();
    }

    /// Notes that the board cannot take what the plan uploads, which ends the run without a report.
    pub(crate) fn refuse(&mut self, misfit: Misfit) -> End {
        let end = End::error(CheckName::Identity, Cause::Refused, Problem::of(&misfit));
        self.misfit = Some(misfit);
        end
    }

    /// Notes what the board says about itself.
    pub(crate) fn note_identity(&mut self, board: &Board) {
        self.board = BoardReport::of(
            &board.welcome,
            &board.capabilities,
            self.board.kind,
            mem::take(&mut self.board.target),
        );
    }
}
