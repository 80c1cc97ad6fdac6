//! `halfrow-station evidence`

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use halfrow::files::written_aside::write_aside;
use halfrow::words::count;

use super::export::{NoFolder, unwritten};
use super::looking::Data;
use super::{Failure, print, tell};
use crate::exit::Exit;
use crate::history::unit::{UnitRun, run_of};
use crate::record::Attachment;
use crate::store::{Snapshot, StoreError};

/// Copy the evidence of a run into a folder
///
/// Frames as PNGs of their exact samples, and whatever else was kept of the run, under the names on the run's page. Nothing
/// else that is there is overwritten. A plant leaves evidence at the station that took it, so ask for it there.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The run, as `halfrow-station history` names it
    run: String,
    #[command(flatten)]
    data: Data,
    /// The folder, which is made if it is not there
    #[arg(long, value_name = "FOLDER")]
    to: PathBuf,
}

/// No run of this number is over here.
#[derive(Debug, thiserror::Error)]
#[error("no run {run} is over here; `halfrow-station history` lists the runs")]
pub(super) struct NoSuchRun {
    pub(super) run: String,
}

/// The run of this id, which must be over, and the hash of its record.
pub(super) fn over(of: &Snapshot, run: &str) -> Result<(UnitRun, String), Failure> {
    let found = run_of(of, run)?;
    let hash = found.as_ref().and_then(|found| found.line.record_sha256.clone());
    found.zip(hash).ok_or_else(|| Failure::call(NoSuchRun { run: run.to_owned() }))
}

/// Some evidence of the run is missing or damaged; the rest was copied.
#[derive(Debug, thiserror::Error)]
#[error(
    "{names} of the run {run}: gone or damaged; `halfrow-station check` says which, and a copy of the station's folder may have it"
)]
pub(super) struct EvidenceLost {
    pub(super) names: String,
    pub(super) run: String,
}

/// Some evidence of the run was removed, because it was older than the settings keep evidence.
#[derive(Debug, thiserror::Error)]
#[error(
    "{names} of the run {run}: removed since older evidence is not kept here; a copy of the station's folder from before may have it"
)]
pub(super) struct EvidenceRemoved {
    pub(super) names: String,
    pub(super) run: String,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let Arguments { run, data, to } = arguments;
    let snapshot = Snapshot::take(&data.folder())?;
    let (found, _) = over(&snapshot, run)?;
    if found.attachments.is_empty() {
        return print("no evidence was kept of this run; of one that passes none is");
    }
    fs::create_dir_all(to).map_err(|source| Failure::call(NoFolder { path: to.clone(), source }))?;
    let removed = snapshot.pruned()?;
    let ended_ms = found.line.ended_ms.unwrap_or(i64::MAX);
    let (mut lost, mut old) = (Vec::new(), Vec::new());
    for one in &found.attachments {
        match snapshot.evidence(&one.sha256) {
            Ok(bytes) => copied(&to.join(file_name(one)), &bytes.unwrap_or_default())?,
            Err(StoreError::Blob(_)) if removed.explains(&one.sha256, ended_ms) => {
                old.push(one.name.as_str());
            }
            Err(StoreError::Blob(_)) => lost.push(one.name.as_str()),
            Err(error) => return Err(error.into()),
        }
    }
    if !lost.is_empty() {
        return Err(Failure::error(EvidenceLost { names: lost.join(", "), run: run.clone() }));
    }
    if !old.is_empty() {
        return Err(Failure::error(EvidenceRemoved { names: old.join(", "), run: run.clone() }));
    }
    let files = count(found.attachments.len(), "file");
    Ok(tell(&format!("{files} of evidence in {}", to.display())))
}

/// Writes a file, unless the very same one is there already.
fn copied(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    if fs::read(path).is_ok_and(|there| there == bytes) {
        return Ok(());
    }
    write_aside(path, false, |file| file.write_all(bytes)).map_err(unwritten)
}

/// The name of its file, which must not lead out of the folder.
fn file_name(one: &Attachment) -> &str {
    let is_plain = Path::new(&one.name).file_name() == Some(OsStr::new(&one.name));
    if is_plain { &one.name } else { &one.sha256 }
}
