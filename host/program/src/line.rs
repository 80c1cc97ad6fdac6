//! Reading a command line, and answering one that leads to no command.

use std::ffi::OsString;

use clap::error::ErrorKind;
use clap::{Arg, Command, CommandFactory, Parser};

use crate::built::{self, Built};
use crate::console::{self, Unprinted};
use crate::exit::Exit;
use crate::{json, usage, variables};

/// The command line in `arguments`, the first of which is the program's name. Every option with a value accepts `-1` as its
/// value, so that the error says what the option takes and not that `-1` is no option. An empty environment variable counts as
/// unset.
///
/// # Errors
/// clap's own, which [`tell`] prints.
pub fn read<Line: Parser>(arguments: impl IntoIterator<Item = OsString>) -> clap::error::Result<Line> {
    let arguments: Vec<_> = arguments.into_iter().collect();
    let matched = |command: &mut Command| command.try_get_matches_from_mut(&arguments);
    let mut command = with_each(Line::command(), &|it| with_negative_numbers(variables::unless_empty(it)));
    let mut matches = match matched(&mut command) {
        Ok(matches) => matches,
        // The help names every variable, even if it is empty.
        Err(told) if !told.use_stderr() => {
            return Err(matched(&mut with_each(Line::command(), &with_negative_numbers))
                .err()
                .unwrap_or(told));
        }
        Err(told) => return Err(named::<Line>(told, &arguments, &command)),
    };
    Line::from_arg_matches_mut(&mut matches).map_err(|error| usage::spelt(error.format(&mut command)))
}

/// `told`, naming the variable or the argument that it is about.
fn named<Line: CommandFactory>(told: clap::Error, arguments: &[OsString], command: &Command) -> clap::Error {
    let read = |arguments: &[OsString], is_left_out: &dyn Fn(&Arg) -> bool| {
        let left = |it: Arg| variables::unless_empty(variables::unless(is_left_out(&it), it));
        let mut command = with_each(Line::command(), &|it| with_negative_numbers(left(it)));
        command.try_get_matches_from_mut(arguments).err()
    };
    let no_text = || usage::no_text(arguments, command, |arguments| read(arguments, &|_| false));
    if told.kind() == ErrorKind::InvalidUtf8
        && let Some(of_argument) = no_text()
    {
        return of_argument;
    }
    usage::spelt(variables::blamed(told, command, |is_left_out| read(arguments, is_left_out)))
}

fn with_negative_numbers(argument: Arg) -> Arg {
    let takes_one = argument.get_action().takes_values() && !argument.is_positional();
    if takes_one { argument.allow_negative_numbers(true) } else { argument }
}

/// `command` with `changed` applied to each argument, also to those of its subcommands.
fn with_each(command: Command, changed: &dyn Fn(Arg) -> Arg) -> Command {
    command.mut_args(changed).mut_subcommands(|command| with_each(command, changed))
}

/// Prints what clap has to say about the command line of `program`: help and version to stdout, what is wrong with a call to
/// stderr, and also as JSON to stdout if the call asks for it. With `--verbose` the version says what the program was built from.
///
/// # Errors
/// [`Unprinted`] when the call asks for help or version, and stdout does not take it.
pub fn tell(told: &clap::Error, program: &Command, built: Built) -> Result<Exit, Unprinted> {
    let mut text = usage::text(told);
    let arguments = std::env::args_os().skip(1).map(|argument| argument.to_string_lossy().into_owned());
    let options: Vec<_> = arguments.take_while(|argument| argument != "--").collect();
    if told.kind() == ErrorKind::DisplayVersion && built::is_asked(&options) {
        text += &built.lines();
    }
    if !told.use_stderr() {
        return console::print_raw(&text).map(|()| Exit::Pass);
    }
    console::diagnose_raw(&text);
    if options.iter().any(|option| option == "--json") {
        console::tell(&document(told, program, &options));
    }
    Ok(Exit::Usage)
}

fn document(told: &clap::Error, program: &Command, options: &[String]) -> String {
    let known = |name: &&String| program.find_subcommand(name).is_some();
    let command = options.iter().find(known).map_or(program.get_name(), String::as_str);
    json::without_result(command, Exit::Usage, &usage::problem(told, program))
}
