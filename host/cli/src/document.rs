//! Results of commands as JSON documents.

use serde::Serialize;

use crate::commands::print;
use crate::exit::Exit;
use crate::failure::Failure;
use crate::{console, json};
use halfrow::result::{BoardReport, Document, Schema};

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
pub(crate) fn print_result(command: &str, rest: impl Serialize) -> Result<(), Failure> {
    print(&result_text(command, Exit::Pass, None, rest)?)
}

/// Prints the result of a command that has written files. The files remain, so it does not fail if stdout does not take
/// the result.
pub(crate) fn tell_result(command: &str, rest: impl Serialize) -> Result<(), Failure> {
    console::tell(&result_text(command, Exit::Pass, None, rest)?);
    Ok(())
}
