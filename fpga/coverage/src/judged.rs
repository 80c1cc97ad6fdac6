//! One board with one fault, judged by the whole run and by parts of it.

use anyhow::Result;
use halfrow::link::WireLink;
use halfrow::progress::Silent;
use halfrow::result::{CheckName, Finding, FrameReport, Outcome, Report};
use halfrow::run::{Part, Selection};
use halfrow::target::BoardKind;
use halfrow::{Candidate, Plan, RunOptions, Verdict};
use halfrow_pipe::{Pipe, PipeOptions};
use halfrow_sim::FaultyBoard;
use serde::Serialize;

/// Draws what registers and memories hold at power-up.
const SEED: u32 = 1;
/// Clocks after the last byte after which a board is taken to hang: more than a burst that uses up all records takes at the
/// sizes that are judged.
const PATIENCE: u32 = 400_000;

/// How a board with a fault was judged.
#[derive(Serialize)]
pub(crate) struct FaultVerdict {
    fault: u16,
    verdict: Verdict,
    /// The code of the verdict's finding.
    finding: String,
    /// Every check that did not pass, in the order of the run.
    checks: Vec<CheckName>,
    /// The numbers of the streamed frames that differ, each with its first differing row.
    frames: Vec<(u16, usize)>,
    /// Whether the smallest selection of parts finds it.
    least: bool,
    /// Whether frames at speed alone find it.
    at_speed: bool,
    /// Whether corners alone find it.
    corners: bool,
    /// Whether the wire's rules alone find it.
    rules: bool,
    /// How long the whole run took, in seconds of wall-clock time.
    seconds: f64,
}

/// Judges the board with this fault, 0 for none, by `plan` and, if that finds the fault, by parts of it.
pub(crate) fn judge(plan: &Plan, board: &mut FaultyBoard, fault: u16) -> Result<FaultVerdict> {
    let whole = report(plan, board, fault)?;
    let mut by = |selection: Selection, is_asked: bool| {
        let plan = Plan { selection: Some(selection), ..plan.clone() };
        is_asked.then(|| report(&plan, board, fault)).transpose()
    };
    let least = by(Selection::least(), whole.verdict() != Verdict::Pass)?.is_some_and(|part| is_found(&part));
    // A board that hangs would take minutes each time, so only a FAIL is judged by parts.
    let is_asked = whole.verdict() == Verdict::Fail && !least;
    let at_speed = by(Selection::all([Part::AtSpeed]), is_asked)?.is_some_and(|part| is_found(&part));
    let corners = by(Selection::all([Part::Corners]), is_asked)?.is_some_and(|part| is_in_corner(&part));
    let rules = by(Selection::all([Part::Rules]), is_asked)?.is_some_and(|part| is_found(&part));
    Ok(FaultVerdict {
        fault,
        verdict: whole.verdict(),
        finding: whole.finding.code(),
        checks: not_passed(&whole),
        frames: whole.frames.iter().filter_map(first_that_differs).collect(),
        least,
        at_speed,
        corners,
        rules,
        seconds: whole.run.seconds,
    })
}

fn report(plan: &Plan, board: &mut FaultyBoard, fault: u16) -> Result<Report> {
    let pipe = Pipe::new(board.switch_on(fault, SEED, PATIENCE), PipeOptions::default(), None);
    let link = WireLink::new(pipe, "the board with a fault", false);
    let candidate = Candidate::new("fault", BoardKind::Sim, link);
    Ok(halfrow::verify(plan, candidate, &RunOptions::default(), &Silent)?.report)
}

fn is_found(report: &Report) -> bool {
    report.verdict() != Verdict::Pass
}

fn not_passed(report: &Report) -> Vec<CheckName> {
    let not_passed = |outcome| matches!(outcome, Outcome::Failed | Outcome::Error);
    report.checks.iter().filter(|check| not_passed(check.outcome)).map(|check| check.name).collect()
}

fn first_that_differs(frame: &FrameReport) -> Option<(u16, usize)> {
    Some((frame.number, frame.comparison.first.as_ref()?.row))
}

/// Whether it was found in a corner. The run tries corners only after the frames at speed.
fn is_in_corner(report: &Report) -> bool {
    matches!(report.finding, Finding::InCorner { .. })
}
