//! The page of all commands of a program, in Markdown, made from its command line.

use std::fmt::Write as _;

use clap::{Arg, Command, Id};

/// `head`, then every command of `program` that help shows, with its usage, arguments and options.
#[must_use]
pub fn page(head: &str, program: Command) -> String {
    let mut program = program.disable_help_subcommand(true);
    program.build();
    let mut page = format!("{head}\n## Every command\n\n{}", table(&program, Arg::is_global_set));
    let shared: Vec<_> = program.get_arguments().map(Arg::get_id).cloned().collect();
    for command in program.get_subcommands() {
        section(command, program.get_name(), &shared, &mut page);
    }
    page
}

/// A command, without the options that all commands share, then its subcommands.
fn section(command: &Command, before: &str, shared: &[Id], page: &mut String) {
    if command.is_hide_set() {
        return;
    }
    let name = format!("{before} {}", command.get_name());
    let about = command.get_long_about().or(command.get_about()).map(ToString::to_string).unwrap_or_default();
    let usage = command.clone().render_usage().to_string();
    let usage = usage.trim_start_matches("Usage: ");
    // Writing to a string cannot fail.
    let _ = write!(page, "\n## {name}\n\n{about}\n\n```text\n{usage}\n```\n");
    let table = table(command, |argument| !shared.contains(argument.get_id()));
    if !table.is_empty() {
        let _ = write!(page, "\n{table}");
    }
    for inner in command.get_subcommands() {
        section(inner, &name, shared, page);
    }
}

/// The arguments of a command that `is_wanted` accepts and that the help shows; empty if there are none.
fn table(command: &Command, is_wanted: impl Fn(&Arg) -> bool) -> String {
    let is_shown = |argument: &&Arg| {
        let by_clap = ["help", "version"].contains(&argument.get_id().as_str());
        !by_clap && !argument.is_hide_set() && is_wanted(argument)
    };
    let rows: Vec<_> = command.get_arguments().filter(is_shown).map(row).collect();
    if rows.is_empty() { String::new() } else { format!("| | |\n|---|---|\n{}\n", rows.join("\n")) }
}

fn row(argument: &Arg) -> String {
    let help = argument.get_long_help().or(argument.get_help()).map(ToString::to_string).unwrap_or_default();
    let mut told = on_one_line(&help).replace('<', "&lt;");
    let choices: Vec<_> =
        argument.get_possible_values().iter().map(|choice| choice.get_name().to_owned()).collect();
    let has_choices = !choices.is_empty() && !argument.is_hide_possible_values_set();
    if argument.get_action().takes_values() && has_choices {
        let _ = write!(told, " [possible values: {}]", choices.join(", "));
    }
    let defaults = argument.get_default_values();
    if argument.get_action().takes_values() && !defaults.is_empty() {
        let defaults: Vec<_> = defaults.iter().map(|value| value.to_string_lossy()).collect();
        let _ = write!(told, " [default: {}]", defaults.join(", "));
    }
    if let Some(variable) = argument.get_env() {
        let _ = write!(told, " [env: {}]", variable.to_string_lossy());
    }
    format!("| {} | {} |", names(argument).replace('|', "\\|"), told.replace('|', "\\|"))
}

/// The paragraphs of a help on one line. The first has no full stop of its own, since it is also the short help.
fn on_one_line(help: &str) -> String {
    let paragraphs = help.split("\n\n").map(|it| it.split_whitespace().collect::<Vec<_>>().join(" "));
    let joined = paragraphs.reduce(|text, more| {
        let stop = if text.ends_with('.') { "" } else { "." };
        format!("{text}{stop} {more}")
    });
    joined.unwrap_or_default()
}

/// As in `-o, --output FILE`, `--overwrite[=YES|NO]`, or `FILE...`.
fn names(argument: &Arg) -> String {
    let value = argument.get_value_names().unwrap_or_default().join(" ");
    let value = if value.is_empty() { argument.get_id().as_str().to_uppercase() } else { value };
    let many = argument.get_num_args().is_some_and(|range| range.max_values() > 1);
    let value = if many { format!("{value}...") } else { value };
    let may_lack = argument.get_num_args().is_some_and(|range| range.min_values() == 0);
    let value = match (argument.is_require_equals_set(), may_lack) {
        (false, _) => format!(" {value}"),
        (true, false) => format!("={value}"),
        (true, true) => format!("[={value}]"),
    };
    let long = argument.get_long().map(|long| format!("--{long}"));
    let names: Vec<_> =
        argument.get_short().map(|short| format!("-{short}")).into_iter().chain(long).collect();
    match (names.is_empty(), argument.get_action().takes_values()) {
        (true, _) => format!("`{}`", value.trim_start()),
        (false, false) => format!("`{}`", names.join(", ")),
        (false, true) => format!("`{}{value}`", names.join(", ")),
    }
}
