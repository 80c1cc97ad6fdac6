//! `halfrow-station commands`

use clap::Args;
use halfrow_program::reference;

use super::{Failure, print};
use crate::exit::Exit;

/// Print the page of all commands and their options
///
/// It is docs/STATION-COMMANDS.md.
#[derive(Debug, Args)]
pub(super) struct Arguments {}

const HEAD: &str = "# Commands of the station

What `halfrow-station help COMMAND` says, on one page: `halfrow-station commands` prints it, and a test holds the two equal.
[`halfrow`](COMMANDS.md) has a page of its own.
";

pub(super) fn run(_: &Arguments, program: clap::Command) -> Result<Exit, Failure> {
    print(reference::page(HEAD, program).trim_end())
}
