//! `--tables`, and what takes precedence over it.

use std::path::{Path, PathBuf};

use clap::Args;

use super::given::{Decider, Given, IN_TABLE_FILES, written};
use super::optics::LensArguments;
use crate::call_error::CallError;
use crate::failure::Failure;
use crate::settings::Settings;
use halfrow::call::Input;
use halfrow::optics::OpticsError;
use halfrow::tables::TableFile;

/// The table file that the command line or the environment names.
#[derive(Clone, Debug, Args)]
pub(crate) struct TableArgument {
    /// The table file; without it the lens options make the tables
    ///
    /// With it, options that make tables are refused; --width, --height, --bits and --centre-x may be given if they agree with
    /// the file. Built-in frames are then seen through the default lens; `halfrow frames` writes them through others.
    #[arg(long, value_name = "FILE", env = "HALFROW_TABLES")]
    tables: Option<PathBuf>,
}

/// A table file that was read.
pub(crate) struct NamedTables {
    pub(crate) input: Input,
    pub(crate) file: TableFile,
}

impl TableArgument {
    /// The file that is named, whether or not its tables will be used.
    pub(crate) fn path<'a>(&'a self, settings: &'a Settings) -> Option<&'a PathBuf> {
        self.tables.as_ref().or(settings.tables.as_ref())
    }

    /// The file to take the tables from; none if the lens options make them. Options that make tables are flags, and so take
    /// precedence over a file from the environment or `settings`.
    pub(crate) fn read(
        &self,
        given: &Given,
        lens: &LensArguments,
        settings: &Settings,
    ) -> Result<Option<NamedTables>, Failure> {
        let Some(path) = self.path(settings) else { return Ok(None) };
        let is_flag = given.is_flag("tables");
        if is_flag {
            given.refuse_void(Decider::TABLES, &[])?;
        } else if let Some(option) = given.void_flag(Decider::TABLES) {
            tracing::warn!("the table file {} is passed over, since {option} makes tables", path.display());
            return Ok(None);
        }
        let (file, input) = TableFile::read(path)
            .map_err(|error| Failure::from(OpticsError::from(error)).in_value_of("--tables"))?;
        let geometry = file.tables.geometry();
        let flags = IN_TABLE_FILES.into_iter().filter(|id| given.is_flag(id));
        let mut others = flags.filter(|id| !lens.agrees(id, geometry)).map(written);
        match others.next() {
            None => Ok(Some(NamedTables { input, file })),
            Some(option) if is_flag => refuse(&option, path, &file),
            Some(option) => {
                tracing::warn!(
                    "the table file {} is passed over, since {option} makes others",
                    path.display()
                );
                Ok(None)
            }
        }
    }
}

fn refuse<T>(option: &str, path: &Path, file: &TableFile) -> Result<T, Failure> {
    let geometry = file.tables.geometry();
    Err(Failure::call(CallError::OtherThanTables {
        option: option.to_owned(),
        path: path.to_owned(),
        width: geometry.width(),
        height: geometry.height(),
        bits: geometry.depth().bits(),
        centre: f64::from(geometry.centre2()) / 2.0,
    }))
}
