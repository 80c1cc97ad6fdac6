//! `--tables`, and what comes before it.

use std::path::{Path, PathBuf};

use anyhow::bail;
use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, Args, Command, FromArgMatches, value_parser};

use super::optics::LensArguments;
use crate::settings::Settings;

const NAME: &str = "tables";

/// The table file that the command line or the environment names.
#[derive(Clone, Debug)]
pub(super) struct TableArgument {
    path: Option<PathBuf>,
    /// Whether it is the command line that does.
    is_flag: bool,
}

impl TableArgument {
    /// The file to take the tables from; none for those of the lens options. Options that make tables are flags, and so come
    /// before a file that the environment or `settings` names.
    pub(super) fn file<'a>(
        &'a self,
        lens: &LensArguments,
        settings: &'a Settings,
    ) -> anyhow::Result<Option<&'a Path>> {
        let named = self.path.as_deref();
        match (lens.making_tables(), named.filter(|_| self.is_flag)) {
            (None, _) => Ok(named.or(settings.tables.as_deref())),
            (Some(_), None) => Ok(None),
            (Some(option), Some(path)) => {
                bail!(
                    "{option} is for making tables, and --tables {} holds some; give one of them",
                    path.display()
                )
            }
        }
    }
}

/// By hand, since what clap derives does not say where a value comes from.
impl FromArgMatches for TableArgument {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let is_flag = matches.value_source(NAME) == Some(ValueSource::CommandLine);
        Ok(Self { path: matches.get_one(NAME).cloned(), is_flag })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Args for TableArgument {
    fn augment_args(command: Command) -> Command {
        let tables = Arg::new(NAME).long(NAME).value_name("FILE").env("HALFROW_TABLES");
        let help = "The table file; without it the lens options make the tables";
        command.arg(tables.value_parser(value_parser!(PathBuf)).help(help))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}
