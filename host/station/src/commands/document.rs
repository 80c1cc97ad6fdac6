//! Results of commands as JSON documents, which begin like those of `halfrow`, or the reason why there is no result.

use std::iter;

use clap::{ArgMatches, Args, Command, FromArgMatches};
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
const IN_LINES: &str = "work";

/// Whether the call asks for a document, which `--json` of the command itself says.
///
/// It must be the first field of the program's arguments: the code that clap derives takes the command out of the matches.
#[derive(Debug, Default)]
pub(super) struct Asked {
    /// The command that the document names.
    pub(super) command: Option<String>,
}

impl FromArgMatches for Asked {
    fn from_arg_matches(matches: &ArgMatches) -> clap::error::Result<Self> {
        let within = iter::successors(matches.subcommand(), |(_, within)| within.subcommand());
        let (names, within): (Vec<_>, Vec<_>) = within.unzip();
        let is_asked =
            within.last().is_some_and(|last| matches!(last.try_get_one::<bool>("json"), Ok(Some(true))));
        let command = match names[..] {
            // What it finds is told as of a station's folder.
            ["plant", check @ "check"] => Some(check),
            _ => names.first().copied(),
        };
        Ok(Self { command: command.filter(|_| is_asked).map(str::to_owned) })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> clap::error::Result<()> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// It has no option of its own.
impl Args for Asked {
    fn augment_args(command: Command) -> Command {
        command
    }

    fn augment_args_for_update(command: Command) -> Command {
        command
    }
}

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
