//! Which options a call gives, and which of them have no effect in it.
//!
//! An option that has no effect beside another one is refused on the command line, since the caller wants what it says. From
//! the environment or the settings, which are the same for every call, it is ignored.

use std::path::Path;

use clap::builder::TypedValueParser;
use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, Args, Command, FromArgMatches};
use halfrow_program::choice::one_of;

use halfrow::call::{self, VoidOption};

/// The options of a call, by their clap ids, that come from the command line or the environment, including those of its command.
///
/// It must be the first field of a command's arguments: the code that clap derives takes each field's values out of the
/// matches, and with them where they come from.
#[derive(Clone, Debug, Default)]
pub(crate) struct Given {
    flags: Vec<String>,
    variables: Vec<String>,
}

/// What makes options void.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(test, derive(clap::ValueEnum))]
pub(crate) enum Decider {
    /// A recording that is judged again.
    Recording,
    /// A recording that is made.
    Record,
    /// A list of what would be streamed, without a run.
    List,
    /// A table file, whatever it holds.
    Tables,
    /// A time limit, by which the frames are chosen.
    Within,
    /// The model, which corrects without a board.
    Model,
    /// Frames of which none is a file.
    NoFrameFile,
    /// Samples without a header.
    Headerless,
    /// Frames that are written, without tables.
    MadeFrames,
    /// Tables that are written, which suit every phase.
    MadeTables,
    /// A lens whose figures are shown, which suit every sample.
    ShownLens,
    /// Items of which none uses a board.
    NoBoardItem,
    /// Items of which none uses the paper's photographs.
    NoPhotographItem,
    /// Items without Fig. 4.
    NoFigure4,
    /// Items without the FPGA's resources.
    NoSynthesisItem,
}

/// Options that tables are made from, and that a table file has too. They are accepted beside a file if both agree.
pub(crate) const IN_TABLE_FILES: [&str; 4] = ["width", "height", "bits", "centre_x"];

/// Options that only serve to make tables, or to render built-in frames through their lens.
const LENS: [&str; 11] = [
    "lens",
    "lens_pitch",
    "rows",
    "projection",
    "entries",
    "nodes_every",
    "radius",
    "focal_length",
    "pixel_pitch",
    "field_of_view",
    "centre_y",
];

/// The options of a run that change nothing about what it streams.
const RUN: [&str; 10] = [
    "report",
    "record",
    "operator",
    "overwrite",
    "require_hardware",
    "fail_fast",
    "reconnect",
    "timeout",
    "retry_limit",
    "take_over",
];

/// The options of a board.
const BOARD: [&str; 4] = ["board", "timeout", "retry_limit", "take_over"];

impl Decider {
    /// `argument`, left out of the help if it has no effect beside this in any call of its command.
    pub(crate) fn hides(self, argument: Arg) -> Arg {
        let is_void = self.voids().contains(&argument.get_id().as_str());
        argument.hide(is_void)
    }

    /// The ids of the options that have no effect beside it.
    fn voids(self) -> Vec<&'static str> {
        let options: &[&[&str]] = match self {
            Self::Recording => &[call::BESIDE_RECORDING.options, &IN_TABLE_FILES, &LENS],
            Self::Record => &[call::WHILE_RECORDED.options],
            Self::List => &[&RUN],
            Self::Tables => &[&LENS],
            Self::Within => &[call::WITHIN.options],
            Self::Model | Self::NoBoardItem => &[&BOARD],
            Self::NoPhotographItem => &[&["images"]],
            Self::NoFigure4 => &[&["photograph", "lines"]],
            Self::NoSynthesisItem => &[&["synthesis"]],
            Self::NoFrameFile => &[&["raw", "fit"]],
            Self::Headerless => &[&["fit"]],
            Self::MadeFrames => &[&["rows", "projection", "entries", "nodes_every"]],
            Self::MadeTables => &[&["phase"]],
            Self::ShownLens => &[&["phase", "bits"]],
        };
        options.concat()
    }

    /// Why, as the words after the option's name.
    fn reason(self) -> &'static str {
        match self {
            Self::Recording => call::BESIDE_RECORDING.reason,
            Self::Record => call::WHILE_RECORDED.reason,
            Self::List => {
                "does nothing beside --list, which lists what would be streamed and runs nothing; give one of them"
            }
            Self::Tables => {
                "cannot be used together with --tables, whose file holds the tables; give one of them"
            }
            Self::Within => call::WITHIN.reason,
            Self::Model => "does nothing beside --model, which corrects without a board; give one of them",
            Self::NoFrameFile => "is for frames that are files, and none is; leave it out, or name a file",
            Self::Headerless => "does nothing beside --raw, whose samples are never scaled; give one of them",
            Self::MadeFrames => "says how tables are made, and a frame has none; leave it out",
            Self::MadeTables => {
                "changes nothing about tables; leave it out, and give it to the command that uses them"
            }
            Self::ShownLens => "changes nothing about a lens's figures; leave it out",
            Self::NoBoardItem => {
                "does nothing, since no item that is asked for goes through a board; leave it out, or add delay, or name \
                 a board for table1"
            }
            Self::NoPhotographItem => {
                "does nothing, since no item that is asked for takes them; leave it out, or add fig12 or table1"
            }
            Self::NoFigure4 => "is for fig4, which is not asked for; leave it out, or add fig4",
            Self::NoSynthesisItem => {
                "is for resources, which are not asked for; leave it out, or add resources"
            }
        }
    }
}

impl Given {
    /// Whether the command line gives the option `id`.
    pub(crate) fn is_flag(&self, id: &str) -> bool {
        self.flags.iter().any(|flag| flag == id)
    }

    /// The first option on the command line that is void beside `decider`, as it is written there.
    pub(crate) fn void_flag(&self, decider: Decider) -> Option<String> {
        decider.voids().into_iter().find(|id| self.is_flag(id)).map(written)
    }

    /// Where the value of the option `id` comes from, if not from the command line: the environment, or else the settings file
    /// `settings`, which has these `keys`.
    pub(crate) fn place(&self, id: &str, settings: Option<&Path>, keys: &[&str]) -> Option<String> {
        if self.is_flag(id) {
            return None;
        }
        if self.variables.iter().any(|variable| variable == id) {
            return Some(format!("HALFROW_{} in the environment", id.to_ascii_uppercase()));
        }
        let settings = settings.filter(|_| keys.contains(&id))?;
        Some(format!("`{id}` in the settings file {}", settings.display()))
    }

    /// Refuses a flag that is void beside `decider`. For void values from the environment, or from the settings, which have the
    /// keys `settings`, there is only a line in the log.
    pub(crate) fn refuse_void(&self, decider: Decider, settings: &[&str]) -> Result<(), VoidOption> {
        if let Some(option) = self.void_flag(decider) {
            return Err(VoidOption { option, reason: decider.reason() });
        }
        for id in decider.voids() {
            let of_variable = self.variables.iter().any(|variable| variable == id);
            if of_variable || settings.contains(&id) {
                let place = if of_variable { "the environment" } else { "the settings" };
                tracing::info!("{} of {place} is passed over: it {}", written(id), decider.reason());
            }
        }
        Ok(())
    }
}

/// Reads the value of a yes-or-no option, which may also come from the environment.
pub(crate) fn yes_or_no() -> impl TypedValueParser<Value = bool> {
    one_of(["yes", "no"], truth)
}

fn truth(text: &str) -> Result<bool, String> {
    match text.to_ascii_lowercase().as_str() {
        "1" | "yes" | "y" | "true" | "t" | "on" => Ok(true),
        "0" | "no" | "n" | "false" | "f" | "off" => Ok(false),
        _ => Err("say yes or no".to_owned()),
    }
}

/// An option as it is written on the command line.
pub(crate) fn written(id: &str) -> String {
    format!("--{}", id.replace('_', "-"))
}

/// The id of an option that is `written` like this on the command line.
pub(crate) fn id(written: &str) -> String {
    written.trim_start_matches('-').replace('-', "_")
}

/// Written by hand, since clap's derived code does not say where a value comes from.
impl FromArgMatches for Given {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let levels: Vec<_> =
            std::iter::successors(Some(matches), |matches| matches.subcommand().map(|(_, below)| below))
                .collect();
        let from = |source| {
            let given = |matches: &&ArgMatches| {
                let ids = matches.ids().map(clap::Id::as_str);
                ids.filter(|id| matches.value_source(id) == Some(source))
                    .map(str::to_owned)
                    .collect::<Vec<_>>()
            };
            levels.iter().flat_map(given).collect()
        };
        Ok(Self { flags: from(ValueSource::CommandLine), variables: from(ValueSource::EnvVariable) })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Args for Given {
    fn augment_args(command: Command) -> Command {
        command
    }

    fn augment_args_for_update(command: Command) -> Command {
        command
    }
}

#[cfg(test)]
mod tests {
    use clap::ValueEnum as _;

    use super::*;
    use crate::commands::Cli;

    /// The ids of a command's own options.
    fn options(command: &str) -> Vec<String> {
        let line = Cli::line();
        let command = line.find_subcommand(command).unwrap();
        command.get_arguments().map(|argument| argument.get_id().to_string()).collect()
    }

    /// [`Given::place`] relies on this.
    #[test]
    fn a_variable_is_called_as_its_option() {
        fn check(command: &Command) {
            let arguments = command.get_arguments();
            for (id, variable) in arguments.filter_map(|it| Some((it.get_id().as_str(), it.get_env()?))) {
                assert_eq!(variable, format!("HALFROW_{}", id.to_ascii_uppercase()).as_str());
            }
            command.get_subcommands().for_each(check);
        }
        check(&Cli::line());
    }

    /// Checks that every option of `verify` is void beside `decider` or does something there. A new one has to be assigned.
    fn assigned(decider: Decider, do_something: &[&str]) {
        let mut decided: Vec<&str> = decider.voids();
        decided.extend(do_something);
        decided.sort_unstable();
        let mut options = options("verify");
        options.sort_unstable();
        assert_eq!(options, decided, "{decider:?}");
    }

    #[test]
    fn every_option_of_verify_is_void_or_does_something_beside_a_recording() {
        let stand =
            ["board", "report", "record", "operator", "overwrite", "require_hardware", "list", "timeout"];
        assigned(Decider::Recording, &stand);
    }

    #[test]
    fn every_option_of_verify_is_void_or_does_something_beside_a_list() {
        // `within` is refused by clap already.
        let of_the_plan =
            ["frame", "repeat", "at_speed", "within", "tables", "kernel", "phase", "raw", "fit", "seed"];
        assigned(Decider::List, &[&["board", "list"], &of_the_plan[..], &IN_TABLE_FILES, &LENS].concat());
    }

    #[test]
    fn options_that_are_void_exist() {
        for decider in Decider::value_variants() {
            let command = match decider {
                Decider::Recording | Decider::Record | Decider::List | Decider::Tables | Decider::Within => {
                    "verify"
                }
                Decider::Model | Decider::NoFrameFile | Decider::Headerless => "correct",
                Decider::MadeFrames => "frames",
                Decider::MadeTables => "tables",
                Decider::ShownLens => "lens",
                Decider::NoBoardItem
                | Decider::NoPhotographItem
                | Decider::NoFigure4
                | Decider::NoSynthesisItem => "paper",
            };
            let known = options(command);
            assert!(decider.voids().iter().all(|id| known.iter().any(|known| known == id)), "{decider:?}");
        }
    }
}
