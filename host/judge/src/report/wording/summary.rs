//! The report in lines, for views without a table.

use super::{mark, not_exercised, plain, remedy, verdict_line};
use crate::result::{Report, Suspect};

/// The verdict with every check and what to do, a line each: for views without a table.
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

/// Who is suspected and what to do, a line each.
pub(in crate::report) fn advice(report: &Report) -> Vec<String> {
    let said = |suspect: &Suspect| {
        let (part, place) = (suspect.part(), suspect.place());
        [
            format!("{part}, {place}: {}", suspect.evidence()),
            format!("At the bench: {}", suspect.technician()),
            format!("Next: {}", suspect.designer()),
        ]
    };
    let lines = report.suspects.iter().flat_map(said).chain(remedy(report));
    lines.map(|line| plain(&line).into_owned()).collect()
}
