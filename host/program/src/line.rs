//! Reading a command line, and answering one that leads to no command.

use std::ffi::OsString;

use clap::error::ErrorKind;
use clap::{Arg, Command, Parser};
use halfrow::result::Problem;

use crate::built::{self, Built};
use crate::console::{self, Unprinted};
use crate::exit::Exit;
use crate::{codes, json, variables};

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
        Err(told) => {
            return Err(variables::blamed(told, &command, |is_meant| {
                let left = |it| variables::unless_empty(variables::unless(is_meant(&it), it));
                matched(&mut with_each(Line::command(), &|it| with_negative_numbers(left(it)))).err()
            }));
        }
    };
    Line::from_arg_matches_mut(&mut matches).map_err(|error| error.format(&mut command))
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
    let mut text = told.render().ansi().to_string();
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
    let message = told.render().to_string();
    let message = message.trim_start_matches("error: ").split("\n\nUsage:").next().unwrap_or_default().trim();
    let mut problem = Problem::new(codes::of_usage(told.kind()), message);
    if told.kind() != ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        let name = program.get_name();
        problem.remedy = Some(format!("See `{name} help` and `{name} COMMAND --help`."));
    }
    json::without_result(command, Exit::Usage, None, &problem)
}
