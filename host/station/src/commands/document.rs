//! Results of commands as JSON documents, which begin like those of `halfrow`, or the reason why there is no result.

use halfrow::Verdict;
use halfrow::result::{Document, Schema};
use halfrow_program::json;
use serde::Serialize;

use super::Failure;
use crate::codes;
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
    let Failure { exit, error } = failure;
    let indented = json::without_result(command, *exit, None, &codes::problem(*exit, error));
    if command != IN_LINES {
        return indented;
    }
    // No string of JSON has a newline of its own.
    indented.lines().map(str::trim_start).collect()
}

/// The code of a command's failure, if `halfrow explain` has more to say about it.
#[must_use]
pub fn code(failure: &Failure) -> Option<String> {
    halfrow_program::codes::explained(codes::problem(failure.exit, &failure.error))
}
