//! `halfrow completions` and `halfrow manual`

use std::path::PathBuf;

use clap::Args;

use super::{Context, Failure};
use crate::exit::Exit;
use crate::files::{make_folder, prepare_files};
use halfrow::files::written_aside::write_aside;
use halfrow_program::man_pages::{self, Shell};

#[derive(Debug, Args)]
pub(super) struct Completions {
    /// The shell
    shell: Shell,
}

#[derive(Debug, Args)]
pub(super) struct Manual {
    /// The folder, made if it is not there
    folder: PathBuf,
    /// Replace pages that are there
    #[arg(long)]
    overwrite: bool,
}

pub(super) fn complete(arguments: &Completions, command: &mut clap::Command) -> Result<Exit, Failure> {
    super::print(&man_pages::completions(arguments.shell, command))?;
    Ok(Exit::Pass)
}

pub(super) fn manual(arguments: &Manual, command: clap::Command, context: &Context) -> Result<Exit, Failure> {
    let folder = &arguments.folder;
    let pages = man_pages::all(command).map_err(Failure::error)?;
    let places: Vec<_> = pages.iter().map(|page| folder.join(&page.name)).collect();
    prepare_files(&context.files(arguments.overwrite).writes_into("FOLDER", &places))
        .map_err(Failure::call)?;
    make_folder(folder).map_err(Failure::error)?;
    for (page, place) in pages.iter().zip(&places) {
        write_aside(place, arguments.overwrite, |out| out.write_all(page.text.as_bytes()))
            .map_err(Failure::error)?;
    }
    Ok(Exit::Pass)
}
