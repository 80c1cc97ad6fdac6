//! The `halfrow` program: reads the command line, runs one command, and exits with its code.

use std::process::ExitCode;

use tracing::level_filters::LevelFilter;

use halfrow_cli::commands::{self, Cli, Failure};
use halfrow_cli::exit::Exit;
use halfrow_cli::{console, flags, guard, signals};

fn main() -> ExitCode {
    let exit = guard::guarded(program).unwrap_or_else(|fault| {
        console::error(&fault);
        Exit::Error
    });
    ExitCode::from(exit.code())
}

fn program() -> Exit {
    let cli = match Cli::read() {
        Ok(cli) => cli,
        Err(told) => return tell(&told),
    };
    log(cli.verbosity());
    let ended = guard::guarded(|| {
        signals::watch().map_err(Failure::error)?;
        cli.run()
    });
    let ended = ended.unwrap_or_else(|fault| Err(Failure { exit: Exit::Error, error: fault.into() }));
    ended.unwrap_or_else(|failure| explain(&failure, cli.wants_json().then(|| cli.command_name())))
}

/// Tells what the command line's reader has to tell: help and version on stdout, what is wrong with a call on stderr, and
/// as JSON as well where that is asked for.
fn tell(told: &clap::Error) -> Exit {
    let text = told.render().ansi().to_string();
    if told.use_stderr() {
        console::diagnose_raw(&text);
        let arguments: Vec<_> =
            std::env::args_os().map(|argument| argument.to_string_lossy().into_owned()).collect();
        if let Some(document) = commands::usage(told, &arguments) {
            console::tell(&document);
        }
        return Exit::Usage;
    }
    match console::print_raw(&text) {
        Ok(()) => Exit::Pass,
        Err(unprinted) => explain(&Failure::error(unprinted), None),
    }
}

fn log(verbosity: u8) {
    let level = match verbosity {
        0 => LevelFilter::WARN,
        1 => LevelFilter::INFO,
        _ => LevelFilter::DEBUG,
    };
    tracing_subscriber::fmt()
        .with_max_level(level)
        .with_writer(|| console::Log)
        .log_internal_errors(false)
        .with_ansi(false)
        .without_time()
        .with_target(false)
        .init();
}

/// Says why there is no result: on stderr for people, and as JSON on stdout where that was asked for.
fn explain(failure: &Failure, as_json_of: Option<&str>) -> Exit {
    let Failure { exit, error } = failure;
    console::error(&flags::named(&format!("{error:#}")));
    if let Some(command) = as_json_of {
        console::tell(&commands::failure(command, failure));
    }
    *exit
}
