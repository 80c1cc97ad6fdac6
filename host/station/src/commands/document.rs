//! Results of commands as JSON documents, which begin like those of `halfrow`, or the reason why there is no result.

use halfrow::Verdict;
use halfrow::result::{Document, Schema};
use halfrow_program::json;
use serde::Serialize;

use super::Failure;
use crate::exit::Exit;

/// The result of a command.
pub(super) fn text(
    command: &str,
    exit: Exit,
    verdict: Option<Verdict>,
    rest: impl Serialize,
) -> Result<String, Failure> {
    let document =
        Document { schema: Schema, command, verdict, exit_code: exit, board: None, error: None, rest };
    json::document(&document).map_err(Failure::error)
}

/// The command that prints an object a line, to which that of its failure is one more.
pub(super) const IN_LINES: &str = "work";

/// The document of a command that failed. It has no verdict, because none was saved.
#[must_use]
pub fn failure(command: &str, failure: &Failure) -> String {
    let indented = json::without_result(command, failure.exit, &failure.problem());
    if command != IN_LINES {
        return indented;
    }
    // No string of JSON has a newline of its own.
    indented.lines().map(str::trim_start).collect()
}
