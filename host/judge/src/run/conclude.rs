//! Makes the report from the findings.

use std::time::Instant;

use jiff::Timestamp;

use super::findings::{End, Findings};
use super::observations::Observations;
use super::row_judge::STREET;
use super::{Finished, Plan, Provenance, RunOptions};
use crate::board::Tally;
use crate::coverage::Faults;
use crate::frames::street;
use crate::result::{
    Check, CheckName, CoverageReport, Finding, FrameReport, FrameTotals, LinkReport, Outcome, Problem,
    Report, RunReport, Schema, SoakReport, StreetReport, Suspect, TablesReport, wording,
};
use crate::verdict::Cause;

/// When a run began.
#[derive(Clone, Copy)]
pub(super) struct Begun {
    /// By the computer's clock, which may be set during the run.
    at: Timestamp,
    /// By a monotonic clock.
    since: Instant,
}

impl Begun {
    pub(super) fn now() -> Self {
        Self { at: Timestamp::now(), since: Instant::now() }
    }
}

/// How the run ended.
struct Ending {
    cause: Cause,
    finding: Finding,
    suspects: Vec<Suspect>,
}

pub(super) fn conclude(
    plan: &Plan,
    mut findings: Findings,
    end: Option<End>,
    options: &RunOptions,
    begun: Begun,
) -> Finished {
    let ending = ending(&mut findings, end);
    skip_the_rest(&mut findings.checks, plan);
    let street = street(plan, &findings.look.seen);
    let is_pass = ending.cause == Cause::Equal;
    let coverage = if is_pass { coverage(plan, &findings) } else { None };
    let not_exercised = if is_pass { findings.look.not_exercised } else { Vec::new() };
    let (evidence, evidence_report) = findings.look.seen.evidence.finish();
    let report = Report {
        schema: Schema,
        cause: ending.cause,
        board: findings.board,
        finding: ending.finding,
        suspects: ending.suspects,
        checks: findings.checks,
        not_exercised,
        frames: findings.look.seen.frames,
        latency: findings.look.seen.latency,
        street,
        within: findings.within,
        coverage,
        soak: findings.soak.or_else(|| plan.at_speed.soak().map(SoakReport::new)),
        evidence: evidence_report,
        lacks: Vec::new(),
        link: link(findings.link, &findings.tally),
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

fn link(known: LinkReport, tally: &Tally) -> LinkReport {
    LinkReport {
        bytes_out: tally.bytes_out,
        bytes_in: tally.bytes_in,
        packets_out: tally.packets_out,
        packets_in: tally.packets_in,
        damaged_in: tally.damaged_in,
        retries: tally.retries,
        late: tally.late,
        strays: tally.strays,
        line_errors: tally.line_errors,
        ..known
    }
}

fn ending(findings: &mut Findings, end: Option<End>) -> Ending {
    if let Some(end) = &end {
        findings.note_end(end);
    }
    match end {
        None if findings.look.seen.samples() == 0 => {
            Ending { cause: Cause::NothingJudged, finding: Finding::NothingJudged {}, suspects: Vec::new() }
        }
        None => Ending { cause: Cause::Equal, finding: pass(findings), suspects: Vec::new() },
        Some(End::Failed { finding, suspects, .. }) => Ending { cause: Cause::Different, finding, suspects },
        Some(End::Error { cause, finding, .. }) => {
            Ending { cause, finding: broken_off(finding, &findings.look.seen), suspects: Vec::new() }
        }
    }
}

/// Why the run broke off, after the differences that were then not looked into.
fn broken_off(why: Finding, seen: &Observations) -> Finding {
    let FrameTotals { frames, differing_frames, samples, differences } = seen.totals();
    let Finding::Problem(problem) = why else { return why };
    if differing_frames == 0 {
        return Finding::Problem(problem);
    }
    let (samples, frames) = ((differences, samples), (differing_frames, frames));
    let message = wording::broken_off(samples, frames, &problem.message);
    Finding::Problem(Box::new(Problem { message, ..*problem }))
}

fn pass(findings: &Findings) -> Finding {
    let seen = &findings.look.seen;
    Finding::AllRight {
        frames: seen.frames.len(),
        samples: seen.samples(),
        latency: seen.latency.map_or(0, |latency| latency.claimed),
        board: findings.board.kind,
        reconnections: findings.link.reconnections.len(),
    }
}

fn skip_the_rest(checks: &mut Vec<Check>, plan: &Plan) {
    for name in CheckName::ALL {
        if !checks.iter().any(|check| check.name == name) {
            let finding = match name {
                CheckName::Rules if !plan.tries_rules() => Finding::RulesLeftOut {},
                _ => Finding::NotReached {},
            };
            checks.push(Check { name, outcome: Outcome::Skipped, finding, seconds: 0.0 });
        }
    }
    checks.sort_by_key(|check| check.name);
}

/// The edges of the built-in street, when it was streamed whole, came back whole, and was kept.
fn street(plan: &Plan, seen: &Observations) -> Option<StreetReport> {
    let street = seen.evidence.all().iter().find(|evidence| {
        let is_whole =
            |frame: &FrameReport| frame.first_rows.is_none() && frame.rows == evidence.expected.height();
        seen.frames.get(evidence.index).is_some_and(|frame| frame.name == STREET && is_whole(frame))
    })?;
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
