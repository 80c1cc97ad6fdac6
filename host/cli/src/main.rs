//! The `halfrow` program: reads the command line, runs one command, and exits with its code.

use std::process::ExitCode;

use clap::Parser;
use serde_json::json;
use tracing::level_filters::LevelFilter;

use halfrow_cli::commands::{Cli, Failure};
use halfrow_cli::exit::Exit;
use halfrow_cli::flags;

fn main() -> ExitCode {
    let cli = Cli::parse();
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
    let exit = cli.run().unwrap_or_else(|failure| explain(&failure, cli.wants_json()));
    ExitCode::from(exit.code())
}

/// Says why there is no result: on stderr for people, and as JSON on stdout where that was asked for.
fn explain(failure: &Failure, as_json: bool) -> Exit {
    let Failure { exit, error } = failure;
    anstream::eprintln!("error: {}", flags::named(&format!("{error:#}")));
    if as_json {
        let result = json!({
            "verdict": exit.verdict(),
            "exit_code": exit.code(),
            "board": { "kind": null },
            "error": flags::named(&format!("{error:#}")),
        });
        anstream::println!("{result:#}");
    }
    *exit
}
