//! Boards judged in this process, by the library's own run without the program around it.

use std::time::Duration;

use halfrow::link::{self, Candidate};
use halfrow::progress::Silent;
use halfrow::result::{CheckName, Outcome, Report};
use halfrow::run::{AtSpeed, Build, Part, Plan, Provenance, RunOptions, Selection, SessionIds, Vary, verify};
use halfrow::target::Target;
use halfrow_model::{BitDepth, Equidistant, Geometry, Interpolant, Kernel, TableSet};

use crate::late_host::LateHost;

/// A lens, the size of its frames, and the mock board that is built for it.
#[derive(Clone, Copy, Debug)]
pub struct System {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Radius at which the lens images 90° from its axis, in pixels.
    pub radius: f64,
    /// The board's target.
    pub board: &'static str,
    /// M, the samples that the board's line memory holds.
    pub ring: usize,
}

impl System {
    /// The paper's system: 1920 × 1080 samples.
    pub const PAPER: Self = Self { width: 1920, height: 1080, radius: 1106.697, board: "mock", ring: 2048 };

    /// The paper's lens at 2/15 of the size. A row fills the line memory, so that all of its address lines matter.
    pub const SMALL: Self = Self {
        width: 256,
        height: 144,
        radius: 147.56,
        board: "mock,max-width=256,max-height=144",
        ring: 256,
    };

    /// As small as rows may be, for thousands of runs.
    pub const TINY: Self = Self { width: 64, height: 8, radius: 10.0, board: "mock", ring: 2048 };

    /// As short as a run may be, for one run at each packet of a run.
    pub const TINIEST: Self = Self { height: 1, ..Self::TINY };

    /// The report on the board whose target has `options` appended. The run streams the built-in frames and ends with the first
    /// that differs.
    ///
    /// # Panics
    /// If there is no such board.
    #[must_use]
    pub fn judge(&self, options: &str) -> Report {
        self.judge_at(&format!("{}{options}", self.board))
    }

    /// The report on the board that `target` leads to.
    ///
    /// # Panics
    /// If there is no such board.
    #[must_use]
    pub fn judge_at(&self, target: &str) -> Report {
        self.judge_patiently(target, None)
    }

    /// Like [`Self::judge_at`], going on when the board goes away for less than `patience`.
    ///
    /// # Panics
    /// If there is no such board.
    #[must_use]
    pub fn judge_patiently(&self, target: &str, patience: Option<Duration>) -> Report {
        self.judge_by(patience, open(target))
    }

    /// The report on this system's board with `options`, for a host that stands still for `pause` each time it reads the clock
    /// for the `every`-th time.
    ///
    /// # Panics
    /// If there is no such board.
    #[must_use]
    pub fn judge_late(&self, options: &str, every: u32, pause: Duration) -> Report {
        let candidate = open(&format!("{}{options}", self.board));
        let link = Box::new(LateHost::new(candidate.link, every, pause));
        let candidate = Candidate { link, ..candidate };
        self.judge_candidate(candidate)
    }

    /// The report on a board whose link is already made.
    ///
    /// # Panics
    /// If the board cannot have what the plan uploads.
    #[must_use]
    pub fn judge_candidate(&self, candidate: Candidate) -> Report {
        self.judge_by(None, candidate)
    }

    fn judge_by(&self, reconnect: Option<Duration>, candidate: Candidate) -> Report {
        judge_reconnecting(&self.plan(), reconnect, candidate)
    }

    /// The plan: the built-in frames, up to the first that differs.
    ///
    /// # Panics
    /// If there is no such lens.
    #[must_use]
    pub fn plan(&self) -> Plan {
        let lens = Equidistant::from_radius(self.radius).unwrap();
        let geometry = Geometry::centred(self.width, self.height, BitDepth::Twelve).unwrap();
        let tables = TableSet::from_lens(geometry, &lens, None).unwrap();
        let plan = Plan::new(tables, Kernel::from(Interpolant::Hermite)).seen_through(lens);
        Plan { fail_fast: true, ..plan }
    }
}

/// The same plan with streamed frames only: no frames that the board makes by itself, and no rules.
#[must_use]
pub fn streamed(plan: Plan) -> Plan {
    let all = plan.clone().varying(Vary { centre: true, depth: true }).parts(&Build::full(2048));
    let streamed =
        all.into_iter().filter(|part| !matches!(part, Part::AtSpeed | Part::Corners | Part::Rules));
    Plan { at_speed: AtSpeed::Off, selection: Some(Selection::all(streamed)), ..plan }
}

/// The report on a board by this plan.
///
/// # Panics
/// If the board cannot have what the plan uploads.
#[must_use]
pub fn judge_by_plan(plan: &Plan, candidate: Candidate) -> Report {
    judge_reconnecting(plan, None, candidate)
}

/// The report on a board by this plan, if it is waited for so long when its link breaks.
///
/// # Panics
/// Like [`judge_by_plan`].
#[must_use]
pub fn judge_reconnecting(plan: &Plan, reconnect: Option<Duration>, candidate: Candidate) -> Report {
    // Fixed, so that every run sends the same packets.
    let session_ids = SessionIds { nonce: 0, host: 0, sequence: 0 };
    let provenance = Provenance { session_ids, ..Provenance::default() };
    let options = RunOptions { reconnect, provenance, ..RunOptions::default() };
    verify(plan, candidate, &options, &Silent).unwrap().report
}

/// The board that `target` leads to.
///
/// # Panics
/// If there is no such board.
#[must_use]
pub fn open(target: &str) -> Candidate {
    let target: Target = target.parse().unwrap();
    link::open(&target).unwrap()
}

/// The check that found the board wrong, if one did.
#[must_use]
pub fn failed_check(report: &Report) -> Option<CheckName> {
    report.checks.iter().find(|check| check.outcome == Outcome::Failed).map(|check| check.name)
}
