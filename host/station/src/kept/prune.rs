//! Evidence that is older than it has to be kept. Records and rows are kept for ever.

use std::fs;

use super::unnamed::beyond_rows;
use crate::record::BlobError;
use crate::store::{Snapshot, Store, StoreError};

/// What was removed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pruned {
    /// Pieces of evidence.
    pub pieces: usize,
    /// Their bytes.
    pub bytes: u64,
}

/// Removes all evidence whose runs all ended before `before_ms`, milliseconds since 1970, UTC. What a record names and no row
/// of its run does stays. The removal is entered in the audit first, so that `check` can tell what was removed from what is lost.
///
/// # Errors
/// [`StoreError`]; what was removed before is in the audit.
pub fn prune(store: &mut Store, before_ms: i64, operator: &str) -> Result<Pruned, StoreError> {
    let blobs = store.folder().blobs();
    let old = store.old_evidence(before_ms)?;
    let mut here: Vec<_> = old.into_iter().filter(|hash| blobs.path(hash).is_file()).collect();
    if !here.is_empty() {
        let snapshot = Snapshot::take(store.folder())?;
        // A run whose record or attachment has no row may be younger than those with rows.
        let unnamed = blobs.unnamed_records(&blobs.all()?, &snapshot.named_evidence()?)?;
        let kept = beyond_rows(&blobs, &snapshot, unnamed)?;
        here.retain(|hash| !kept.contains(hash));
    }
    store.note_removed(operator, "prune", &here, "older than it is kept")?;
    let mut pruned = Pruned::default();
    for hash in &here {
        let path = blobs.path(hash);
        let removed = fs::metadata(&path).and_then(|known| fs::remove_file(&path).map(|()| known.len()));
        pruned.bytes += removed.map_err(|source| BlobError::Folder { path, source })?;
        pruned.pieces += 1;
    }
    Ok(pruned)
}
