//! The commands: one file each, with the name of the command. `overview` is `halfrow commands`, `completions` also has `manual`,
//! and `line` has the grammar of all.

mod boards;
pub(crate) mod codes;
mod completions;
mod correct;
mod explain;
mod faults;
mod frames;
mod info;
mod kernel;
mod lens;
mod line;
mod link;
mod load;
mod overview;
mod paper;
mod schema;
mod serve;
mod soak;
mod station;
mod tables;
mod verify;

use std::path::{Path, PathBuf};

use clap::CommandFactory as _;

use crate::arguments::board::{self, Replays};
use crate::arguments::given;
use crate::call_error::CallError;
use crate::console;
use crate::exit::Exit;
use crate::failure::Failure;
use crate::progress::{self, ChildOutput};
use crate::settings::Settings;
use halfrow::board::BoardError;
use halfrow::call::Files;
use halfrow::link::OpenError;
use halfrow::progress::Progress;
use halfrow::reference;

use line::{Command, Line};

/// What every command gets beside its own arguments.
pub(crate) struct Context {
    /// The values of the settings file; the default without one.
    pub(crate) settings: Settings,
    /// The path of that file, whether it exists or not.
    pub(crate) settings_file: Option<PathBuf>,
    /// Whether to show no progress.
    pub(crate) quiet: bool,
    /// Whether the result is wanted as JSON.
    pub(crate) json: bool,
}

impl Context {
    /// Where a run tells its progress: stderr, unless nobody is to see it or a program reads the result.
    pub(crate) fn progress(&self) -> Box<dyn Progress> {
        progress::for_stderr(self.hides_progress())
    }

    /// The list of what a call reads and writes, with the settings file.
    pub(crate) fn files(&self, overwrite: bool) -> Files {
        Files::new(overwrite).reads(&self.settings_file)
    }

    /// Where the output of a program that this one starts is shown, by the same rule.
    fn child_output(&self) -> ChildOutput {
        ChildOutput::on_stderr(self.hides_progress())
    }

    fn hides_progress(&self) -> bool {
        self.quiet || self.json
    }
}

/// A call of the program.
#[derive(Debug)]
pub struct Cli(Line<Command>);

impl Cli {
    /// The call on this program's command line.
    ///
    /// # Errors
    /// What is wrong with the call, or the help or version that it asks for.
    pub fn read() -> Result<Self, clap::Error> {
        Line::read().map(Self)
    }

    /// The grammar of the command line.
    #[must_use]
    pub fn line() -> clap::Command {
        Line::<Command>::command()
    }

    /// How much to log: 0 for errors and warnings only.
    #[must_use]
    pub fn verbosity(&self) -> u8 {
        self.0.verbose
    }

    /// Whether the result is wanted as JSON.
    #[must_use]
    pub fn wants_json(&self) -> bool {
        self.0.json
    }

    /// The command that was given.
    #[must_use]
    pub fn command_name(&self) -> &'static str {
        self.0.command.name()
    }

    /// Carries out the command.
    ///
    /// # Errors
    /// [`Failure`] with its exit code, when there is no result to print.
    pub fn run(&self) -> Result<Exit, Failure> {
        if let Command::Station(_) = self.0.command {
            station::refuse_ours(&self.0.given)?;
        }
        let settings = Settings::load(self.0.settings.as_deref())
            .map_err(|error| self.placed(Failure::call(error).in_value_of("--settings"), None, &[]))?;
        let path = reference::choose(self.0.model_path).map_err(Failure::call)?;
        tracing::info!("the model takes the path {path}");
        let settings_file = Settings::file(self.0.settings.as_deref());
        let context = Context { settings, settings_file, quiet: self.0.quiet, json: self.0.json };
        if context.json && !has_document(&self.0.command) {
            let command = self.command_name();
            return Err(Failure::call(CallError::NoJson { command }));
        }
        self.carried_out(&context).map_err(|failure| {
            self.placed(
                self.unjudged(self.of_known_kind(failure)),
                context.settings_file.as_deref(),
                &context.settings.keys(),
            )
        })
    }

    /// `failure`, naming the place that a wrong value comes from, if that is not the command line.
    fn placed(&self, failure: Failure, file: Option<&Path>, keys: &[&str]) -> Failure {
        let id = failure.option.filter(|_| failure.exit == Exit::Usage).map(given::id);
        match id.and_then(|id| self.0.given.place(&id, file, keys)) {
            Some(place) => {
                Failure { error: failure.error.context(format!("{place} cannot be used")), ..failure }
            }
            None => failure,
        }
    }

    /// `failure`, which offers the kinds of boards that the command takes if it is about a kind that there is not.
    fn of_known_kind(&self, mut failure: Failure) -> Failure {
        if let Some(OpenError::UnknownKind { known, .. }) = failure.error.downcast_mut() {
            *known = match self.0.command {
                Command::Verify(_) => board::forms(Replays::Yes),
                Command::Boards(_) | Command::Load(_) | Command::Serve(_) => board::own_forms(Replays::No),
                _ => board::forms(Replays::No),
            };
        }
        failure
    }

    /// `failure`, without a word about judging if the command judges nothing.
    fn unjudged(&self, failure: Failure) -> Failure {
        let judges = matches!(self.0.command, Command::Verify(_) | Command::Soak(_) | Command::Paper(_));
        match failure.error.downcast_ref() {
            Some(&BoardError::Stopped(by)) if !judges => {
                Failure { error: CallError::Stopped { by }.into(), ..failure }
            }
            _ => failure,
        }
    }

    fn carried_out(&self, context: &Context) -> Result<Exit, Failure> {
        match &self.0.command {
            Command::Verify(arguments) => verify::run(arguments, context),
            Command::Soak(arguments) => soak::run(arguments, context),
            Command::Correct(arguments) => correct::run(arguments, context),
            Command::Tables(arguments) => tables::run(arguments, context),
            Command::Lens(arguments) => lens::run(arguments, context),
            Command::Kernel(arguments) => kernel::run(arguments, context),
            Command::Paper(arguments) => paper::run(arguments, context),
            Command::Frames(arguments) => frames::run(arguments, context),
            Command::Boards(arguments) => boards::run(arguments, context),
            Command::Info(arguments) => info::run(arguments, context),
            Command::Link(arguments) => link::run(arguments, context),
            Command::Load(arguments) => load::run(arguments, context),
            Command::Serve(arguments) => serve::run(arguments),
            Command::Station(arguments) => station::run(arguments).map(|never| match never {}),
            Command::Faults(arguments) => faults::run(arguments, context),
            Command::Codes(arguments) => codes::run(arguments, context),
            Command::Commands(arguments) => overview::run(arguments, Line::<Command>::command()),
            Command::Explain(arguments) => explain::run(arguments, context),
            Command::Schema(arguments) => schema::run(arguments),
            Command::Completions(arguments) => {
                completions::complete(arguments, &mut Line::<Command>::command())
            }
            Command::Manual(arguments) => completions::manual(arguments, Line::<Command>::command(), context),
        }
    }
}

/// Whether the command has a result that is printed as JSON.
fn has_document(command: &Command) -> bool {
    match command {
        Command::Verify(_) | Command::Soak(_) | Command::Correct(_) | Command::Tables(_) => true,
        Command::Lens(_) | Command::Kernel(_) | Command::Paper(_) | Command::Frames(_) => true,
        Command::Boards(_) | Command::Info(_) | Command::Link(_) | Command::Load(_) => true,
        Command::Faults(_) | Command::Codes(_) | Command::Explain(_) | Command::Schema(_) => true,
        Command::Serve(_) | Command::Station(_) => false,
        Command::Commands(_) | Command::Completions(_) | Command::Manual(_) => false,
    }
}

/// Prints the result that `exit` sums up. If it cannot be printed, `exit` stands, unless it is a mere [`Exit::Pass`].
fn print_or_tell(exit: Exit, text: &str) -> Result<Exit, Failure> {
    if exit == Exit::Pass {
        print(text)?;
    } else {
        console::tell(text);
    }
    Ok(exit)
}

/// Prints a result, the only output of the command.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    console::print(text).map_err(Failure::error)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn progress_is_hidden_from_who_wants_none_and_from_programs() {
        for (quiet, json, hidden) in [(false, false, false), (true, false, true), (false, true, true)] {
            let context = Context { settings: Settings::default(), settings_file: None, quiet, json };
            assert_eq!(matches!(context.child_output(), ChildOutput::Nothing), hidden, "{quiet} {json}");
        }
    }
}
