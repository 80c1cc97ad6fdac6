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

/// The document of a command that failed. It has no verdict, because none was saved.
#[must_use]
pub fn failure(command: &str, failure: &Failure) -> String {
    let Failure { exit, error } = failure;
    json::without_result(command, *exit, None, &codes::problem(*exit, error))
}

/// The code of a command's failure, if `halfrow explain` has more to say about it.
#[must_use]
pub fn code(failure: &Failure) -> Option<String> {
    halfrow_program::codes::explained(codes::problem(failure.exit, &failure.error))
}
