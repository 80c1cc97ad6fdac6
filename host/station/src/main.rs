//! The `halfrow-station` program: reads the command line, runs one command, and exits with its code.

use std::process::ExitCode;

use clap::CommandFactory as _;
use halfrow_program::built::Built;
use halfrow_program::{console, exit::Exit, guard, line, log};
use halfrow_station::commands::{self, Cli, Failure};

const BUILT: Built = Built { features: &[], licences: include_str!("../licences.txt") };

fn main() -> ExitCode {
    guard::end(program)
}

fn program() -> Exit {
    let cli = match line::read::<Cli>(std::env::args_os()) {
        Ok(cli) => cli,
        Err(told) => {
            let told = line::tell(&told, &Cli::command(), BUILT);
            return told.unwrap_or_else(|unprinted| explain(&Failure::error(unprinted), None));
        }
    };
    log::to_stderr(cli.verbosity());
    let ended = guard::guarded(|| cli.run()).unwrap_or_else(|fault| Err(Failure::error(fault)));
    ended.unwrap_or_else(|failure| explain(&failure, cli.documented()))
}

/// Says why there is no result, also as JSON if the call asked for it.
fn explain(failure: &Failure, as_json_of: Option<&str>) -> Exit {
    let document = as_json_of.map(|command| commands::failure(command, failure));
    console::explain(&failure.problem(), document.as_deref());
    failure.exit
}
