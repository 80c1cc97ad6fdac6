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
pub(crate) struct Decider {
    /// Lists of the ids of these options.
    voids: &'static [&'static [&'static str]],
    /// Why, as the words after the option's name.
    reason: &'static str,
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
    /// A recording that is judged again.
    pub(crate) const RECORDING: Self = Self {
        voids: &[call::BESIDE_RECORDING.options, &IN_TABLE_FILES, &LENS],
        reason: call::BESIDE_RECORDING.reason,
    };
    /// A recording that is made.
    pub(crate) const RECORD: Self =
        Self { voids: &[call::WHILE_RECORDED.options], reason: call::WHILE_RECORDED.reason };
    /// A list of what would be streamed, without a run.
    pub(crate) const LIST: Self = Self {
        voids: &[&RUN],
        reason: "does nothing beside --list, which lists what would be streamed and runs nothing; give one of them",
    };
    /// A table file, whatever it holds.
    pub(crate) const TABLES: Self = Self {
        voids: &[&LENS],
        reason: "cannot be used together with --tables, whose file holds the tables; give one of them",
    };
    /// A time limit, by which the frames are chosen.
    pub(crate) const WITHIN: Self = Self { voids: &[call::WITHIN.options], reason: call::WITHIN.reason };
    /// The model, which corrects without a board.
    pub(crate) const MODEL: Self = Self {
        voids: &[&BOARD],
        reason: "does nothing beside --model, which corrects without a board; give one of them",
    };
    /// Frames of which none is a file.
    pub(crate) const NO_FRAME_FILE: Self = Self {
        voids: &[&["raw", "fit"]],
        reason: "is for frames that are files, and none is; leave it out, or name a file",
    };
    /// Samples without a header.
    pub(crate) const HEADERLESS: Self = Self {
        voids: &[&["fit"]],
        reason: "does nothing beside --raw, whose samples are never scaled; give one of them",
    };
    /// Frames that are written, without tables.
    pub(crate) const MADE_FRAMES: Self = Self {
        voids: &[&["rows", "projection", "entries", "nodes_every"]],
        reason: "says how tables are made, and a frame has none; leave it out",
    };
    /// Tables that are written, which suit every phase.
    pub(crate) const MADE_TABLES: Self = Self {
        voids: &[&["phase"]],
        reason: "changes nothing about tables; leave it out, and give it to the command that uses them",
    };
    /// A lens whose figures are shown, which suit every sample.
    pub(crate) const SHOWN_LENS: Self =
        Self { voids: &[&["phase", "bits"]], reason: "changes nothing about a lens's figures; leave it out" };
    /// Items of which none uses a board.
    pub(crate) const NO_BOARD_ITEM: Self = Self {
        voids: &[&BOARD],
        reason: "does nothing, since no item that is asked for goes through a board; leave it out, or add delay, or name a \
                 board for table1",
    };
    /// Items of which none uses the paper's photographs.
    pub(crate) const NO_PHOTOGRAPH_ITEM: Self = Self {
        voids: &[&["images"]],
        reason: "does nothing, since no item that is asked for takes them; leave it out, or add fig12 or table1",
    };
    /// Items without Fig. 4.
    pub(crate) const NO_FIGURE_4: Self = Self {
        voids: &[&["photograph", "lines"]],
        reason: "is for fig4, which is not asked for; leave it out, or add fig4",
    };
    /// Items without the FPGA's resources.
    pub(crate) const NO_SYNTHESIS_ITEM: Self = Self {
        voids: &[&["synthesis"]],
        reason: "is for resources, which are not asked for; leave it out, or add resources",
    };

    /// `argument`, left out of the help if it has no effect beside this in any call of its command.
    pub(crate) fn hides(self, argument: Arg) -> Arg {
        let is_void = self.voids().any(|id| argument.get_id() == id);
        argument.hide(is_void)
    }

    /// The ids of the options that have no effect beside it.
    fn voids(self) -> impl Iterator<Item = &'static str> {
        self.voids.iter().copied().flatten().copied()
    }
}

impl Given {
    /// Whether the command line gives the option `id`.
    pub(crate) fn is_flag(&self, id: &str) -> bool {
        self.flags.iter().any(|flag| flag == id)
    }

    /// The first option on the command line that is void beside `decider`, as it is written there.
    pub(crate) fn void_flag(&self, decider: Decider) -> Option<String> {
        decider.voids().find(|id| self.is_flag(id)).map(written)
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
            return Err(VoidOption { option, reason: decider.reason });
        }
        for id in decider.voids() {
            let of_variable = self.variables.iter().any(|variable| variable == id);
            if of_variable || settings.contains(&id) {
                let place = if of_variable { "the environment" } else { "the settings" };
                tracing::info!("{} of {place} is passed over: it {}", written(id), decider.reason);
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
        let mut decided: Vec<&str> = decider.voids().collect();
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
        assigned(Decider::RECORDING, &stand);
    }

    #[test]
    fn every_option_of_verify_is_void_or_does_something_beside_a_list() {
        // `within` is refused by clap already.
        let of_the_plan =
            ["frame", "repeat", "at_speed", "within", "tables", "kernel", "phase", "raw", "fit", "seed"];
        assigned(Decider::LIST, &[&["board", "list"], &of_the_plan[..], &IN_TABLE_FILES, &LENS].concat());
    }

    #[test]
    fn options_that_are_void_exist() {
        let deciders: [(&str, &[Decider]); 6] = [
            (
                "verify",
                &[Decider::RECORDING, Decider::RECORD, Decider::LIST, Decider::TABLES, Decider::WITHIN],
            ),
            ("correct", &[Decider::MODEL, Decider::NO_FRAME_FILE, Decider::HEADERLESS]),
            ("frames", &[Decider::MADE_FRAMES]),
            ("tables", &[Decider::MADE_TABLES]),
            ("lens", &[Decider::SHOWN_LENS]),
            (
                "paper",
                &[
                    Decider::NO_BOARD_ITEM,
                    Decider::NO_PHOTOGRAPH_ITEM,
                    Decider::NO_FIGURE_4,
                    Decider::NO_SYNTHESIS_ITEM,
                ],
            ),
        ];
        for (command, deciders) in deciders {
            let known = options(command);
            for id in deciders.iter().flat_map(|decider| decider.voids()) {
                assert!(known.iter().any(|known| known == id), "{command}: {id}");
            }
        }
    }
}
