//! One board with one fault, judged.

use anyhow::Result;
use halfrow::link::WireLink;
use halfrow::progress::Silent;
use halfrow::result::{CheckName, Outcome};
use halfrow::target::BoardKind;
use halfrow::{Candidate, Plan, RunOptions, Verdict};
use halfrow_pipe::{Pipe, PipeOptions};
use halfrow_sim::FaultyBoard;
use serde::Serialize;

/// What registers and memories hold at power-up is drawn by this number.
const SEED: u32 = 1;
/// Clocks behind the last byte after which a board hangs: more than a burst of all its records takes at the sizes that are judged.
const PATIENCE: u32 = 400_000;

/// How a board with a fault was judged.
#[derive(Serialize)]
pub(crate) struct Judged {
    fault: u16,
    verdict: Verdict,
    /// The code of the verdict's finding.
    finding: String,
    /// Every check that did not pass, the first one first.
    checks: Vec<CheckName>,
    /// The streamed frames that differ, by number.
    frames: Vec<u16>,
    /// How long the run took by the wall's clock.
    seconds: f64,
}

/// Judges the board with this fault, 0 for none.
pub(crate) fn judge(plan: &Plan, board: &mut FaultyBoard, fault: u16) -> Result<Judged> {
    let board = board.switch_on(fault, SEED, PATIENCE);
    let pipe = Pipe::new(board, PipeOptions::default(), None);
    let link = WireLink::new(pipe, "the board with a fault", false);
    let candidate = Candidate::new("fault", BoardKind::Sim, link);
    let report = halfrow::verify(plan, candidate, &RunOptions::default(), &Silent)?.report;
    let not_passed = |outcome| matches!(outcome, Outcome::Failed | Outcome::Error);
    Ok(Judged {
        fault,
        verdict: report.verdict,
        finding: report.finding.code(),
        checks: report
            .checks
            .iter()
            .filter(|check| not_passed(check.outcome))
            .map(|check| check.name)
            .collect(),
        frames: report
            .frames
            .iter()
            .filter(|frame| frame.comparison.differences > 0)
            .map(|frame| frame.number)
            .collect(),
        seconds: report.run.seconds,
    })
}
