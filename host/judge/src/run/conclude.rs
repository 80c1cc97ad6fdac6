//! From findings to the report.

use jiff::Timestamp;

use super::findings::{CHECKS, End, Findings};
use super::judge::{STREET, Seen};
use super::{Circumstances, Finished, Plan, RunOptions};
use crate::frames::street;
use crate::report::{Check, LinkReport, Outcome, Report, RunReport, StreetReport, Suspect, TablesReport};
use crate::target::BoardKind;
use crate::verdict::Cause;

/// How the run ended, in words.
struct Ending {
    cause: Cause,
    headline: String,
    remedy: Option<String>,
    suspects: Vec<Suspect>,
}

pub(super) fn conclude(
    plan: &Plan,
    mut findings: Findings,
    end: Option<End>,
    options: &RunOptions,
    started: Timestamp,
) -> Finished {
    let ending = ending(&mut findings, end);
    skip_the_rest(&mut findings.checks);
    let street = street(plan, &findings.seen);
    let (evidence, evidence_report) = findings.seen.evidence.finish();
    let report = Report {
        verdict: ending.cause.verdict(),
        cause: ending.cause,
        board: findings.board,
        headline: ending.headline,
        remedy: ending.remedy,
        suspects: ending.suspects,
        checks: findings.checks,
        frames: findings.seen.frames,
        latency: findings.seen.latency,
        street,
        evidence: evidence_report,
        link: LinkReport {
            bytes_out: findings.tally.bytes_out,
            bytes_in: findings.tally.bytes_in,
            packets_out: findings.tally.packets_out,
            packets_in: findings.tally.packets_in,
            damaged_in: findings.tally.damaged_in,
            retries: findings.tally.retries,
            line_errors: findings.tally.line_errors,
            ..findings.link
        },
        tables: tables(plan),
        run: run(plan, &options.circumstances, started),
    };
    Finished { report, evidence }
}

fn run(plan: &Plan, circumstances: &Circumstances, started: Timestamp) -> RunReport {
    let ended = Timestamp::now();
    RunReport {
        version: env!("CARGO_PKG_VERSION"),
        commit: crate::COMMIT,
        arguments: circumstances.arguments.clone(),
        seed: plan.seed,
        started: format!("{started:.0}"),
        ended: format!("{ended:.0}"),
        seconds: ended.duration_since(started).as_secs_f64(),
        host: host_name(),
        files: circumstances.files.clone(),
    }
}

fn ending(findings: &mut Findings, end: Option<End>) -> Ending {
    if let Some(end) = &end {
        findings.note(end.check());
    }
    match end {
        None if findings.seen.samples() == 0 => Ending {
            cause: Cause::NothingJudged,
            headline: "nothing was judged: no frame came back".to_owned(),
            remedy: Some("Name at least one frame, or none for the built-in ones.".to_owned()),
            suspects: Vec::new(),
        },
        None => Ending { cause: Cause::Equal, headline: pass(findings), remedy: None, suspects: Vec::new() },
        Some(End::Failed { headline, remedy, suspects, .. }) => {
            Ending { cause: Cause::Different, headline, remedy: Some(remedy), suspects }
        }
        Some(End::Error { cause, headline, remedy, .. }) => {
            let remedy = remedy.or_else(|| findings.tally.line_errors.advice().map(str::to_owned));
            Ending { cause, headline, remedy, suspects: Vec::new() }
        }
    }
}

fn pass(findings: &Findings) -> String {
    let seen = &findings.seen;
    let latency = seen.latency.map_or(0, |latency| latency.claimed);
    let untested = match findings.board.kind {
        BoardKind::Hardware => "",
        BoardKind::Mock => " (mock board: no hardware was tested)",
        BoardKind::Sim => " (simulated board: no hardware was tested)",
        BoardKind::Replay => " (recording: no hardware was tested now)",
    };
    format!(
        "{} frames, {} samples, all equal to the reference; every row takes {latency} pixel clocks{untested}",
        seen.frames.len(),
        seen.samples()
    ) + &match findings.link.reconnections.len() {
        0 => String::new(),
        times => format!("; the board went away and came back, {times} x"),
    }
}

fn skip_the_rest(checks: &mut Vec<Check>) {
    for name in CHECKS {
        if !checks.iter().any(|check| check.name == name) {
            checks.push(Check { name, outcome: Outcome::Skipped, detail: "not reached".to_owned() });
        }
    }
    checks.sort_by_key(|check| CHECKS.iter().position(|&name| name == check.name));
}

/// The built-in street, when it came back whole and was kept.
fn street(plan: &Plan, seen: &Seen) -> Option<StreetReport> {
    let street = seen
        .evidence
        .iter()
        .find(|evidence| seen.frames.get(evidence.index).is_some_and(|frame| frame.name == STREET))?;
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
        steps_crc32: crc(&plan.tables.to_bytes()),
        kernel_crc32: crc(&plan.kernel.to_bytes()),
    }
}

fn host_name() -> String {
    std::fs::read_to_string("/proc/sys/kernel/hostname")
        .map_or_else(|_| "unknown".to_owned(), |name| name.trim().to_owned())
}
