//! A program's man pages and completion scripts, made from its command line.

use std::path::{Path, PathBuf};
use std::{fs, io};

use clap::{Args, Command};
use clap_mangen::Man;
use halfrow::call::{Files, FilesError};
use halfrow::files::written_aside::write_aside;

use crate::exit::Exit;
use crate::files::prepare_files;

pub use clap_complete::Shell;

/// The folder that man pages are written into.
#[derive(Debug, Args)]
pub struct ManualFolder {
    /// The folder, made if it is not there
    folder: PathBuf,
    /// Replace pages that are there
    #[arg(long)]
    overwrite: bool,
}

impl ManualFolder {
    /// Writes the pages of all commands of `program`; none if something is in the way of one. No page is written over `input`,
    /// which the call reads.
    ///
    /// # Errors
    /// The exit code, which is that of a wrong call if nothing was written, and the reason.
    pub fn write(&self, program: Command, input: Option<&Path>) -> Result<(), (Exit, anyhow::Error)> {
        let Self { folder, overwrite } = self;
        let pages = all(program).map_err(|error| (Exit::Error, error.into()))?;
        let places: Vec<_> = pages.iter().map(|page| folder.join(&page.name)).collect();
        let files = Files::new(*overwrite).reads(input).writes_into(FOLDER, &places);
        prepare_files(&files).map_err(|error| (Exit::of_refusal(&error), error.into()))?;
        let written = || {
            let (path, option) = (folder.clone(), FOLDER);
            fs::create_dir_all(folder).map_err(|source| FilesError::FolderClosed { path, option, source })?;
            for (page, place) in pages.iter().zip(&places) {
                write_aside(place, *overwrite, |out| out.write_all(page.text.as_bytes()))?;
            }
            Ok::<_, FilesError>(())
        };
        written().map_err(|error| (Exit::Error, error.into()))
    }
}

/// The argument that names the folder.
const FOLDER: &str = "FOLDER";

/// A man page of section 1.
struct Page {
    /// Its file name.
    name: String,
    /// Its content, for troff.
    text: String,
}

/// The script with which `shell` completes calls of `program`, without a newline at its end.
#[must_use]
pub fn completions(shell: Shell, program: &mut Command) -> String {
    let name = program.get_name().to_owned();
    let mut script = Vec::new();
    clap_complete::generate(shell, program, name, &mut script);
    String::from_utf8_lossy(&script).trim_end().to_owned()
}

/// The pages of all commands of `program` that are not hidden, then its own.
///
/// # Errors
/// Those of the renderer, which writes only to memory.
fn all(program: Command) -> io::Result<Vec<Page>> {
    let mut program = program.disable_help_subcommand(true);
    program.build();
    let mut pages = Vec::new();
    collect(&program, &mut pages)?;
    Ok(pages)
}

fn collect(command: &Command, pages: &mut Vec<Page>) -> io::Result<()> {
    for subcommand in command.get_subcommands().filter(|subcommand| !subcommand.is_hide_set()) {
        collect(subcommand, pages)?;
    }
    let man = Man::new(command.clone());
    let mut rendered = Vec::new();
    man.render(&mut rendered)?;
    let text = with_value_names(command, &String::from_utf8_lossy(&rendered));
    pages.push(Page { name: man.get_filename(), text });
    Ok(())
}

/// `page` with the names of values added to its synopsis, where clap leaves them out.
fn with_value_names(command: &Command, page: &str) -> String {
    const SYNOPSIS: &str = ".SH SYNOPSIS\n";
    let Some((before, rest)) = page.split_once(SYNOPSIS) else { return page.to_owned() };
    let (synopsis, after) = rest.split_at(rest.find("\n.SH ").unwrap_or(rest.len()));
    let takes_value = |argument: &&clap::Arg| argument.get_action().takes_values();
    let synopsis = command.get_opts().filter(takes_value).fold(synopsis.to_owned(), |synopsis, option| {
        let Some(long) = option.get_long() else { return synopsis };
        let name =
            option.get_value_names().and_then(<[_]>::first).map_or("VALUE", clap::builder::Str::as_str);
        let (written, name) = (long.replace('-', "\\-"), name.replace('-', "\\-"));
        let option = format!("\\fB\\-\\-{written}\\fR");
        synopsis.replace(&option, &format!("{option} \\fI{name}\\fR"))
    });
    format!("{before}{SYNOPSIS}{synopsis}{after}")
}
