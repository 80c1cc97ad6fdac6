//! The command line: one file per command.

mod beginning;
mod board;
mod check;
mod codes;
mod demo;
mod document;
mod evidence;
mod export;
mod fetching;
mod history;
mod job;
mod kept;
mod lane;
mod lanes;
mod lang_check;
mod looking;
mod manual;
mod notify;
mod outbox;
mod overview;
mod pareto;
mod plan;
mod plant;
mod progress;
mod publish;
mod rebind;
pub(crate) mod refusals;
mod run;
mod schema;
mod serve;
mod token;
mod unit;
mod user;
mod waive;
mod why;
mod work;
mod yields;

use clap::{ArgAction, Parser, Subcommand};

use document::Asked;
pub use document::failure;
use halfrow::result::Problem;
use halfrow::words::plain_lines;

use crate::console::{self, Unprinted};
use crate::exit::Exit;
use crate::input_error::InputError;
use crate::outbox::OutboxError;
use crate::plan::serial::SerialError;
use crate::published::{BundleError, FetchError, SigningError};
use crate::secret::SecretError;
use crate::settings::PlantSettingsError;
use crate::store::{PlantError, StoreError};
use crate::web::{TokenError, UserError};

/// Judges boards on a production line by plans, and keeps every result.
#[derive(Debug, Parser)]
#[command(name = "halfrow-station", version = halfrow::VERSION, propagate_version = true, max_term_width = 100)]
pub struct Cli {
    #[command(flatten)]
    asked: Asked,
    /// Log what happens to stderr; twice for every packet that is late or damaged. With --version: tell
    /// what the program was built from
    #[arg(short, long, global = true, action = ArgAction::Count)]
    verbose: u8,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Run(run::Arguments),
    Check(check::Arguments),
    History(history::Arguments),
    Unit(unit::Arguments),
    Yield(yields::Arguments),
    Pareto(pareto::Arguments),
    Waive(waive::Arguments),
    Export(export::Arguments),
    Evidence(evidence::Arguments),
    Backup(kept::Backup),
    Restore(kept::Restore),
    Prune(kept::Prune),
    Plan(plan::Arguments),
    Plant(plant::Arguments),
    Outbox(outbox::Arguments),
    Work(work::Arguments),
    Job(job::Arguments),
    Board(board::Arguments),
    Rebind(rebind::Arguments),
    Lanes(lanes::Arguments),
    LangCheck(lang_check::Arguments),
    Codes(codes::Arguments),
    Commands(overview::Arguments),
    Schema(schema::Arguments),
    Serve(serve::Arguments),
    Demo(demo::Arguments),
    User(user::Arguments),
    Token(token::Arguments),
    Completions(manual::Completions),
    Manual(manual::Manual),
    Lane(lane::Arguments),
}

/// A command that came to no result.
#[derive(Debug)]
pub struct Failure {
    /// The exit code.
    pub exit: Exit,
    /// Why, with its causes.
    pub error: anyhow::Error,
    /// Whether the call is refused, so that what its error asks for does not fit if the system alone is the cause.
    is_refusal: bool,
}

impl Failure {
    /// A failure of the call or of its input, unless the system alone is its cause.
    fn call(error: impl Into<anyhow::Error>) -> Self {
        let error = error.into();
        Self { is_refusal: true, ..Self::of(Exit::of_refusal(error.as_ref()), error) }
    }

    /// A failure that is not the caller's.
    pub fn error(error: impl Into<anyhow::Error>) -> Self {
        Self::of(Exit::Error, error)
    }

    /// A failure with this exit code.
    fn of(exit: Exit, error: impl Into<anyhow::Error>) -> Self {
        Self { exit, error: error.into(), is_refusal: false }
    }

    /// Why, with what to do about it.
    #[must_use]
    pub fn problem(&self) -> Problem {
        let problem = crate::codes::problem(self.exit, &self.error);
        if self.is_refusal { problem.of_refusal(self.error.as_ref()) } else { problem }
    }
}

impl Cli {
    /// How much to log: 0 for errors and warnings only.
    #[must_use]
    pub fn verbosity(&self) -> u8 {
        self.verbose
    }

    /// The command's name, if it was asked for a document.
    #[must_use]
    pub fn documented(&self) -> Option<&str> {
        self.asked.command.as_deref()
    }

    /// Runs the command.
    ///
    /// # Errors
    /// [`Failure`] with its exit code, when there is no result.
    pub fn run(&self) -> Result<Exit, Failure> {
        match &self.command {
            Command::Run(arguments) => run::run(arguments),
            Command::Check(arguments) => check::run(arguments),
            Command::History(arguments) => history::run(arguments),
            Command::Unit(arguments) => unit::run(arguments),
            Command::Yield(arguments) => yields::run(arguments),
            Command::Pareto(arguments) => pareto::run(arguments),
            Command::Waive(arguments) => waive::run(arguments),
            Command::Export(arguments) => export::run(arguments),
            Command::Evidence(arguments) => evidence::run(arguments),
            Command::Backup(arguments) => kept::backup(arguments),
            Command::Restore(arguments) => kept::restore(arguments),
            Command::Prune(arguments) => kept::prune(arguments),
            Command::Plan(arguments) => plan::run(arguments),
            Command::Plant(arguments) => plant::run(arguments),
            Command::Outbox(arguments) => outbox::run(arguments),
            Command::Work(arguments) => work::run(arguments),
            Command::Job(arguments) => job::run(arguments),
            Command::Board(arguments) => board::run(arguments),
            Command::Rebind(arguments) => rebind::run(arguments),
            Command::Lanes(arguments) => lanes::run(arguments),
            Command::LangCheck(arguments) => lang_check::run(arguments),
            Command::Codes(arguments) => codes::run(arguments),
            Command::Commands(arguments) => {
                overview::run(arguments, <Self as clap::CommandFactory>::command())
            }
            Command::Schema(arguments) => schema::run(arguments),
            Command::Serve(arguments) => serve::run(arguments),
            Command::Demo(arguments) => demo::run(arguments),
            Command::User(arguments) => user::run(arguments),
            Command::Token(arguments) => token::run(arguments),
            Command::Completions(arguments) => manual::complete(arguments),
            Command::Manual(arguments) => manual::write(arguments),
            Command::Lane(arguments) => lane::run(arguments),
        }
    }
}

/// Errors with the same exit code whichever command meets them.
macro_rules! failures {
    ($($exit:ident: $($error:ty),+;)+) => {$($(
        impl From<$error> for Failure {
            fn from(error: $error) -> Self {
                Self::$exit(error)
            }
        }
    )+)+};
}

failures! {
    call: BundleError, InputError, PlantSettingsError, SecretError, SerialError, SigningError, TokenError, UserError;
    error: FetchError, OutboxError, PlantError, Unprinted;
}

impl From<StoreError> for Failure {
    fn from(error: StoreError) -> Self {
        let exit = match error {
            StoreError::InUse { .. } => Exit::Busy,
            StoreError::NoResults { .. } | StoreError::Path { .. } => Exit::Usage,
            _ => Exit::Error,
        };
        Self::of(exit, error)
    }
}

/// Prints a result, which is the command's only one.
fn print(text: &str) -> Result<Exit, Failure> {
    console::print(text)?;
    Ok(Exit::Pass)
}

/// Tells in one line, whatever names it holds, of what is done, and stays done though stdout takes nothing: whoever took it for failed
/// would do it again.
fn tell(line: &str) -> Exit {
    console::tell_line(line);
    Exit::Pass
}

/// The same in several lines.
fn tell_lines<T: AsRef<str>>(lines: impl IntoIterator<Item = T>) -> Exit {
    console::tell(&plain_lines(lines));
    Exit::Pass
}
