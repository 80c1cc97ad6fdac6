//! The JSON of a report: the library's, with the exit code that goes with it.

use halfrow::report::{self, Report};
use serde_json::{Map, Value};

use crate::exit::Exit;

/// The report, indented, ending in a line feed. `verdict`, `exit_code` and `board.kind` come first.
///
/// # Errors
/// The encoder's. No value that a [`Report`] can hold brings one about.
pub fn report(report: &Report) -> Result<String, serde_json::Error> {
    let mut members: Map<String, Value> = serde_json::from_str(&report::json(report)?)?;
    let behind = members.keys().position(|key| key == "verdict").map_or(0, |place| place + 1);
    members.shift_insert(behind, "exit_code".to_owned(), Exit::from(report.cause).code().into());
    let mut text = serde_json::to_string_pretty(&members)?;
    text.push('\n');
    Ok(text)
}
