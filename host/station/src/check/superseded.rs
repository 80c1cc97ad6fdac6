//! Records whose runs are open in the database, or ended differently there.

use std::collections::BTreeSet;

use halfrow::Verdict;

use crate::record::{Blobs, Record, UnnamedRecord};
use crate::said::{Said, Saying};
use crate::store::{Snapshot, StoreError};

/// A record's verdict is not the one that the database has for its run. This is not a fault: either the power failed, or the
/// station was killed, before the run was committed, or the database is a copy that was made before it was. On the disk both look
/// the same.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "run {run} is {row} here, and its record {sha256} says {verdict}: the power failed, or the station was \
     killed, before that was shown, or station.db is an earlier copy, and then it was shown; find out which, or else test the board again"
)]
pub struct Superseded {
    /// The run.
    pub run: String,
    /// What its row says: `open`, or its verdict.
    pub row: String,
    /// The hash of the record.
    pub sha256: String,
    /// What the record says.
    pub verdict: String,
}

/// Of the records that no row names, those that are whole and contradict the row of their run. An open run counts as
/// ERROR, which it will become. A run whose result was saved too late was never shown as anything else.
pub(super) fn superseded(
    blobs: &Blobs,
    unnamed: &[UnnamedRecord],
    snapshot: &Snapshot,
) -> Result<Vec<Superseded>, StoreError> {
    if unnamed.is_empty() {
        return Ok(Vec::new());
    }
    let open: BTreeSet<_> = snapshot.open_runs()?.into_iter().map(|open| open.run.id).collect();
    let mut found = Vec::new();
    for UnnamedRecord { sha256, run, verdict, .. } in unnamed {
        let row = match snapshot.verdict_of(run)? {
            None if open.contains(run) => None,
            None => continue,
            Some(stored) if was_saved_too_late(blobs, &stored.record_sha256) => continue,
            Some(stored) => Some(stored.verdict),
        };
        let Some(verdict) = verdict.filter(|said| *said != row.unwrap_or(Verdict::Error)) else { continue };
        if blobs.get(sha256).is_ok() {
            let row = row.map_or_else(|| "open".to_owned(), |row| row.to_string());
            found.push(Superseded {
                run: run.clone(),
                row,
                sha256: sha256.clone(),
                verdict: verdict.to_string(),
            });
        }
    }
    found.sort_by(|one, other| one.run.cmp(&other.run));
    Ok(found)
}

fn was_saved_too_late(blobs: &Blobs, record: &str) -> bool {
    let record = blobs.get(record).ok().and_then(|bytes| Record::parse(&bytes).ok());
    let finding = record.and_then(|record| record.conclusion.finding);
    finding.is_some_and(|finding| finding.code == Said::from(Saying::SavedTooLate { tries: 0 }).code)
}
