//! Documents as both programs print them.

use halfrow::result::{Document, Problem, Schema};
use halfrow::verdict::Verdict;
use serde::Serialize;

use crate::exit::Exit;

/// The result of a command, or why there is none, indented.
///
/// # Errors
/// The encoder's.
pub fn document(document: &Document<'_, impl Serialize>) -> Result<String, serde_json::Error> {
    // A member of the rest stands for one of the same name that all have.
    serde_json::to_string_pretty(&serde_json::to_value(document)?)
}

/// The document of a command that failed, indented.
#[must_use]
pub fn without_result(command: &str, exit: Exit, verdict: Option<Verdict>, problem: &Problem) -> String {
    let (schema, error) = (Schema, Some(problem));
    let failed = Document { schema, command, verdict, exit_code: exit, board: None, error, rest: Nothing {} };
    document(&failed).unwrap_or_default()
}

/// What a document has beside what all have, when a command came to no result.
#[derive(Serialize)]
struct Nothing {}
