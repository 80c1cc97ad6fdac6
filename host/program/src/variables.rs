//! The environment variables of a command line: an empty one counts as unset, and an error in one names the variable.

use std::ffi::OsStr;

use clap::builder::Resettable;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Arg, Command, Error};

/// `argument`, without its variable if that is empty: CI files unset variables that way.
pub(crate) fn unless_empty(argument: Arg) -> Arg {
    let value = argument.get_env().and_then(std::env::var_os);
    unless(value.is_some_and(|value| value.is_empty()), argument)
}

/// `argument`, without its variable if it is `left_out`.
pub(crate) fn unless(left_out: bool, argument: Arg) -> Arg {
    if left_out { argument.env(Resettable::Reset) } else { argument }
}

/// `error`, naming the environment variable if the value that it blames came from one. That is so if `command`'s line gives
/// another error, or none, when it is read without the variable: `read` gets a test of which arguments to read without theirs.
pub(crate) fn blamed(
    mut error: Error,
    command: &Command,
    read: impl Fn(&dyn Fn(&Arg) -> bool) -> Option<Error>,
) -> Error {
    if error.kind() == ErrorKind::InvalidUtf8 {
        return no_text(command, read).unwrap_or(error);
    }
    let Some(ContextValue::String(option)) = error.get(ContextKind::InvalidArg).cloned() else {
        return error;
    };
    let name = option.trim_start_matches('-').split([' ', '=', '[']).next().unwrap_or_default();
    let Some(variable) = variable_of(command, name) else { return error };
    let without = read(&|argument| argument.get_env() == Some(variable));
    if without.is_none_or(|without| without.to_string() != error.to_string()) {
        let named = format!("{} in the environment, which stands for {option}", variable.display());
        error.insert(ContextKind::InvalidArg, ContextValue::String(named));
    }
    error
}

/// The error about a variable that must be text and is none, if leaving out such variables helps. clap does not say which it is.
fn no_text(command: &Command, read: impl Fn(&dyn Fn(&Arg) -> bool) -> Option<Error>) -> Option<Error> {
    let mut left_out = Vec::new();
    for variable in variables(command) {
        if std::env::var_os(variable).is_none_or(|value| value.to_str().is_some()) {
            continue;
        }
        left_out.push(variable);
        let without = read(&|argument| argument.get_env().is_some_and(|of_this| left_out.contains(&of_this)));
        if without.is_none_or(|without| without.kind() != ErrorKind::InvalidUtf8) {
            let told = format!(
                "{} in the environment is no text in UTF-8; write it in UTF-8, or unset it\n",
                variable.display()
            );
            return Some(Error::raw(ErrorKind::InvalidUtf8, told).with_cmd(command));
        }
    }
    None
}

/// The variables of all options.
fn variables(command: &Command) -> Vec<&OsStr> {
    let own = command.get_arguments().filter_map(Arg::get_env);
    own.chain(command.get_subcommands().flat_map(variables)).collect()
}

/// The variable of the option `--name`.
fn variable_of<'a>(command: &'a Command, name: &str) -> Option<&'a OsStr> {
    let own = command.get_arguments().find(|argument| argument.get_long() == Some(name));
    let variable = own.and_then(Arg::get_env);
    variable.or_else(|| command.get_subcommands().find_map(|command| variable_of(command, name)))
}
