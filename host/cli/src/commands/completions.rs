//! `halfrow completions` and `halfrow manual`

use std::io;
use std::path::PathBuf;

use clap::Args;
use clap_complete::Shell;
use clap_mangen::Man;

use super::files::{Files, make_folder};
use super::{Context, Failure};
use crate::exit::Exit;
use halfrow_frames::written_aside::write_aside;

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
    let places: Vec<_> = pages.iter().map(|page| folder.join(page.man.get_filename())).collect();
    Files::new(arguments.overwrite)
        .reads(&context.settings_file)
        .writes_into("FOLDER", &places)
        .check()
        .map_err(Failure::call)?;
    make_folder(folder).map_err(Failure::error)?;
    for (page, place) in pages.iter().zip(&places) {
        let text = text(page).map_err(Failure::error)?;
        write_aside(place, arguments.overwrite, |out| out.write_all(text.as_bytes()))
            .map_err(Failure::error)?;
    }
    Ok(Exit::Pass)
}

/// A command and its page.
struct Page {
    command: clap::Command,
    man: Man,
}

/// The pages of a command's subcommands, then its own.
fn collect(command: clap::Command, pages: &mut Vec<Page>) {
    for subcommand in command.get_subcommands().filter(|subcommand| !subcommand.is_hide_set()) {
        collect(subcommand.clone(), pages);
    }
    pages.push(Page { man: Man::new(command.clone()), command });
}

fn text(page: &Page) -> io::Result<String> {
    let mut rendered = Vec::new();
    page.man.render(&mut rendered)?;
    Ok(with_value_names(&page.command, &String::from_utf8_lossy(&rendered)))
}

/// `page` with the names of values in its synopsis, where clap leaves them out.
fn with_value_names(command: &clap::Command, page: &str) -> String {
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
