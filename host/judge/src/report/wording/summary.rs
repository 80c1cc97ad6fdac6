//! The report as lines of text, for views without a table.

use super::{mark, not_exercised, remedy, technician, verdict_line};
use crate::result::{Report, Suspect};
use crate::verdict::Verdict;
use crate::words::plain;

/// The verdict, every check, what was not exercised, what could not be written and what to do, one line each.
#[must_use]
pub fn summary(report: &Report) -> String {
    let mut lines = vec![verdict_line(report)];
    lines.extend(report.checks.iter().map(|check| {
        format!("{:<8} {:<13} {}", mark(check.outcome), check.name, plain(&check.finding.sentence()))
    }));
    lines.extend(not_exercised(report));
    lines.extend(lacks(report));
    lines.extend(advice(report));
    lines.join("\n")
}

/// What was asked for and could not be written, one sentence each, without a full stop.
pub(in crate::report) fn lacks(report: &Report) -> Vec<String> {
    report.lacks.iter().map(|lack| plain(&lack.sentence()).into_owned()).collect()
}

/// The suspects and what to do, one line each.
pub(in crate::report) fn advice(report: &Report) -> Vec<String> {
    let said = |suspect: &Suspect| {
        let [evidence, bench, next] = of_suspect(suspect);
        [format!("{}: {evidence}", suspect.place()), bench, next]
    };
    let lines = report.suspects.iter().flat_map(said).chain(what_to_do(report));
    lines.map(|line| plain(&line).into_owned()).collect()
}

/// What to do besides what the suspects say, in up to two lines.
#[must_use]
pub fn what_to_do(report: &Report) -> Vec<String> {
    bench_then_next(technician(report), remedy(report))
}

/// What a technician does at the `bench`, then what is `next` for a designer, in up to two lines. What is next alone is for both,
/// and stands as it is.
#[must_use]
pub fn bench_then_next(bench: Option<String>, next: Option<String>) -> Vec<String> {
    let next = next.map(|remedy| if bench.is_some() { format!("Next: {remedy}") } else { remedy });
    bench.map(|technician| format!("At the bench: {technician}")).into_iter().chain(next).collect()
}

/// What speaks against a suspect, what a technician does about it, and what is next for a designer.
#[must_use]
pub fn of_suspect(suspect: &Suspect) -> [String; 3] {
    [
        suspect.evidence(),
        format!("At the bench: {}", suspect.technician()),
        format!("Next: {}", suspect.designer()),
    ]
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
