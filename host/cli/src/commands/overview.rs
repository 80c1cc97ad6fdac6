//! `halfrow commands`

use clap::Args;
use halfrow_program::reference;

use super::{Failure, print};
use crate::exit::Exit;

#[derive(Debug, Args)]
pub(super) struct Arguments {}

const HEAD: &str = "# Commands

What `halfrow help COMMAND` says, on one page: `halfrow commands` prints it, and a test holds the two equal. The commands of
`halfrow-station` stand [on another](STATION-COMMANDS.md).
";

pub(super) fn run(_: &Arguments, program: clap::Command) -> Result<Exit, Failure> {
    print(reference::page(HEAD, program).trim_end())?;
    Ok(Exit::Pass)
}
