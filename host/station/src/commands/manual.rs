//! `halfrow-station completions` and `manual`

use clap::{Args, CommandFactory as _};
use halfrow::call::FilesError;
use halfrow_program::man_pages::{self, Shell};

use super::{Cli, Failure, print};
use crate::exit::Exit;

/// Print a completion script for a shell
#[derive(Debug, Args)]
pub(super) struct Completions {
    /// The shell
    shell: Shell,
}

/// Write the manual pages into a folder
///
/// Then: man -l FOLDER/halfrow-station.1
#[derive(Debug, Args)]
pub(super) struct Manual {
    #[command(flatten)]
    to: man_pages::ManualFolder,
}

pub(super) fn complete(arguments: &Completions) -> Result<Exit, Failure> {
    print(&man_pages::completions(arguments.shell, &mut Cli::command()))
}

pub(super) fn write(arguments: &Manual) -> Result<Exit, Failure> {
    arguments.to.write(Cli::command(), None).map_err(|(exit, error)| {
        // The library names no flag.
        let exists = matches!(error.downcast_ref(), Some(FilesError::Exists { .. }));
        let flag = "a page is there already, and is replaced with --overwrite alone";
        Failure::of(exit, if exists { error.context(flag) } else { error })
    })?;
    Ok(Exit::Pass)
}
