//! The sentences of findings on a row that did not come back.

use crate::result::MissingRow;

/// The whole frame came back when it was sent again.
pub(super) fn once(row: u16, frame: u16) -> String {
    missing(
        (row, frame),
        "when it was streamed again, the whole frame came back; check cable and connectors, and run again",
    )
}

/// Other packets were lost or late as well.
pub(super) fn among_others(row: u16, frame: u16) -> String {
    missing(
        (row, frame),
        "when it was streamed again, other packets were lost or late as well, so the link may be the cause; check cable, \
         connectors and rate",
    )
}

/// Nothing else was lost, however often the frame was sent again.
pub(super) fn each_time(&MissingRow { row, frame, waits_for }: &MissingRow) -> String {
    let (says, part) = match waits_for {
        Some(row) => (format!("the board still waited for row {row}"), format!("takes in row {row}")),
        None => ("the board says that it took every row".to_owned(), "sends this row".to_owned()),
    };
    let alone = format!(
        "each time that its frame was streamed again, this row alone was missing, and {says}; a poor cable does not choose one row; \
         check how the board {part}, and whether something on the way swallows certain bytes or lengths"
    );
    missing((row, frame), &alone)
}

/// Nothing was tried beyond asking for `row`.
pub(super) fn stayed_away(row: &str) -> String {
    not_back(row, "check cable, connectors and rate, and run again")
}

fn missing((row, frame): (u16, u16), seen: &str) -> String {
    not_back(&format!("row {row} of frame {frame}"), seen)
}

fn not_back(row: &str, seen: &str) -> String {
    format!("{row} did not come back, although it was asked for again and again; {seen}")
}
