//! `halfrow-station completions` and `manual`

use std::fs;
use std::path::PathBuf;

use anyhow::Context as _;
use clap::{Args, CommandFactory as _};
use halfrow::files::written_aside::write_aside;
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
    /// The folder, made if it is not there
    folder: PathBuf,
    /// Replace pages that are there
    #[arg(long)]
    overwrite: bool,
}

pub(super) fn complete(arguments: &Completions) -> Result<Exit, Failure> {
    print(&man_pages::completions(arguments.shell, &mut Cli::command()))
}

pub(super) fn write(arguments: &Manual) -> Result<Exit, Failure> {
    let Manual { folder, overwrite } = arguments;
    let pages = man_pages::all(Cli::command()).map_err(Failure::error)?;
    let made = fs::create_dir_all(folder);
    made.with_context(|| format!("{} cannot be made; name a folder that can be", folder.display()))
        .map_err(Failure::error)?;
    for page in pages {
        write_aside(&folder.join(&page.name), *overwrite, |out| out.write_all(page.text.as_bytes()))
            .map_err(Failure::error)?;
    }
    Ok(Exit::Pass)
}
