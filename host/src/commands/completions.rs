//! `halfrow completions` and `halfrow manual`

use std::io;
use std::path::{Path, PathBuf};

use anyhow::Context as _;
use clap::Args;
use clap_complete::Shell;

use super::Failure;
use crate::verdict::Exit;

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
    let mut command = command.disable_help_subcommand(true);
    command.build();
    write_pages(&command, &arguments.folder).with_context(|| {
        format!("the manual cannot be written to {}; name a folder that is there", arguments.folder.display())
    })?;
    Ok(Exit::Pass)
}

/// A page for `command` and one for each of its own.
fn write_pages(command: &clap::Command, folder: &Path) -> io::Result<()> {
    command
        .get_subcommands()
        .filter(|command| !command.is_hide_set())
        .try_for_each(|command| write_pages(command, folder))?;
    let man = clap_mangen::Man::new(command.clone());
    let mut page = Vec::new();
    man.render(&mut page)?;
    let page = with_value_names(command, &String::from_utf8_lossy(&page));
    std::fs::write(folder.join(man.get_filename()), page)
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
