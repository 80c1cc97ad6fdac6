//! Makes the report from the findings.

use std::time::Instant;

use jiff::Timestamp;

use super::end::End;
use super::finished::Finished;
use crate::coverage::Faults;
use crate::frames::street;
use crate::result::{
    BoardReport, CheckName, CoverageReport, Finding, FrameTotals, LinkReport, NotExercised, Problem, Report,
    RunReport, Schema, SoakReport, StreetReport, Suspect, TablesReport, wording,
};
use crate::run::Findings;
use crate::run::frames::observations::Observations;
use crate::run::{Plan, Provenance, RunOptions};
use crate::verdict::Cause;

/// When a run began.
#[derive(Clone, Copy)]
pub(crate) struct Begun {
    /// By the computer's clock, which may be set during the run.
    at: Timestamp,
    /// By a monotonic clock.
    since: Instant,
}

impl Begun {
    pub(crate) fn now() -> Self {
        Self { at: Timestamp::now(), since: Instant::now() }
    }
}

/// How the run ended.
struct Ending {
    cause: Cause,
    finding: Finding,
    suspects: Vec<Suspect>,
    /// What was not exercised of a board that is right.
    not_exercised: Vec<NotExercised>,
}

pub(crate) fn conclude(
    plan: &Plan,
    mut findings: Findings,
    seen: Observations,
    link: LinkReport,
    ended: Result<Vec<NotExercised>, End>,
    options: &RunOptions,
    begun: Begun,
) -> Finished {
    if let Err(end) = &ended {
        findings.checks.ended(end);
    }
    let Ending { cause, finding, suspects, not_exercised } = ending(ended, &findings.board, &link, &seen);
    let street = street(plan, &seen);
    let coverage = if cause == Cause::Equal { coverage(plan, &findings) } else { None };
    let (evidence, evidence_report) = seen.evidence.finish();
    let report = Report {
        schema: Schema,
        cause,
        board: findings.board,
        finding,
        suspects,
        checks: findings.checks.all(|name| left_out(name, plan)),
        not_exercised,
        frames: seen.frames,
        latency: seen.latency,
        street,
        within: findings.within,
        coverage,
        soak: findings.soak.or_else(|| plan.at_speed.soak().map(SoakReport::new)),
        evidence: evidence_report,
        lacks: Vec::new(),
        link,
        tables: tables(plan),
        run: run(plan, &options.provenance, begun),
    };
    Finished { report, evidence }
}

/// How many of the faults measured in a board of this build the run finds.
fn coverage(plan: &Plan, findings: &Findings) -> Option<CoverageReport> {
    let build = &findings.board.identity.as_ref()?.build;
    let faults = Faults::all().inspect_err(|error| tracing::warn!("no coverage is told: {error}")).ok()?;
    faults.whole(plan, build)
}

fn run(plan: &Plan, provenance: &Provenance, Begun { at, since }: Begun) -> RunReport {
    RunReport {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        commit: crate::COMMIT.to_owned(),
        arguments: provenance.arguments.clone(),
        seed: plan.seed,
        started: format!("{at:.0}"),
        ended: format!("{:.0}", Timestamp::now()),
        seconds: since.elapsed().as_secs_f64(),
        host: host_name(),
        operator: provenance.operator.clone(),
        files: provenance.files.clone(),
    }
}

fn ending(
    ended: Result<Vec<NotExercised>, End>,
    board: &BoardReport,
    link: &LinkReport,
    seen: &Observations,
) -> Ending {
    let nothing = Ending {
        cause: Cause::NothingJudged,
        finding: Finding::NothingJudged {},
        suspects: Vec::new(),
        not_exercised: Vec::new(),
    };
    match ended {
        Ok(_) if seen.samples() == 0 => nothing,
        Ok(not_exercised) => {
            Ending { cause: Cause::Equal, finding: pass(board, link, seen), not_exercised, ..nothing }
        }
        Err(End::Failed { finding, suspects, .. }) => {
            Ending { cause: Cause::Different, finding, suspects, ..nothing }
        }
        Err(End::Error { cause, finding, .. }) => {
            Ending { cause, finding: broken_off(finding, seen), ..nothing }
        }
    }
}

/// Why the run broke off, after what was wrong with rows and was then not looked into.
fn broken_off(why: Finding, seen: &Observations) -> Finding {
    let FrameTotals { frames, differing_frames, samples, differences } = seen.totals();
    let Finding::Problem(problem) = why else { return why };
    let wrong = if differing_frames > 0 {
        wording::samples_differ((differences, samples), (differing_frames, frames))
    } else if let Some(wrong) = seen.wrong_beside_samples() {
        wrong.sentence()
    } else {
        return Finding::Problem(problem);
    };
    let message = wording::broken_off(&wrong, &problem.message);
    Finding::Problem(Box::new(Problem { message, ..*problem }))
}

fn pass(board: &BoardReport, link: &LinkReport, seen: &Observations) -> Finding {
    Finding::AllRight {
        frames: seen.frames.len(),
        samples: seen.samples(),
        latency: seen.latency.map_or(0, |latency| latency.claimed),
        board: board.kind,
        reconnections: link.reconnections.len(),
    }
}

/// Why a check was not made.
fn left_out(name: CheckName, plan: &Plan) -> Finding {
    match name {
        CheckName::Rules if !plan.tries_rules() => Finding::RulesLeftOut {},
        _ => Finding::NotReached {},
    }
}

/// The edges of the built-in street, when it was streamed whole, came back whole, and was kept.
fn street(plan: &Plan, seen: &Observations) -> Option<StreetReport> {
    let street = seen.evidence.pinned()?;
    seen.frames.get(street.index).filter(|frame| frame.rows == street.expected.height())?;
    Some(StreetReport {
        before: street::edge_deviation(&street.input, &plan.scene(0))?,
        after: street::edge_deviation(&street.found, &plan.scene(0))?,
    })
}

fn tables(plan: &Plan) -> TablesReport {
    let geometry = plan.tables.geometry();
    let crc = |bytes: &[u8]| format!("{:08x}", crc32fast::hash(bytes));
    TablesReport {
        source: plan.tables_source.clone(),
        width: geometry.width(),
        height: geometry.height(),
        bits: geometry.depth().bits(),
        centre2: geometry.centre2(),
        rows_outside_circle: plan.rows_outside_circle,
        tables_crc32: crc(&plan.tables.to_bytes()),
        kernel_crc32: crc(&plan.kernel.to_bytes()),
    }
}

fn host_name() -> String {
    std::fs::read_to_string("/proc/sys/kernel/hostname")
        .map_or_else(|_| "unknown".to_owned(), |name| name.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::sessions::Sessions;
    use crate::target::BoardKind;

    /// However it came about, since no plan that is let through asks for it.
    #[test]
    fn a_run_in_which_nothing_came_back_is_no_pass() {
        let findings = Findings::new("mock".to_owned(), BoardKind::Mock);
        let link = Sessions::new(&RunOptions::default(), "mock".to_owned(), None).report();
        let Ending { cause, finding, .. } =
            ending(Ok(Vec::new()), &findings.board, &link, &Observations::default());
        assert_eq!((cause, finding), (Cause::NothingJudged, Finding::NothingJudged {}));
    }
}
