//! `halfrow completions` and `halfrow manual`

use std::path::PathBuf;

use anyhow::Context as _;
use clap::Args;
use clap_complete::Shell;
use clap_mangen::Man;

use super::files::Files;
use super::{Context, Failure};
use halfrow::verdict::Exit;
use halfrow_frames::written_aside::write_aside;

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
    /// The folder, made if it is not there
    folder: PathBuf,
    /// Replace pages that are there
    #[arg(long)]
    overwrite: bool,
}

pub(super) fn complete(arguments: &Completions, command: &mut clap::Command) -> Result<Exit, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, command, "halfrow", &mut script);
    super::print(String::from_utf8_lossy(&script).trim_end())?;
    Ok(Exit::Pass)
}

pub(super) fn manual(arguments: &Manual, command: clap::Command, context: &Context) -> Result<Exit, Failure> {
    let folder = &arguments.folder;
    let mut command = command.disable_help_subcommand(true);
    command.build();
    let mut pages = Vec::new();
    collect(command, &mut pages);
    let places: Vec<_> = pages.iter().map(|page| folder.join(page.get_filename())).collect();
    Files::new(arguments.overwrite).reads(&context.settings_file).writes_into("FOLDER", &places).check()?;
    std::fs::create_dir_all(folder)
        .with_context(|| format!("{} cannot be made; name another folder", folder.display()))
        .map_err(Failure::error)?;
    for (page, place) in pages.iter().zip(&places) {
        write_aside(place, arguments.overwrite, |out| page.render(out)).map_err(Failure::error)?;
    }
    Ok(Exit::Pass)
}

/// The pages of a command's subcommands, then its own.
fn collect(command: clap::Command, pages: &mut Vec<Man>) {
    for subcommand in command.get_subcommands().filter(|subcommand| !subcommand.is_hide_set()) {
        collect(subcommand.clone(), pages);
    }
    pages.push(Man::new(command));
}
