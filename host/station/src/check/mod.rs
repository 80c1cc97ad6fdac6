//! Whether everything is as it was written: every hash is computed again, and the index is rebuilt from the records
//! and compared with the existing one.

mod compare;
mod fault;
mod plant;
mod superseded;

use std::mem;

use compare::compare;
pub use fault::Fault;
pub use plant::check_plant;
pub use superseded::Superseded;

use crate::plan::plan_hash;
use crate::progress::{Progress, Told};
use crate::published::KeptPlans;
use crate::record::{Blobs, Piece, PlanRecord, Record, UnnamedRecord};
use crate::store::{Folder, OpenRun, Rebinding, Rebuilt, Removed, Snapshot, StoreError, TABLES};

/// What was checked, and what is wrong.
#[derive(Debug, Default)]
pub struct Checked {
    /// Runs that are over.
    pub runs: usize,
    /// Runs that are open.
    pub open: usize,
    /// Records and attachments.
    pub evidence: usize,
    /// Attachments that were removed because they were old.
    pub pruned: usize,
    /// Records that cannot be read. The tables follow from the records, so this alone may be why tables differ.
    pub unread: usize,
    /// Records that contradict the database about a run, which need not be a fault.
    pub superseded: Vec<Superseded>,
    /// What is not as it was written.
    pub faults: Vec<Fault>,
}

/// Checks everything that the station in `folder` has kept. Nothing is changed; runs may go on meanwhile. `told` is called for each
/// run, and each changed binding, that is read.
///
/// # Errors
/// [`StoreError`] when the database cannot be read at all.
pub fn check(folder: &Folder, told: Told<'_>) -> Result<Checked, StoreError> {
    // Listed before the snapshot, because a run has a row before it has a record.
    let pieces = folder.blobs().all()?;
    let snapshot = Snapshot::take(folder)?;
    let faults: Vec<_> = snapshot.damage()?.into_iter().map(|said| Fault::Database { said }).collect();
    let is_damaged = !faults.is_empty();
    let mut checked = Checked { faults, ..Checked::default() };
    unless_damaged(is_damaged, at_runs(folder, &snapshot, &mut checked, told))?;
    unless_damaged(is_damaged, at_waivers(&snapshot, &mut checked))?;
    unless_damaged(is_damaged, at_unnamed(folder, &pieces, &snapshot, &mut checked))?;
    checked.faults.extend(foreign(folder)?);
    Ok(checked)
}

/// What the database refuses is no error where it is damaged: that was told, and hides nothing else.
fn unless_damaged(is_damaged: bool, looked: Result<(), StoreError>) -> Result<(), StoreError> {
    match looked {
        Err(StoreError::Database { .. } | StoreError::Locked { .. } | StoreError::Damaged { .. })
            if is_damaged =>
        {
            Ok(())
        }
        looked => looked,
    }
}

/// Reads all records, and compares the tables with those that are made anew from them.
fn at_runs(
    folder: &Folder,
    snapshot: &Snapshot,
    checked: &mut Checked,
    told: Told<'_>,
) -> Result<(), StoreError> {
    let is_damaged = !checked.faults.is_empty();
    let (finals, open) = (snapshot.final_runs()?, snapshot.open_runs()?);
    let rebindings = snapshot.rebindings()?;
    let (blobs, removed, rebuilt) = (folder.blobs(), snapshot.pruned()?, Rebuilt::new()?);
    (checked.runs, checked.open) = (finals.len(), open.len());
    let mut look = Look { blobs, removed, rebuilt, early: Vec::new(), checked };
    look.at_all(&finals, &open, &rebindings, told);
    let Look { mut rebuilt, checked, .. } = look;
    for (table, key) in TABLES {
        let (stored, rebuilt) = (snapshot.table(table, key), rebuilt.table(table, key));
        unless_damaged(is_damaged, compare(table, stored, rebuilt, &mut checked.faults))?;
    }
    Ok(())
}

fn at_waivers(snapshot: &Snapshot, checked: &mut Checked) -> Result<(), StoreError> {
    let runs = snapshot.waivers_unlike_audit()?.into_iter();
    checked.faults.extend(runs.map(|run| Fault::Waiver { run }));
    Ok(())
}

/// Looks among `pieces` at the records that no row names.
fn at_unnamed(
    folder: &Folder,
    pieces: &[Piece],
    snapshot: &Snapshot,
    checked: &mut Checked,
) -> Result<(), StoreError> {
    let (blobs, named) = (folder.blobs(), snapshot.named_evidence()?);
    let mut unnamed = Vec::new();
    for found in blobs.each_unnamed_record(pieces, &named) {
        match found {
            Ok(record) => unnamed.push(record),
            Err(error) => checked.faults.push(Fault::Piece(error)),
        }
    }
    checked.superseded = superseded::superseded(&blobs, &unnamed, snapshot)?;
    checked.faults.extend(without_row(unnamed, snapshot)?);
    Ok(())
}

/// What is among the plans in `folder` and may lead out of it, whatever the version of its database.
///
/// # Errors
/// [`StoreError`] when a folder cannot be read.
pub(crate) fn foreign(folder: &Folder) -> Result<Vec<Fault>, StoreError> {
    let found = KeptPlans::of(folder.path()).foreign().map_err(|source| folder.refused(source))?;
    Ok(found.into_iter().map(|path| Fault::Foreign { path }).collect())
}

/// Of the records that no row names, those whose runs have no row.
fn without_row(unnamed: Vec<UnnamedRecord>, snapshot: &Snapshot) -> Result<Vec<Fault>, StoreError> {
    let lost = snapshot.without_row(unnamed)?.into_iter();
    Ok(lost.map(|UnnamedRecord { run, sha256, .. }| Fault::Unnamed { run, sha256 }).collect())
}

/// Something that the tables are derived from.
enum Entry<'a> {
    Final { run: &'a str, hash: &'a str },
    Open(&'a OpenRun),
    Rebinding(&'a Rebinding),
}

struct Look<'a> {
    blobs: Blobs,
    removed: Removed,
    rebuilt: Rebuilt,
    /// Records, with their hashes, of runs that bind what still belongs to another: earlier programs let a run have what a person
    /// freed after it had begun.
    early: Vec<(Record, String)>,
    checked: &'a mut Checked,
}

impl Look<'_> {
    /// Goes through runs and changed bindings in the order in which they began, which is that of their ids.
    fn at_all(
        &mut self,
        finals: &[(String, String)],
        open: &[OpenRun],
        rebindings: &[Rebinding],
        told: Told<'_>,
    ) {
        let finals = finals.iter().map(|(run, hash)| (run, Entry::Final { run, hash }));
        let open = open.iter().map(|open| (&open.run.id, Entry::Open(open)));
        let rebindings = rebindings.iter().map(|change| (&change.id, Entry::Rebinding(change)));
        let mut all: Vec<_> = finals.chain(open).chain(rebindings).collect();
        all.sort_by_key(|(id, _)| *id);
        let of = Some(all.len());
        for ((_, entry), done) in all.into_iter().zip(1..) {
            told(Progress { what: "entries read", done, of });
            let looked_at = match entry {
                Entry::Final { run, hash } => self.at_final(run, hash),
                Entry::Open(open) => self.at_open(open),
                Entry::Rebinding(change) => self.at_rebinding(change),
            };
            let fault = looked_at.err();
            self.checked.unread +=
                usize::from(matches!(fault, Some(Fault::Evidence { .. } | Fault::Record { .. })));
            self.checked.faults.extend(fault);
        }
        for (record, hash) in mem::take(&mut self.early) {
            let fault = self.add(&record, &hash).err();
            self.checked.faults.extend(fault);
        }
    }

    fn add(&mut self, record: &Record, hash: &str) -> Result<(), Fault> {
        let added = self.rebuilt.add(record, hash);
        let run = || record.run.id.clone();
        added.map_err(|source| Fault::Contradiction { run: run(), source: Box::new(source) })
    }

    fn at_rebinding(&mut self, change: &Rebinding) -> Result<(), Fault> {
        let added = self.rebuilt.add_rebinding(change);
        added.map_err(|source| Fault::Audit { id: change.id.clone(), source: Box::new(source) })?;
        let Self { rebuilt, early, .. } = self;
        early.retain(|(record, hash)| rebuilt.add(record, hash).is_err());
        Ok(())
    }

    fn at_open(&mut self, open: &OpenRun) -> Result<(), Fault> {
        let added = self.rebuilt.add_open(open);
        added.map_err(|source| Fault::Contradiction { run: open.run.id.clone(), source: Box::new(source) })
    }

    fn at_final(&mut self, run: &str, hash: &str) -> Result<(), Fault> {
        let owned = || run.to_owned();
        let evidence = |source| Fault::Evidence { run: owned(), source };
        self.checked.evidence += 1;
        let bytes = self.blobs.get(hash).map_err(evidence)?;
        let record = Record::parse(&bytes).map_err(|source| Fault::Record { run: owned(), source })?;
        for attachment in &record.attachments {
            match self.blobs.get(&attachment.sha256) {
                Err(error)
                    if error.is_gone() && self.removed.explains(&attachment.sha256, record.ended_ms) =>
                {
                    self.checked.pruned += 1;
                }
                Err(source) => self.checked.faults.push(evidence(source)),
                Ok(_) => self.checked.evidence += 1,
            }
        }
        if !is_as_hashed(&record.plan) {
            self.checked.faults.push(Fault::Plan { run: owned() });
        }
        match self.add(&record, hash) {
            Err(_) if record.binds().is_some() => self.early.push((record, hash.to_owned())),
            added => added?,
        }
        Ok(())
    }
}

/// Whether a plan matches its hash; true if the record does not say which files belong to the plan.
fn is_as_hashed(PlanRecord { sha256, text, files, .. }: &PlanRecord) -> bool {
    files.as_ref().is_none_or(|files| plan_hash(text, files) == *sha256)
}
