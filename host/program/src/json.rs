//! JSON documents as both programs print them.

use halfrow::result::{Document, Problem, Schema};
use serde::Serialize;

use crate::exit::Exit;

/// The result of a command, or why there is none, as indented JSON.
///
/// # Errors
/// Those of the encoder.
pub fn document(document: &Document<'_, impl Serialize>) -> Result<String, serde_json::Error> {
    // By way of a value: a member of the rest then replaces a common one of the same name.
    serde_json::to_string_pretty(&serde_json::to_value(document)?)
}

/// The document of a command that failed without a verdict, as indented JSON.
#[must_use]
pub fn without_result(command: &str, exit: Exit, problem: &Problem) -> String {
    let failed = Document {
        schema: Schema,
        command,
        verdict: None,
        exit_code: exit,
        board: None,
        error: Some(problem),
        rest: Nothing {},
    };
    document(&failed).unwrap_or_default()
}

/// The rest of a document, beside what all have, if a command has no result.
#[derive(Serialize)]
struct Nothing {}
