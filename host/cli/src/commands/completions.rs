//! `halfrow completions` and `halfrow manual`

use std::path::PathBuf;

use anyhow::Context as _;
use clap::Args;
use clap_complete::Shell;

use super::Failure;
use crate::exit::Exit;

/// Print a completion script for a shell
///
/// For bash: halfrow completions bash > ~/.local/share/bash-completion/completions/halfrow
#[derive(Debug, Args)]
pub(super) struct Completions {
    /// The shell
    shell: Shell,
}

/// Write the manual pages into a folder
///
/// Then: man -l FOLDER/halfrow.1
#[derive(Debug, Args)]
pub(super) struct Manual {
    /// The folder, which must be there
    folder: PathBuf,
}

pub(super) fn complete(arguments: &Completions, command: &mut clap::Command) -> Result<Exit, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, command, "halfrow", &mut script);
    super::print(String::from_utf8_lossy(&script).trim_end())?;
    Ok(Exit::Pass)
}

pub(super) fn manual(arguments: &Manual, command: clap::Command) -> Result<Exit, Failure> {
    clap_mangen::generate_to(command, &arguments.folder)
        .with_context(|| {
            format!(
                "the manual cannot be written to {}; name a folder that is there",
                arguments.folder.display()
            )
        })
        .map_err(Failure::call)?;
    Ok(Exit::Pass)
}
