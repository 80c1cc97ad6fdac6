//! `halfrow-station export`

use std::path::{Path, PathBuf};
use std::{fs, io};

use clap::{ArgGroup, Args};
use halfrow::files::written_aside::{Aside, WriteAsideError, write_aside};
use halfrow::words::{self, verb};

use super::evidence::over;
use super::looking::{Filtered, Results};
use super::progress::teller;
use super::{Failure, tell};
use crate::console;
use crate::exit::Exit;
use crate::export::{self, ExportError, Format, Table};
use crate::history::runs::{Filter, MOST, page};
use crate::progress::Progress;
use crate::record::Record;
use crate::said::Said;
use crate::store::Snapshot;

/// Write runs for other programs
///
/// One run goes to stdout, or to the file of `--to`. Without a run, all runs that pass the filters are written: `csv` into
/// the file of `--to`, and each other format into a file for each run in the folder of `--to`. Nothing is overwritten. Runs
/// that are open are left out. So is a run whose record cannot be read: it is named, all others are written, and the exit code
/// is 3.
#[derive(Debug, Args)]
#[command(group(ArgGroup::new("runs").required(true).multiple(true).args(["run", "to"])))]
pub(super) struct Arguments {
    /// The run, as `halfrow-station history` names it [default: all that pass the filters]
    #[arg(conflicts_with_all = Filtered::GROUPS)]
    run: Option<String>,
    #[command(flatten)]
    results: Results,
    /// How they are written
    #[arg(long, value_enum, default_value = "record")]
    format: Format,
    /// The file, or the folder, which is made if it is not there
    #[arg(long, value_name = "PATH")]
    to: Option<PathBuf>,
    #[command(flatten)]
    filtered: Filtered,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let snapshot = arguments.results.snapshot()?;
    let Arguments { run, format, to, filtered, .. } = arguments;
    if let Some(run) = run {
        return one(&snapshot, run, *format, to.as_deref());
    }
    // Without a run, the command line must say where to.
    all(&snapshot, &filtered.filter()?, *format, to.as_deref().unwrap_or(Path::new(".")))
}

fn one(of: &Snapshot, run: &str, format: Format, to: Option<&Path>) -> Result<Exit, Failure> {
    let (_, hash) = over(of, run)?;
    let bytes = export::run(of, &hash, format)?;
    if let Some(to) = to {
        write_aside(to, false, |file| file.write_all(&bytes)).map_err(unwritten)?;
        return Ok(Exit::Pass);
    }
    console::hand_out(&bytes)?;
    Ok(Exit::Pass)
}

/// Writes all runs that pass the filter and can be read, and prints how many there are.
fn all(of: &Snapshot, filter: &Filter, format: Format, to: &Path) -> Result<Exit, Failure> {
    let Exported { written, lost } = if format == Format::Csv {
        let aside = Aside::written(to, false, |_| Ok(())).map_err(unwritten)?;
        let mut table = Table::begin(aside)?;
        let exported = each(of, filter, |_, record, _| Ok(table.add(&record)?))?;
        table.end().put_in_place().map_err(unwritten)?;
        exported
    } else {
        fs::create_dir_all(to).map_err(|source| Failure::call(NoFolder { path: to.to_owned(), source }))?;
        each(of, filter, |run, record, bytes| {
            let bytes = export::written(&record, bytes, format)?;
            let path = to.join(format!("{run}{}", format.ending()));
            write_aside(&path, false, |file| file.write_all(&bytes)).map_err(unwritten)
        })?
    };
    let (runs, are) = (words::count(written, "run"), verb(written, "are"));
    let exit = tell(&format!("{runs} {are} in {}", to.display()));
    if lost.is_empty() { Ok(exit) } else { Err(Failure::error(RunsLost { runs: lost.join(", ") })) }
}

/// What became of the runs that are exported.
#[derive(Default)]
struct Exported {
    written: usize,
    /// Those whose records cannot be read.
    lost: Vec<String>,
}

/// Calls `write` for each run that passes the filter, newest first, with its id, its record and the record's bytes.
fn each(
    of: &Snapshot,
    filter: &Filter,
    mut write: impl FnMut(&str, Record, Vec<u8>) -> Result<(), Failure>,
) -> Result<Exported, Failure> {
    let (mut exported, mut after, mut told) = (Exported::default(), None, teller());
    loop {
        let page = page(of, filter, after.as_ref(), MOST)?;
        for run in &page.runs {
            let Some(hash) = &run.record_sha256 else { continue };
            match of.record(hash) {
                Ok((record, bytes)) => {
                    write(&run.id, record, bytes)?;
                    exported.written += 1;
                    told(Progress { what: "runs written", done: exported.written, of: None });
                }
                Err(error) if error.is_of_record() => {
                    tracing::warn!("the run {} is left out: {}", run.id, Said::of(&error));
                    exported.lost.push(run.id.clone());
                }
                Err(error) => return Err(error.into()),
            }
        }
        after = page.next;
        if after.is_none() {
            return Ok(exported);
        }
    }
}

/// Runs are missing in what was written, because their records cannot be read.
#[derive(Debug, thiserror::Error)]
#[error(
    "these runs are missing there, because their records cannot be read: {runs}; do what the warning about each says, and \
     export these runs again"
)]
pub(super) struct RunsLost {
    pub(super) runs: String,
}

impl From<ExportError> for Failure {
    fn from(error: ExportError) -> Self {
        match error {
            ExportError::Store(error) => error.into(),
            error => Self::error(error),
        }
    }
}

/// The output folder cannot be made.
#[derive(Debug, thiserror::Error)]
#[error("{} cannot be a folder for the files; check that there is space, or name another place", path.display())]
pub(super) struct NoFolder {
    pub(super) path: PathBuf,
    pub(super) source: io::Error,
}

/// The output file exists already, and is not overwritten.
#[derive(Debug, thiserror::Error)]
#[error("{} exists, and nothing is overwritten; name another place", path.display())]
pub(super) struct Taken {
    pub(super) path: PathBuf,
}

pub(super) fn unwritten(error: WriteAsideError) -> Failure {
    match error {
        WriteAsideError::Exists { path } => Failure::call(Taken { path }),
        error => Failure::error(error),
    }
}
