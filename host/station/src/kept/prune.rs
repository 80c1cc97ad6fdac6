//! Evidence that is older than it has to be kept. Records and rows are kept for ever.

use super::unnamed::beyond_rows;
use crate::store::{Snapshot, Store, StoreError};

/// What the removal is called in the audit: by this `sql/pruned.sql` tells `check` what was removed.
const ACT: &str = "prune";

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
    store.note_removed(operator, ACT, &here, "older than it is kept")?;
    let mut pruned = Pruned::default();
    for hash in &here {
        pruned.bytes += blobs.remove(hash)?;
        pruned.pieces += 1;
    }
    Ok(pruned)
}
