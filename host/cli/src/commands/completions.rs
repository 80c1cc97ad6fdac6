//! `halfrow completions` and `halfrow manual`

use clap::Args;

use super::{Context, Failure};
use crate::exit::Exit;
use halfrow_program::man_pages::{self, ManualFolder, Shell};

#[derive(Debug, Args)]
pub(super) struct Completions {
    /// The shell
    shell: Shell,
}

pub(super) fn complete(arguments: &Completions, command: &mut clap::Command) -> Result<Exit, Failure> {
    super::print(&man_pages::completions(arguments.shell, command))?;
    Ok(Exit::Pass)
}

pub(super) fn manual(
    arguments: &ManualFolder,
    command: clap::Command,
    context: &Context,
) -> Result<Exit, Failure> {
    let written = arguments.write(command, context.settings_file.as_deref());
    written.map_err(|(exit, error)| Failure::of(exit, error))?;
    Ok(Exit::Pass)
}
