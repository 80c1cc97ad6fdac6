//! The report as lines of text, for views without a table.

use super::{mark, not_exercised, remedy, technician, verdict_line};
use crate::result::{Report, Suspect};
use crate::verdict::Verdict;
use crate::words::plain;

/// The verdict, every check, what was not exercised and what to do, one line each.
#[must_use]
pub fn summary(report: &Report) -> String {
    let mut lines = vec![verdict_line(report)];
    lines.extend(report.checks.iter().map(|check| {
        format!("{:<8} {:<13} {}", mark(check.outcome), check.name, plain(&check.finding.sentence()))
    }));
    lines.extend(not_exercised(report));
    lines.extend(advice(report));
    lines.join("\n")
}

/// The suspects and what to do, one line each.
pub(in crate::report) fn advice(report: &Report) -> Vec<String> {
    let said = |suspect: &Suspect| {
        [
            format!("{}: {}", suspect.place(), suspect.evidence()),
            format!("At the bench: {}", suspect.technician()),
            format!("Next: {}", suspect.designer()),
        ]
    };
    let bench = technician(report);
    let next = remedy(report).map(|remedy| if bench.is_some() { format!("Next: {remedy}") } else { remedy });
    let bench = bench.map(|technician| format!("At the bench: {technician}"));
    let lines = report.suspects.iter().flat_map(said).chain(bench).chain(next);
    lines.map(|line| plain(&line).into_owned()).collect()
}

/// The codes for `halfrow explain`: the finding's and those of the suspects, each once; none for a PASS.
#[must_use]
pub fn codes(report: &Report) -> Vec<String> {
    if report.verdict() == Verdict::Pass {
        return Vec::new();
    }
    let mut codes = vec![report.finding.code()];
    for suspect in &report.suspects {
        let (code, _) = suspect.defect.tagged();
        if !codes.contains(&code) {
            codes.push(code);
        }
    }
    codes
}
