//! The `halfrow` program: reads the command line, runs one command, and exits with its code.

use std::process::ExitCode;

use clap::Parser;
use tracing::level_filters::LevelFilter;

use halfrow::commands::{self, Cli, Failure};
use halfrow::verdict::Exit;

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(told) => return tell(&told),
    };
    let level = match cli.verbosity() {
        0 => LevelFilter::WARN,
        1 => LevelFilter::INFO,
        _ => LevelFilter::DEBUG,
    };
    tracing_subscriber::fmt()
        .with_max_level(level)
        .with_writer(std::io::stderr)
        .with_ansi(false)
        .without_time()
        .with_target(false)
        .init();
    let exit =
        cli.run().unwrap_or_else(|failure| explain(&failure, cli.wants_json().then(|| cli.command_name())));
    ExitCode::from(exit.code())
}

/// Tells what the command line's reader has to tell, and a call that is wrong as JSON as well where that is asked for.
fn tell(told: &clap::Error) -> ExitCode {
    let arguments: Vec<_> =
        std::env::args_os().map(|argument| argument.to_string_lossy().into_owned()).collect();
    if let Some(document) = commands::usage(told, &arguments) {
        anstream::println!("{document}");
    }
    told.exit()
}

/// Says why there is no result: on stderr for people, and as JSON on stdout where that was asked for.
fn explain(failure: &Failure, as_json_of: Option<&str>) -> Exit {
    let Failure { exit, error } = failure;
    anstream::eprintln!("error: {error:#}");
    if let Some(command) = as_json_of {
        anstream::println!("{}", commands::failure(command, failure));
    }
    *exit
}
