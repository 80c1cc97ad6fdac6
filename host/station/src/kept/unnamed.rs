//! What no row names: a run wrote it, and ended before its row was written, because the power failed or the disk was full.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use crate::record::{BlobError, Blobs, Piece, UnnamedRecord};
use crate::store::{Snapshot, Store, StoreError};

/// How long it is kept, in case somebody asks what happened.
const KEPT: Duration = Duration::from_secs(86_400);
/// What its removal is called in the audit. It is no excuse for `check`, because a run that names the same bytes later
/// has them.
const ACT: &str = "prune unnamed";

/// What was removed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Unnamed {
    /// Pieces of evidence.
    pub pieces: usize,
    /// Folders that runs wrote to while they were under way.
    pub spools: usize,
    /// The bytes of both.
    pub bytes: u64,
}

/// Removes evidence and spools that are a day old and that no row names. A record that no row names is kept, with all
/// that it names, because it alone can tell of its run. An open run keeps its spool. Everything is entered in the
/// audit before it is removed.
///
/// # Errors
/// [`StoreError`]; what was removed before is in the audit.
pub fn prune_unnamed(store: &mut Store, operator: &str) -> Result<Unnamed, StoreError> {
    let blobs = store.folder().blobs();
    let pieces = old_pieces(store, &blobs)?;
    let spools: Vec<_> = spools(store)?.into_iter().filter(|spool| spool.is_old).collect();
    let names = spools.iter().map(|spool| spool.name.clone());
    let subjects: Vec<_> = pieces.iter().map(|piece| piece.hash.clone()).chain(names).collect();
    store.note_removed(operator, ACT, &subjects, "no row names it")?;
    let mut removed = Unnamed::default();
    for piece in &pieces {
        removed.bytes += blobs.remove(&piece.hash)?;
        removed.pieces += 1;
    }
    for Spool { path, bytes, .. } in spools {
        fs::remove_dir_all(&path).map_err(|source| BlobError::Folder { path, source })?;
        removed.spools += 1;
        removed.bytes += bytes;
    }
    Ok(removed)
}

/// The evidence that may go.
fn old_pieces(store: &Store, blobs: &Blobs) -> Result<Vec<Piece>, StoreError> {
    let snapshot = Snapshot::take(store.folder())?;
    let named = snapshot.named_evidence()?;
    let all = blobs.all()?;
    let kept = of_unnamed_records(blobs, &all, &named)?;
    let may_go =
        |piece: &Piece| is_old(piece.modified) && !named.contains(&piece.hash) && !kept.contains(&piece.hash);
    let mut pieces: Vec<_> = all.into_iter().filter(may_go).collect();
    if !pieces.is_empty() {
        let beyond = beyond_rows(blobs, &snapshot, Vec::new())?;
        pieces.retain(|piece| !beyond.contains(&piece.hash));
    }
    Ok(pieces)
}

/// What the records of runs and these `unnamed` ones name for which their runs have no row of an attachment, because the database has
/// lost it. Of a record that cannot be read only its rows tell.
pub(super) fn beyond_rows(
    blobs: &Blobs,
    snapshot: &Snapshot,
    unnamed: Vec<UnnamedRecord>,
) -> Result<BTreeSet<String>, StoreError> {
    let rows = snapshot.attachments()?;
    let of_runs = snapshot.final_runs()?.into_iter().map(|(run, record)| (run, blobs.named_by(&record)));
    let unnamed = unnamed.into_iter().map(|record| (record.run, record.attachments));
    let mut beyond = BTreeSet::new();
    for (run, named) in of_runs.chain(unnamed) {
        let has_row = |hash: &String| rows.get(&run).is_some_and(|of_run| of_run.contains(hash));
        beyond.extend(named.into_iter().filter(|hash| !has_row(hash)));
    }
    Ok(beyond)
}

/// The records among `pieces` that are not in `named`, the hashes that rows name, and what these records name.
fn of_unnamed_records(
    blobs: &Blobs,
    pieces: &[Piece],
    named: &BTreeSet<String>,
) -> Result<BTreeSet<String>, StoreError> {
    let records = blobs.unnamed_records(pieces, named)?.into_iter();
    Ok(records.flat_map(|record| [vec![record.sha256], record.attachments].concat()).collect())
}

/// The spool of a run that is over, or that no row names.
#[derive(Clone, Debug)]
pub(crate) struct Spool {
    /// The run.
    pub name: String,
    /// The folder.
    pub path: PathBuf,
    /// How many bytes are in it.
    pub bytes: u64,
    /// Whether its run is over, so that all of it that is worth keeping is evidence.
    pub is_over: bool,
    /// Whether no row names it, and it is old enough to be removed.
    pub is_old: bool,
}

/// The spools of all runs that are not open.
pub(crate) fn spools(store: &mut Store) -> Result<Vec<Spool>, StoreError> {
    let open: BTreeSet<_> = store.open_runs()?.into_iter().map(|open| open.run.id).collect();
    let mut spools = Vec::new();
    let folder = store.folder().spools();
    let refused = |source| BlobError::Folder { path: folder.clone(), source };
    for entry in fs::read_dir(&folder).map_err(refused)? {
        let entry = entry.map_err(refused)?;
        let (name, path) = (entry.file_name().to_string_lossy().into_owned(), entry.path());
        if open.contains(&name) || !path.is_dir() {
            continue;
        }
        let is_over = store.folder().verdict_of(&name)?.is_some();
        let (bytes, changed) = size_and_age(&path).map_err(|source| {
            let path = path.clone();
            BlobError::Folder { path, source }
        })?;
        spools.push(Spool { name, path, bytes, is_over, is_old: !is_over && is_old(changed) });
    }
    Ok(spools)
}

/// How many bytes are in a folder, and when it or a file in it was last written.
fn size_and_age(folder: &Path) -> io::Result<(u64, SystemTime)> {
    let (mut bytes, mut changed) = (0, fs::metadata(folder)?.modified()?);
    for entry in fs::read_dir(folder)? {
        let known = entry?.metadata()?;
        bytes += known.len();
        changed = changed.max(known.modified()?);
    }
    Ok((bytes, changed))
}

/// Whether something that was last written at this moment may be removed. What was written in the future may not.
fn is_old(written: SystemTime) -> bool {
    SystemTime::now().duration_since(written).is_ok_and(|age| age >= KEPT)
}
