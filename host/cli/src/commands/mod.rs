//! The command line: one file a command.

mod board;
mod boards;
mod completions;
mod correct;
mod faults;
mod frames;
mod info;
mod inputs;
mod kernel;
mod lens;
mod link;
mod optics;
mod paper;
mod serve;
mod table_file;
mod tables;
mod verify;

use std::path::PathBuf;

use clap::{ArgAction, CommandFactory, Parser, Subcommand};
use halfrow_model::ModelPath;

use crate::exit::Exit;
use crate::settings::Settings;
use halfrow::board::BoardError;
use halfrow::link::OpenError;
use halfrow::reference;
use halfrow::run::Misfit;

/// What every command is given beside its own arguments.
pub struct Context {
    /// The settings file, if there is one.
    pub settings: Settings,
    /// No progress.
    pub quiet: bool,
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
    Faults(faults::Arguments),
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
    pub(crate) fn error(error: impl Into<anyhow::Error>) -> Self {
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
        match &self.command {
            Command::Verify(arguments) => arguments.json,
            Command::Correct(arguments) => arguments.json,
            Command::Paper(arguments) => arguments.json,
            Command::Kernel(arguments) => arguments.wants_json(),
            Command::Lens(arguments) => arguments.json,
            Command::Boards(arguments) => arguments.json,
            Command::Info(arguments) => arguments.json,
            Command::Link(arguments) => arguments.json,
            _ => false,
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
        let context = Context { settings, quiet: self.quiet };
        match &self.command {
            Command::Verify(arguments) => verify::run(arguments, &context),
            Command::Correct(arguments) => correct::run(arguments, &context),
            Command::Tables(arguments) => tables::run(arguments),
            Command::Lens(arguments) => lens::run(arguments),
            Command::Kernel(arguments) => kernel::run(arguments, &context),
            Command::Paper(arguments) => paper::run(arguments, &context),
            Command::Frames(arguments) => frames::run(arguments),
            Command::Boards(arguments) => boards::run(arguments),
            Command::Info(arguments) => info::run(arguments, &context),
            Command::Link(arguments) => link::run(arguments, &context),
            Command::Serve(arguments) => serve::run(arguments),
            Command::Faults(arguments) => faults::run(arguments),
            Command::Completions(arguments) => completions::complete(arguments, &mut Self::command()),
            Command::Manual(arguments) => completions::manual(arguments, Self::command()),
        }
    }
}

/// Prints a JSON result to stdout.
fn print_json(result: &impl serde::Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(result).map_err(Failure::error)?;
    print(&text)
}

/// Prints a result to stdout. A reader that went away, as `head` does, has seen enough.
fn print(text: &str) -> Result<(), Failure> {
    use std::io::Write;
    match writeln!(anstream::stdout().lock(), "{text}") {
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
        written => written.map_err(Failure::error),
    }
}
