//! The command line: one file a command.

mod board;
mod boards;
mod codes;
mod completions;
mod correct;
mod document;
mod faults;
mod files;
mod frames;
mod given;
mod info;
mod inputs;
mod kernel;
mod lens;
mod link;
mod optics;
mod paper;
mod schema;
mod serve;
mod station;
mod table_file;
mod tables;
mod verify;

use std::path::PathBuf;

use clap::{ArgAction, CommandFactory, Parser, Subcommand};
use halfrow_model::ModelPath;

use crate::console;
use crate::exit::Exit;
use crate::settings::Settings;
use halfrow::board::BoardError;
use halfrow::link::OpenError;
use halfrow::reference;
use halfrow::run::Misfit;

pub use document::{failure, usage};

/// What every command is given beside its own arguments.
pub struct Context {
    /// The settings file, if there is one.
    pub settings: Settings,
    /// That file.
    pub settings_file: Option<PathBuf>,
    /// No progress.
    pub quiet: bool,
    /// The result is wanted as JSON.
    pub json: bool,
}

/// Validates a board that straightens fisheye Bayer video, bit for bit.
///
/// Without a board, `halfrow verify` judges the built-in mock board.
#[derive(Debug, Parser)]
#[command(name = "halfrow", version = halfrow::VERSION, propagate_version = true, max_term_width = 100)]
pub struct Cli {
    /// Log what happens on the link to stderr; twice for every packet that is late or damaged
    #[arg(short, long, global = true, action = ArgAction::Count)]
    verbose: u8,
    /// Show no progress
    #[arg(short, long, global = true)]
    quiet: bool,
    /// The settings file [default: halfrow/settings.toml in the user's configuration folder]
    #[arg(long, global = true, value_name = "FILE", env = "HALFROW_SETTINGS")]
    settings: Option<PathBuf>,
    /// How the model computes, always to the same bits: reference, scalar, avx2 or avx512 [default: the fastest here]
    #[arg(long, global = true, value_name = "PATH", env = "HALFROW_MODEL_PATH")]
    model_path: Option<ModelPath>,
    /// Print the result, or why there is none, as JSON; `halfrow schema` tells its shape
    #[arg(long, global = true)]
    json: bool,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Verify(verify::Arguments),
    Correct(correct::Arguments),
    Tables(tables::Arguments),
    Lens(lens::Arguments),
    Kernel(kernel::Arguments),
    Paper(paper::Arguments),
    Frames(frames::Arguments),
    Boards(boards::Arguments),
    Info(info::Arguments),
    Link(link::Arguments),
    Serve(serve::Arguments),
    Station(station::Arguments),
    Faults(faults::Arguments),
    Codes(codes::Arguments),
    Schema(schema::Arguments),
    Completions(completions::Completions),
    Manual(completions::Manual),
}

/// A command that did not come to a result.
#[derive(Debug)]
pub struct Failure {
    /// The exit code.
    pub exit: Exit,
    /// Why, with its causes.
    pub error: anyhow::Error,
}

impl Failure {
    /// A failure of the call or of its input.
    pub(crate) fn call(error: impl Into<anyhow::Error>) -> Self {
        Self { exit: Exit::Usage, error: error.into() }
    }

    /// A failure that is not the caller's.
    pub fn error(error: impl Into<anyhow::Error>) -> Self {
        Self { exit: Exit::Error, error: error.into() }
    }

    /// An input that is refused, as a board of another datapath is.
    pub(crate) fn refused(error: impl Into<anyhow::Error>) -> Self {
        Self { exit: Exit::Refused, error: error.into() }
    }
}

/// A call that cannot be carried out, for a reason in words.
macro_rules! wrong_call {
    ($($words:tt)*) => { $crate::commands::Failure::call(anyhow::anyhow!($($words)*)) };
}
use wrong_call;

impl From<OpenError> for Failure {
    fn from(error: OpenError) -> Self {
        Self { exit: error.class().into(), error: error.into() }
    }
}

impl From<BoardError> for Failure {
    fn from(error: BoardError) -> Self {
        Self { exit: error.cause().into(), error: error.into() }
    }
}

impl From<Misfit> for Failure {
    fn from(error: Misfit) -> Self {
        Self::call(error)
    }
}

impl Cli {
    /// How much to log: 0 for errors and warnings alone.
    #[must_use]
    pub fn verbosity(&self) -> u8 {
        self.verbose
    }

    /// Whether the result is wanted as JSON.
    #[must_use]
    pub fn wants_json(&self) -> bool {
        self.json
    }

    /// The command that was given.
    #[must_use]
    pub fn command_name(&self) -> &'static str {
        match &self.command {
            Command::Verify(_) => "verify",
            Command::Correct(_) => "correct",
            Command::Tables(_) => "tables",
            Command::Lens(_) => "lens",
            Command::Kernel(_) => "kernel",
            Command::Paper(_) => "paper",
            Command::Frames(_) => "frames",
            Command::Boards(_) => "boards",
            Command::Info(_) => "info",
            Command::Link(_) => "link",
            Command::Serve(_) => "serve",
            Command::Station(_) => "station",
            Command::Faults(_) => "faults",
            Command::Codes(_) => "codes",
            Command::Schema(_) => "schema",
            Command::Completions(_) => "completions",
            Command::Manual(_) => "manual",
        }
    }

    /// Carries the command out.
    ///
    /// # Errors
    /// [`Failure`] with its exit code, when there is no result to print.
    pub fn run(&self) -> Result<Exit, Failure> {
        let settings = Settings::load(self.settings.as_deref()).map_err(Failure::call)?;
        let path = reference::choose(self.model_path).map_err(Failure::call)?;
        tracing::info!("the model takes the path {path}");
        let settings_file = Settings::file(self.settings.as_deref());
        let context = Context { settings, settings_file, quiet: self.quiet, json: self.json };
        if context.json
            && matches!(
                self.command,
                Command::Serve(_) | Command::Station(_) | Command::Completions(_) | Command::Manual(_)
            )
        {
            let command = self.command_name();
            return Err(wrong_call!("`halfrow {command}` has no result in JSON; leave --json out"));
        }
        match &self.command {
            Command::Verify(arguments) => verify::run(arguments, &context),
            Command::Correct(arguments) => correct::run(arguments, &context),
            Command::Tables(arguments) => tables::run(arguments, &context),
            Command::Lens(arguments) => lens::run(arguments, &context),
            Command::Kernel(arguments) => kernel::run(arguments, &context),
            Command::Paper(arguments) => paper::run(arguments, &context),
            Command::Frames(arguments) => frames::run(arguments, &context),
            Command::Boards(arguments) => boards::run(arguments, &context),
            Command::Info(arguments) => info::run(arguments, &context),
            Command::Link(arguments) => link::run(arguments, &context),
            Command::Serve(arguments) => serve::run(arguments),
            Command::Station(arguments) => station::run(arguments).map(|never| match never {}),
            Command::Faults(arguments) => faults::run(arguments, &context),
            Command::Codes(arguments) => codes::run(arguments, &context),
            Command::Schema(arguments) => schema::run(arguments),
            Command::Completions(arguments) => completions::complete(arguments, &mut Self::command()),
            Command::Manual(arguments) => completions::manual(arguments, Self::command(), &context),
        }
    }
}

/// Prints what `exit` sums up. It stands if that cannot be printed, unless all that it says is that there was something to print.
fn conclude(exit: Exit, text: &str) -> Result<Exit, Failure> {
    if exit == Exit::Pass {
        print(text)?;
    } else {
        console::tell(text);
    }
    Ok(exit)
}

/// Prints a JSON result, which is the command's only one.
fn print_json(result: &impl serde::Serialize) -> Result<(), Failure> {
    print(&json_text(result)?)
}

fn json_text(result: &impl serde::Serialize) -> Result<String, Failure> {
    serde_json::to_string_pretty(result).map_err(Failure::error)
}

/// Prints a result, which is the command's only one.
fn print(text: &str) -> Result<(), Failure> {
    console::print(text).map_err(Failure::error)
}
