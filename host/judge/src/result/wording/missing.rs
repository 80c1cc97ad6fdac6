//! Words for a row that did not come back.

use crate::result::{Finding, MissingRow};

/// The sentence of a finding on a row that is missing, if it is one.
pub(super) fn sentence(finding: &Finding) -> Option<String> {
    let (row, frame, seen) = match finding {
        Finding::RowLostOnce { row, frame } => (
            row,
            frame,
            "when it was streamed again, the whole frame came back; check cable and connectors, and run again"
                .to_owned(),
        ),
        Finding::RowLostAmongOthers { row, frame } => (
            row,
            frame,
            "when it was streamed again, other packets were lost or late as well, so the link may be the cause; check cable, \
             connectors and rate"
                .to_owned(),
        ),
        Finding::RowLostEachTime(MissingRow { row, frame, waits_for }) => (row, frame, alone(*waits_for)),
        _ => return None,
    };
    Some(format!(
        "row {row} of frame {frame} did not come back, although it was asked for again and again; {seen}"
    ))
}

fn alone(waits_for: Option<u32>) -> String {
    let (says, part) = match waits_for {
        Some(row) => (format!("the board still waited for row {row}"), format!("takes in row {row}")),
        None => ("the board says that it took every row".to_owned(), "sends this row".to_owned()),
    };
    format!(
        "each time that its frame was streamed again, this row alone was missing, and {says}; a poor cable does not choose one row; \
         check how the board {part}, and whether something on the way swallows certain bytes or lengths"
    )
}

/// What to do about it.
pub(super) fn remedy(finding: &Finding) -> Option<&'static str> {
    Some(match finding {
        Finding::RowLostOnce { .. } => "Check cable and connectors, and run again.",
        Finding::RowLostAmongOthers { .. } => "Check cable, connectors and rate.",
        Finding::RowLostEachTime(_) => {
            "Check what the board does with this row, and whether something on the way swallows certain bytes or lengths."
        }
        _ => return None,
    })
}
