//! `halfrow-station backup`, `restore` and `prune`

use std::path::PathBuf;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use clap::Args;

use super::looking::Data;
use super::{Failure, print};
use crate::exit::Exit;
use crate::kept::{self, Copied, CopyError, Pruned};
use crate::store::{Folder, Store};

/// Copy all that the station has kept to a new folder, while runs go on
#[derive(Debug, Args)]
pub(super) struct Backup {
    /// The folder, which must be new or empty
    to: PathBuf,
    #[command(flatten)]
    data: Data,
}

pub(super) fn backup(arguments: &Backup) -> Result<Exit, Failure> {
    let Copied { runs, evidence } = kept::backup(&arguments.data.folder(), &arguments.to)?;
    print(&format!("{runs} runs and {evidence} pieces of evidence are in {}", arguments.to.display()))
}

/// Make a station's folder from a backup, when all of it is as it was written
#[derive(Debug, Args)]
pub(super) struct Restore {
    /// The folder of the backup
    from: PathBuf,
    /// The station's folder, which must be new or empty
    #[arg(long, value_name = "FOLDER", env = "HALFROW_STATION_DATA")]
    data: PathBuf,
}

pub(super) fn restore(arguments: &Restore) -> Result<Exit, Failure> {
    let Copied { runs, evidence } = kept::restore(&Folder::new(&arguments.from), &arguments.data)?;
    print(&format!("{runs} runs and {evidence} pieces of evidence were read back, 0 faults found"))
}

/// Remove the evidence of old runs; their records and rows are kept for ever
#[derive(Debug, Args)]
pub(super) struct Prune {
    #[command(flatten)]
    data: Data,
    /// Evidence of runs that ended longer ago
    #[arg(long, value_name = "DAYS", value_parser = clap::value_parser!(u32).range(1..))]
    older_than: u32,
    /// Who removes it
    #[arg(long, value_name = "NAME", env = "USER", default_value = "unknown")]
    operator: String,
}

pub(super) fn prune(arguments: &Prune) -> Result<Exit, Failure> {
    let mut store = Store::open_existing(&arguments.data.folder())?;
    let age = Duration::from_secs(86_400 * u64::from(arguments.older_than));
    let before = SystemTime::now().checked_sub(age).and_then(|before| before.duration_since(UNIX_EPOCH).ok());
    let before_ms = before.map_or(0, |before| before.as_millis() as i64);
    let Pruned { pieces, bytes } = kept::prune(&mut store, before_ms, &arguments.operator)?;
    print(&format!("{pieces} pieces of evidence were removed, {bytes} bytes; every record is kept"))
}

impl From<CopyError> for Failure {
    fn from(error: CopyError) -> Self {
        match error {
            CopyError::Exists { .. } => Self::call(error),
            CopyError::UnderWay { .. } => Self { exit: Exit::Busy, error: error.into() },
            CopyError::Store(error) => error.into(),
            error => Self::error(error),
        }
    }
}
