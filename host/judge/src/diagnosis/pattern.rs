//! Where differences lie, in words, for when no defect explains them.

use super::witnesses::{Witness, Witnesses};
use crate::report::{FrameReport, Suspect};

/// Where the differences lie.
pub(super) fn summary(witnesses: &Witnesses<'_>) -> Suspect {
    let frames: Vec<_> =
        witnesses.case.frames.iter().filter(|frame| frame.comparison.differences > 0).collect();
    let clauses: Vec<_> = [
        rows(witnesses, &frames),
        columns(&frames),
        sizes(&frames),
        brightness(&witnesses.differing),
        Some(format!("in {} of {} frames", frames.len(), witnesses.case.frames.len())),
    ]
    .into_iter()
    .flatten()
    .collect();
    Suspect {
        part: "unknown",
        place: "no single part".to_owned(),
        evidence: format!("no known defect explains most of the differences: {}", clauses.join(", ")),
        next_step: "Make a report and look at the difference maps.".to_owned(),
        explained: 0.0,
    }
}

fn rows(witnesses: &Witnesses<'_>, frames: &[&FrameReport]) -> Option<String> {
    let height = frames.iter().map(|frame| frame.comparison.by_row.len()).max()?;
    extent("row", &witnesses.rows, height)
}

fn columns(frames: &[&FrameReport]) -> Option<String> {
    let width = frames.iter().map(|frame| frame.comparison.by_column.len()).max()?;
    let counted =
        |frame: &FrameReport, column| frame.comparison.by_column.get(column).is_some_and(|&n| n > 0);
    let differs = |column: &usize| frames.iter().any(|frame| counted(frame, *column));
    let columns: Vec<_> = (0..width).filter(differs).collect();
    extent("column", &columns, width)
}

/// Which of `total` rows or columns: `places` ascend.
fn extent(name: &str, places: &[usize], total: usize) -> Option<String> {
    let (&first, &last) = (places.first()?, places.last()?);
    let parity = |parity| places.iter().all(|place| place % 2 == parity);
    Some(match places.len() {
        1 => format!("all in {name} {first}"),
        count if count == total => format!("in every {name}"),
        count if count == last - first + 1 && last + 1 == total => {
            format!("in every {name} from {first} on")
        }
        count if count == last - first + 1 => format!("in {name}s {first} to {last}"),
        count if parity(0) => format!("in {count} {name}s, all even"),
        count if parity(1) => format!("in {count} {name}s, all odd"),
        count => format!("in {count} of {total} {name}s, {first} to {last}"),
    })
}

fn sizes(frames: &[&FrameReport]) -> Option<String> {
    let extremes = || frames.iter().filter_map(|frame| frame.comparison.extremes);
    let (least, most) = (extremes().map(|e| e.0).min()?, extremes().map(|e| e.1).max()?);
    Some(match (least, most) {
        (-1, 1) => "off by one either way".to_owned(),
        _ if least == most => format!("all off by {least:+}"),
        _ => format!("off by {least:+} to {most:+}"),
    })
}

/// Whether only the bright or only the dark samples of the reference differ.
fn brightness(differing: &[Witness<'_>]) -> Option<String> {
    let half = differing.first()?.geometry().depth().max() / 2;
    let bright = |row: &Witness<'_>, bright: bool| {
        row.differing_columns().all(|column| row.expected.get(column).is_some_and(|&e| (e > half) == bright))
    };
    let all = |wanted| differing.iter().all(|row| bright(row, wanted));
    match (all(true), all(false)) {
        (true, false) => Some("only in samples of half the range and above".to_owned()),
        (false, true) => Some("only in samples below half the range".to_owned()),
        _ => None,
    }
}
