//! What backups and pruning ask of the database.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

use super::audit::Deed;
use super::database::values;
use super::{Folder, Snapshot, Store, StoreError, generation, statements as sql};
use crate::clock::{self, DAY_MS};
use crate::ids;
use crate::record::UnnamedRecord;

impl Folder {
    /// Copies the database as it is at this moment to the new file `to`.
    pub(crate) fn copy_database(&self, to: &Path) -> Result<(), StoreError> {
        let copied = self.reader()?.execute("VACUUM INTO $1", values![&*to.to_string_lossy()]);
        copied.map_err(|source| match source.is_of_reading() {
            true => StoreError::of_file(&self.database(), "to be copied", source),
            false => StoreError::of_file(to, "to be written", source),
        })?;
        generation::remove(to)
    }
}

impl Snapshot {
    /// The hashes of all evidence that a row names, records among it.
    pub(crate) fn named_evidence(&self) -> Result<BTreeSet<String>, StoreError> {
        let named =
            self.rows("to tell what evidence has a row", sql::NAMED_EVIDENCE, &[], |row| row.get(0))?;
        Ok(named.into_iter().collect())
    }

    /// The hashes of the attachments that rows name, by the run.
    pub(crate) fn attachments(&self) -> Result<BTreeMap<String, BTreeSet<String>>, StoreError> {
        let rows = self.rows("to tell its attachments", sql::ATTACHMENTS, &[], |row| {
            Ok((row.get::<String>(0)?, row.get(1)?))
        })?;
        let mut attachments = BTreeMap::<_, BTreeSet<_>>::new();
        for (run, hash) in rows {
            attachments.entry(run).or_default().insert(hash);
        }
        Ok(attachments)
    }

    /// Those of `records` whose runs have no row, not even an open one.
    pub(crate) fn without_row(
        &self,
        mut records: Vec<UnnamedRecord>,
    ) -> Result<Vec<UnnamedRecord>, StoreError> {
        if !records.is_empty() {
            let over = self.final_runs()?.into_iter().map(|(run, _)| run);
            let known: BTreeSet<_> =
                over.chain(self.open_runs()?.into_iter().map(|open| open.run.id)).collect();
            records.retain(|record| !known.contains(&record.run));
        }
        Ok(records)
    }

    /// The attachments of this run that were removed because they were old, by their hashes.
    pub(crate) fn pruned_of(&self, run: &str) -> Result<BTreeSet<String>, StoreError> {
        let pruned =
            self.rows("to tell what was removed", sql::PRUNED_OF_RUN, values![run], |row| row.get(0))?;
        Ok(pruned.into_iter().collect())
    }

    /// The evidence that was removed because it was old.
    ///
    /// # Errors
    /// [`StoreError`] when the database cannot be read.
    pub fn pruned(&self) -> Result<Removed, StoreError> {
        let pruned =
            self.rows("to tell what was removed", sql::PRUNED, &[], |row| Ok((row.get(0)?, row.get(1)?)))?;
        Ok(Removed(pruned.into_iter().collect()))
    }
}

/// Evidence that was removed because it was old, by its hash, and when, in milliseconds since 1970, UTC.
#[derive(Clone, Debug, Default)]
pub struct Removed(BTreeMap<String, i64>);

impl Removed {
    /// Whether this is why a run that ended at `ended_ms` has lost the piece `hash`. A run that ended later stored it anew.
    #[must_use]
    pub fn explains(&self, hash: &str, ended_ms: i64) -> bool {
        self.0.get(hash).is_some_and(|&removed_ms| ended_ms < removed_ms)
    }
}

impl Store {
    /// The moment so many days ago, in milliseconds since 1970, UTC. They are counted back from when the newest run began, if that is
    /// earlier than now: a clock that is ahead makes nothing here older, unless the newest run began by it.
    ///
    /// # Errors
    /// [`StoreError`] when the database cannot be read.
    pub(crate) fn days_ago_ms(&mut self, days: u32) -> Result<i64, StoreError> {
        let began_ms: Option<i64> =
            self.read("to tell its newest run", |from| from.one(sql::NEWEST_RUN, &[], |row| row.get(0)))?;
        let from_ms = clock::now_ms().min(began_ms.unwrap_or(i64::MAX));
        Ok(from_ms.saturating_sub(DAY_MS * i64::from(days)))
    }

    /// The hashes of the attachments whose runs all ended before `before_ms`, and by their ids began before it.
    pub(crate) fn old_evidence(&self, before_ms: i64) -> Result<Vec<String>, StoreError> {
        Snapshot::take(&self.folder)?.rows(
            "to tell old evidence",
            sql::OLD_EVIDENCE,
            values![before_ms, &ids::first_of(before_ms)],
            |row| row.get(0),
        )
    }

    /// Enters in the audit that all of these are removed, and why.
    pub(crate) fn note_removed(
        &mut self,
        operator: &str,
        act: &str,
        subjects: &[String],
        why: &str,
    ) -> Result<(), StoreError> {
        let at_ms = clock::now_ms();
        let deeds = subjects.iter().map(|subject| Deed { operator, act, subject, detail: why });
        let lines: Vec<_> = deeds.map(|deed| deed.at(at_ms)).collect::<Result<_, _>>()?;
        let sinks = Arc::clone(&self.sinks);
        self.change("a line of the audit", |to| lines.into_iter().try_for_each(|line| line.enter(to, &sinks)))
    }
}
