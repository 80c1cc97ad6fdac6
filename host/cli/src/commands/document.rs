//! Results of commands as JSON documents, and why there are none.

use clap::error::ErrorKind;
use serde::Serialize;

use super::{Failure, codes, print};
use crate::exit::Exit;
use crate::{console, flags, json};
use halfrow::result::{BoardReport, Document, Problem, Schema};

/// What a document has beside what all have, when a command came to no result.
#[derive(Serialize)]
struct Nothing {}

/// The result of a command that judges nothing.
pub(super) fn result_text(
    command: &str,
    exit_code: Exit,
    board: Option<&BoardReport>,
    rest: impl Serialize,
) -> Result<String, Failure> {
    let document = Document { schema: Schema, command, verdict: None, board, error: None, rest };
    json::document(&document, exit_code).map_err(Failure::error)
}

/// Prints the result of a command that judges nothing, which is its only one.
pub(super) fn print_result(
    command: &str,
    exit_code: Exit,
    board: Option<&BoardReport>,
    rest: impl Serialize,
) -> Result<(), Failure> {
    print(&result_text(command, exit_code, board, rest)?)
}

/// Tells the result of a command that left files, which stand whether or not it can be told.
pub(super) fn tell_result(
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
    let Failure { exit, error } = failure;
    without_result(command, *exit, &named(codes::problem(*exit, error)))
}

/// The document of a call that could not be read, if `arguments` ask for JSON.
#[must_use]
pub fn usage(error: &clap::Error, arguments: &[String]) -> Option<String> {
    let options = arguments.iter().skip(1).take_while(|argument| *argument != "--");
    let names = || options.clone().map(String::as_str);
    if !error.use_stderr() || !names().any(|argument| argument == "--json") {
        return None;
    }
    let known = |name: &&str| {
        <super::Line<super::Command> as clap::CommandFactory>::command().find_subcommand(name).is_some()
    };
    let command = names().find(known).unwrap_or("halfrow");
    let message = error.render().to_string();
    let message = message.trim_start_matches("error: ").split("\n\nUsage:").next().unwrap_or_default().trim();
    let mut problem = Problem::new(codes::of_usage(error.kind()), message);
    if error.kind() != ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        problem.remedy = Some("See `halfrow help` and `halfrow COMMAND --help`.".to_owned());
    }
    Some(without_result(command, Exit::Usage, &problem))
}

/// A problem with the flags of the settings that its words name.
fn named(problem: Problem) -> Problem {
    Problem {
        message: flags::named(&problem.message),
        remedy: problem.remedy.as_deref().map(flags::named),
        causes: problem.causes.into_iter().map(named).collect(),
        ..problem
    }
}

fn without_result(command: &str, exit_code: Exit, problem: &Problem) -> String {
    let (verdict, error, rest) = (exit_code.verdict(), Some(problem), Nothing {});
    let document = Document { schema: Schema, command, verdict, board: None, error, rest };
    json::document(&document, exit_code).unwrap_or_default()
}
