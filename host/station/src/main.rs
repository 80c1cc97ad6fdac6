//! The `halfrow-station` program: reads the command line, runs one command, and exits with its code.

use std::process::ExitCode;

use clap::Parser as _;
use halfrow_program::{console, exit::Exit, guard, line, log};
use halfrow_station::commands::{Cli, Failure};

fn main() -> ExitCode {
    guard::end(program)
}

fn program() -> Exit {
    let ended = match Cli::try_parse() {
        Ok(cli) => {
            log::to_stderr(cli.verbosity());
            cli.run()
        }
        Err(told) => line::tell(&told).map_err(Failure::error),
    };
    ended.unwrap_or_else(|Failure { exit, error }| {
        console::error(&format_args!("{error:#}"));
        exit
    })
}
