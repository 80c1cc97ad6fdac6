//! Results of commands as JSON documents, and why there is no result.

use serde::Serialize;

use crate::commands::{Failure, codes, print};
use crate::exit::Exit;
use crate::{console, flags, json};
use halfrow::result::{BoardReport, Document, Problem, Schema};

/// The result of a command that judges nothing.
pub(crate) fn result_text(
    command: &str,
    exit_code: Exit,
    board: Option<&BoardReport>,
    rest: impl Serialize,
) -> Result<String, Failure> {
    let document = Document { schema: Schema, command, verdict: None, exit_code, board, error: None, rest };
    json::document(&document).map_err(Failure::error)
}

/// Prints the result of a command that judges nothing and has no other output: it fails if stdout does not take it.
pub(crate) fn print_result(
    command: &str,
    exit_code: Exit,
    board: Option<&BoardReport>,
    rest: impl Serialize,
) -> Result<(), Failure> {
    print(&result_text(command, exit_code, board, rest)?)
}

/// Prints the result of a command that has written files. The files remain, so it does not fail if stdout does not take
/// the result.
pub(crate) fn tell_result(
    command: &str,
    exit_code: Exit,
    board: Option<&BoardReport>,
    rest: impl Serialize,
) -> Result<(), Failure> {
    console::tell(&result_text(command, exit_code, board, rest)?);
    Ok(())
}

/// The document of a command that failed.
#[must_use]
pub fn failure(command: &str, failure: &Failure) -> String {
    let Failure { exit, error, .. } = failure;
    json::without_result(command, *exit, exit.verdict(), &named(codes::problem(*exit, error)))
}

/// The code of a command's failure, if `explain` has more to say about it.
#[must_use]
pub fn code(failure: &Failure) -> Option<String> {
    halfrow_program::codes::explained(codes::problem(failure.exit, &failure.error))
}

/// `problem`, with the flag added after each setting that its words name.
fn named(problem: Problem) -> Problem {
    Problem {
        message: flags::named(&problem.message),
        remedy: problem.remedy.as_deref().map(flags::named),
        causes: problem.causes.into_iter().map(named).collect(),
        ..problem
    }
}
