//! The `halfrow-station` program: reads the command line, runs one command, and exits with its code.

use std::process::ExitCode;

use clap::Parser;
use tracing::level_filters::LevelFilter;

use halfrow_station::commands::{Cli, Failure};
use halfrow_station::console;

fn main() -> ExitCode {
    let cli = Cli::parse();
    log(cli.verbosity());
    let exit = cli.run().unwrap_or_else(|Failure { exit, error }| {
        console::error(&format_args!("{error:#}"));
        exit
    });
    ExitCode::from(exit.code())
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
