//! The page of all commands of a program, in Markdown, made from its command line.

use std::collections::HashMap;
use std::fmt::Write as _;

use clap::{Arg, Command, Id};

/// The heading of the options that several commands have, and of those among them that help lists under none.
const SHARED: &str = "Options of several commands";

/// `head`, then every command of `program` that help shows, with its usage, arguments and options. Options that several commands
/// have with the same help stand before the commands, each of which names those that it has.
#[must_use]
pub fn page(head: &str, program: Command) -> String {
    let mut program = program.disable_help_subcommand(true);
    program.build();
    let of_all: Vec<_> = shown(&program).filter(|argument| argument.is_global_set()).map(row).collect();
    let shared = Shared::of(&program);
    let mut page = format!("{head}\n## Every command\n\n{}\n## {SHARED}\n", table(&of_all));
    for (heading, options) in shared.groups() {
        if heading != SHARED {
            let _ = write!(page, "\n### {heading}\n");
        }
        let rows: Vec<_> = options.iter().map(|option| option.row.clone()).collect();
        if !rows.is_empty() {
            let _ = write!(page, "\n{}", table(&rows));
        }
    }
    for command in program.get_subcommands() {
        section(command, program.get_name(), &shared, &mut page);
    }
    page
}

/// An option that several commands have with the same help.
struct SharedOption {
    /// Where it stands.
    heading: String,
    /// As in `--output`.
    name: String,
    /// Its line of a table.
    row: String,
}

/// All of them. No two have the same name: of several helps, the one that most commands have is shared.
struct Shared {
    /// Those that every command has.
    of_all: Vec<Id>,
    options: Vec<SharedOption>,
}

impl Shared {
    fn of(program: &Command) -> Self {
        let of_all: Vec<_> = program.get_arguments().map(Arg::get_id).cloned().collect();
        let mut found = Vec::new();
        program.get_subcommands().for_each(|command| collect(command, &of_all, &mut found));
        let mut counts = HashMap::<String, usize>::new();
        found.iter().for_each(|option| *counts.entry(option.row.clone()).or_default() += 1);
        let mut options = Vec::<SharedOption>::new();
        for option in found.into_iter().filter(|option| counts[&option.row] > 1) {
            match options.iter_mut().find(|other| other.name == option.name) {
                None => options.push(option),
                Some(other) if counts[&other.row] < counts[&option.row] => *other = option,
                Some(_) => {}
            }
        }
        Self { of_all, options }
    }

    fn has(&self, row: &str) -> bool {
        self.options.iter().any(|option| option.row == row)
    }

    /// The options under each heading; those that help lists under none come first.
    fn groups(&self) -> Vec<(&str, Vec<&SharedOption>)> {
        let mut groups = vec![(SHARED, Vec::new())];
        for option in &self.options {
            match groups.iter_mut().find(|(heading, _)| *heading == option.heading) {
                None => groups.push((option.heading.as_str(), vec![option])),
                Some((_, options)) => options.push(option),
            }
        }
        groups
    }

    /// For each group of which a command with these `rows` has options, a line that names them and leads to the group.
    fn lines(&self, rows: &[String]) -> Vec<String> {
        let mut lines = Vec::new();
        for (heading, options) in self.groups() {
            let had = options.iter().filter(|option| rows.contains(&option.row));
            let names: Vec<_> = had.map(|option| format!("`{}`", option.name)).collect();
            if !names.is_empty() {
                let anchor = heading.to_lowercase().replace(' ', "-");
                lines.push(format!("| {} | [{heading}](#{anchor}) |", names.join(", ")));
            }
        }
        lines
    }
}

/// The options of `command` and of its subcommands.
fn collect(command: &Command, of_all: &[Id], found: &mut Vec<SharedOption>) {
    if command.is_hide_set() {
        return;
    }
    for argument in shown(command).filter(|argument| !of_all.contains(argument.get_id())) {
        if let Some(long) = argument.get_long() {
            let heading = argument.get_help_heading().unwrap_or(SHARED).to_owned();
            found.push(SharedOption { heading, name: format!("--{long}"), row: row(argument) });
        }
    }
    command.get_subcommands().for_each(|inner| collect(inner, of_all, found));
}

/// A command, without the options that all commands share, then its subcommands.
fn section(command: &Command, before: &str, shared: &Shared, page: &mut String) {
    if command.is_hide_set() {
        return;
    }
    let name = format!("{before} {}", command.get_name());
    let about = command.get_long_about().or(command.get_about()).map(ToString::to_string).unwrap_or_default();
    let usage = command.clone().render_usage().to_string();
    let usage = usage.trim_start_matches("Usage: ");
    // Writing to a string cannot fail.
    let _ = write!(page, "\n## {name}\n\n{about}\n\n```text\n{usage}\n```\n");
    let is_of_all = |argument: &&Arg| shared.of_all.contains(argument.get_id());
    let rows: Vec<_> = shown(command).filter(|argument| !is_of_all(argument)).map(row).collect();
    let own = rows.iter().filter(|row| !shared.has(row)).cloned();
    let lines: Vec<_> = own.chain(shared.lines(&rows)).collect();
    if !lines.is_empty() {
        let _ = write!(page, "\n{}", table(&lines));
    }
    for inner in command.get_subcommands() {
        section(inner, &name, shared, page);
    }
}

/// The arguments of a command that the help shows.
fn shown(command: &Command) -> impl Iterator<Item = &Arg> {
    let is_shown = |argument: &&Arg| {
        !["help", "version"].contains(&argument.get_id().as_str()) && !argument.is_hide_set()
    };
    command.get_arguments().filter(is_shown)
}

fn table(rows: &[String]) -> String {
    format!("| | |\n|---|---|\n{}\n", rows.join("\n"))
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

#[cfg(test)]
mod tests {
    use super::*;

    fn option(name: &'static str, help: &'static str) -> Arg {
        Arg::new(name).long(name).value_name("X").help(help)
    }

    #[test]
    fn what_several_commands_have_stands_once_and_each_names_it() {
        let lens = |help| option("lens", help).help_heading("The lens");
        let program = Command::new("p")
            .arg(option("log", "All have it").global(true))
            .subcommand(Command::new("a").arg(option("seed", "Its own")).arg(lens("A lens")))
            .subcommand(Command::new("b").arg(option("seed", "Of two")).arg(lens("A lens")))
            .subcommand(Command::new("c").arg(option("seed", "Of two")).arg(option("d", "Of c alone")));
        let page = page("# P\n", program);
        let (top, commands) = page.split_once("\n## p a\n").unwrap();
        assert_eq!(
            top,
            "# P\n\n## Every command\n\n| | |\n|---|---|\n| `--log X` | All have it |\n\n## Options of several commands\n\n\
             | | |\n|---|---|\n| `--seed X` | Of two |\n\n### The lens\n\n| | |\n|---|---|\n| `--lens X` | A lens |\n"
        );
        let shared = "[Options of several commands](#options-of-several-commands)";
        for rows in [
            "| `--seed X` | Its own |\n| `--lens` | [The lens](#the-lens) |\n".to_owned(),
            format!("|---|---|\n| `--seed` | {shared} |\n| `--lens` | [The lens](#the-lens) |\n"),
            format!("| `--d X` | Of c alone |\n| `--seed` | {shared} |\n"),
        ] {
            assert!(commands.contains(&rows), "{rows}{commands}");
        }
    }
}
