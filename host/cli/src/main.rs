//! The `halfrow` program: reads the command line, runs one command, and exits with its code.

use std::process::ExitCode;

use halfrow_cli::commands::Cli;
use halfrow_cli::failure::Failure;
use halfrow_cli::signals;
use halfrow_program::built::Built;
use halfrow_program::exit::Exit;
use halfrow_program::{console, guard, line, log};

const BUILT: Built = Built {
    features: if cfg!(feature = "sim") { &["sim"] } else { &[] },
    licences: include_str!("../licences.txt"),
};

fn main() -> ExitCode {
    guard::end(program)
}

fn program() -> Exit {
    let cli = match Cli::read() {
        Ok(cli) => cli,
        Err(told) => {
            let told = line::tell(&told, &Cli::line(), BUILT);
            return told.unwrap_or_else(|unprinted| explain(&Failure::error(unprinted), None));
        }
    };
    log::to_stderr(cli.verbosity());
    let ended = guard::guarded(|| {
        signals::watch().map_err(Failure::error)?;
        cli.run()
    });
    let ended = ended.unwrap_or_else(|fault| Err(Failure::error(fault)));
    ended.unwrap_or_else(|failure| explain(&failure, cli.wants_json().then(|| cli.command_name())))
}

/// Says why there is no result, also as JSON if the call asked for it.
fn explain(failure: &Failure, as_json_of: Option<&str>) -> Exit {
    let document = as_json_of.map(|command| failure.document(command));
    console::explain(&failure.problem(), document.as_deref());
    failure.exit
}
