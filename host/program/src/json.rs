//! JSON with the exit code that goes with it, which the libraries do not know.

use halfrow::result::{Document, Problem, Report, Schema};
use halfrow::verdict::Verdict;
use serde::Serialize;

use crate::exit::Exit;

/// The report, indented, ending in a line feed. `schema`, `command`, `verdict`, `exit_code` and `board.kind` come first.
///
/// # Errors
/// The encoder's. No value that a [`Report`] can hold brings one about.
pub fn report(report: &Report) -> Result<String, serde_json::Error> {
    let mut text = indented(report, report.cause.into())?;
    text.push('\n');
    Ok(text)
}

/// The result of a command, or why there is none, indented.
///
/// # Errors
/// The encoder's.
pub fn document(document: &Document<'_, impl Serialize>, exit: Exit) -> Result<String, serde_json::Error> {
    indented(document, exit)
}

/// The document of a command that failed, indented.
#[must_use]
pub fn without_result(command: &str, exit: Exit, verdict: Option<Verdict>, problem: &Problem) -> String {
    let error = Some(problem);
    let document = Document { schema: Schema, command, verdict, board: None, error, rest: Nothing {} };
    indented(&document, exit).unwrap_or_default()
}

/// What a document has beside what all have, when a command came to no result.
#[derive(Serialize)]
struct Nothing {}

fn indented(document: &impl Serialize, exit: Exit) -> Result<String, serde_json::Error> {
    let mut value = serde_json::to_value(document)?;
    if let Some(members) = value.as_object_mut() {
        let behind = members.keys().position(|key| key == "verdict").map_or(0, |place| place + 1);
        members.shift_insert(behind, "exit_code".to_owned(), exit.code().into());
    }
    serde_json::to_string_pretty(&value)
}
