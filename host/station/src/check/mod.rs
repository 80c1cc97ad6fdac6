//! Whether everything is as it was written: every hash anew, and the index made anew from the records beside the one
//! that is there.

use std::collections::BTreeMap;

use crate::plan::plan_hash;
use crate::record::{BlobError, Blobs, Record, RecordError};
use crate::store::{Folder, OpenRun, Rebinding, Rebuilt, Removed, Row, Snapshot, StoreError, TABLES};

/// What was looked at, and what is wrong.
#[derive(Debug)]
pub struct Checked {
    /// Runs that are over.
    pub runs: usize,
    /// Runs that are open.
    pub open: usize,
    /// Records and attachments.
    pub evidence: usize,
    /// Attachments that were removed since they were old.
    pub pruned: usize,
    /// What is not as it was written.
    pub faults: Vec<Fault>,
}

/// Something that is not as it was written.
#[derive(Debug, thiserror::Error)]
pub enum Fault {
    /// SQLite finds its own file damaged.
    #[error("the database is damaged ({said}); restore it from a copy")]
    Database {
        /// What it says.
        said: String,
    },
    /// A record or an attachment is not there, or other than its hash.
    #[error("evidence of run {run}: {source}")]
    Evidence {
        /// The run.
        run: String,
        /// What is wrong.
        source: BlobError,
    },
    /// A record is whole and cannot be read.
    #[error("the record of run {run}: {source}")]
    Record {
        /// The run.
        run: String,
        /// Why.
        source: RecordError,
    },
    /// A record does not fit the records before it.
    #[error("the record of run {run} does not fit those before it: {source}")]
    Contradiction {
        /// The run.
        run: String,
        /// Why.
        source: Box<StoreError>,
    },
    /// A line of the audit does not fit the records.
    #[error("the binding of line {id} of the audit does not fit the records: {source}")]
    Audit {
        /// The line.
        id: String,
        /// Why.
        source: Box<StoreError>,
    },
    /// The plan in a record is not what its hash says.
    #[error("the plan in the record of run {run} has another hash than it says; look at the record")]
    Plan {
        /// The run.
        run: String,
    },
    /// A row is not what the records say.
    #[error("table {table}, row {key}: {column} is `{stored}`, and the records say `{rebuilt}`")]
    Differs {
        /// The table.
        table: &'static str,
        /// The row's key.
        key: String,
        /// The column.
        column: String,
        /// What is there.
        stored: String,
        /// What should be.
        rebuilt: String,
    },
    /// A row is not there.
    #[error("table {table} has no row {key}, and the records have")]
    Missing {
        /// The table.
        table: &'static str,
        /// The row's key.
        key: String,
    },
    /// A row is there without a record.
    #[error("table {table} has a row {key}, and no record has")]
    Surplus {
        /// The table.
        table: &'static str,
        /// The row's key.
        key: String,
    },
}

/// Looks at all that the station in `folder` has kept. Nothing is changed; runs may go on meanwhile.
///
/// # Errors
/// [`StoreError`] when the database cannot be read at all.
pub fn check(folder: &Folder) -> Result<Checked, StoreError> {
    let snapshot = Snapshot::take(folder)?;
    let mut faults: Vec<_> = snapshot.damage()?.into_iter().map(|said| Fault::Database { said }).collect();
    let (finals, open) = (snapshot.final_runs()?, snapshot.open_runs()?);
    let mut look = Look {
        blobs: folder.blobs(),
        removed: snapshot.pruned()?,
        rebuilt: Rebuilt::new()?,
        evidence: 0,
        pruned: 0,
        faults: Vec::new(),
    };
    look.at_all(&finals, &open, &snapshot.rebindings()?);
    faults.append(&mut look.faults);
    for (table, key) in TABLES {
        compare(table, key, snapshot.table(table, key)?, look.rebuilt.table(table, key)?, &mut faults);
    }
    let Look { evidence, pruned, .. } = look;
    Ok(Checked { runs: finals.len(), open: open.len(), evidence, pruned, faults })
}

/// Something that the tables follow from.
enum Entry<'a> {
    Final { run: &'a str, hash: &'a str },
    Open(&'a OpenRun),
    Rebinding(&'a Rebinding),
}

struct Look {
    blobs: Blobs,
    removed: Removed,
    rebuilt: Rebuilt,
    evidence: usize,
    pruned: usize,
    faults: Vec<Fault>,
}

impl Look {
    /// Goes through runs and changes of bindings in the order in which they began, which is that of their ids.
    fn at_all(&mut self, finals: &[(String, String)], open: &[OpenRun], rebindings: &[Rebinding]) {
        let finals = finals.iter().map(|(run, hash)| (run, Entry::Final { run, hash }));
        let open = open.iter().map(|open| (&open.run.id, Entry::Open(open)));
        let rebindings = rebindings.iter().map(|change| (&change.id, Entry::Rebinding(change)));
        let mut all: Vec<_> = finals.chain(open).chain(rebindings).collect();
        all.sort_by_key(|(id, _)| *id);
        for (_, entry) in all {
            let done = match entry {
                Entry::Final { run, hash } => self.at_final(run, hash),
                Entry::Open(open) => self.at_open(open),
                Entry::Rebinding(change) => self.at_rebinding(change),
            };
            self.faults.extend(done.err());
        }
    }

    fn at_rebinding(&mut self, change: &Rebinding) -> Result<(), Fault> {
        let added = self.rebuilt.add_rebinding(change);
        added.map_err(|source| Fault::Audit { id: change.id.clone(), source: Box::new(source) })
    }

    fn at_open(&mut self, open: &OpenRun) -> Result<(), Fault> {
        let added = self.rebuilt.add_open(open);
        added.map_err(|source| Fault::Contradiction { run: open.run.id.clone(), source: Box::new(source) })
    }

    fn at_final(&mut self, run: &str, hash: &str) -> Result<(), Fault> {
        let owned = || run.to_owned();
        let evidence = |source| Fault::Evidence { run: owned(), source };
        self.evidence += 1;
        let bytes = self.blobs.get(hash).map_err(evidence)?;
        let record = Record::parse(&bytes).map_err(|source| Fault::Record { run: owned(), source })?;
        for attachment in &record.attachments {
            match self.blobs.get(&attachment.sha256) {
                Err(error)
                    if error.is_gone() && self.removed.explains(&attachment.sha256, record.ended_ms) =>
                {
                    self.pruned += 1;
                }
                Err(source) => self.faults.push(evidence(source)),
                Ok(_) => self.evidence += 1,
            }
        }
        let plan = &record.plan;
        if plan.files.as_ref().is_some_and(|files| plan_hash(&plan.text, files) != plan.sha256) {
            self.faults.push(Fault::Plan { run: owned() });
        }
        let added = self.rebuilt.add(&record, hash);
        added.map_err(|source| Fault::Contradiction { run: owned(), source: Box::new(source) })
    }
}

/// Compares a table with the one that was made anew.
fn compare(table: &'static str, key: &str, stored: Vec<Row>, rebuilt: Vec<Row>, faults: &mut Vec<Fault>) {
    let by_key =
        |rows: Vec<Row>| rows.into_iter().map(|row| (key_of(key, &row), row)).collect::<BTreeMap<_, _>>();
    let (stored, mut rebuilt) = (by_key(stored), by_key(rebuilt));
    for (key, row) in stored {
        let Some(right) = rebuilt.remove(&key) else {
            faults.push(Fault::Surplus { table, key });
            continue;
        };
        let differing = row.into_iter().zip(right).filter(|(stored, rebuilt)| stored != rebuilt);
        faults.extend(differing.map(|((column, stored), (_, rebuilt))| {
            let key = key.clone();
            Fault::Differs { table, key, column, stored, rebuilt }
        }));
    }
    faults.extend(rebuilt.into_keys().map(|key| Fault::Missing { table, key }));
}

fn key_of(key: &str, row: &Row) -> String {
    let value = |name: &str| row.iter().find(|(column, _)| column == name).map(|(_, value)| value.as_str());
    key.split(", ").filter_map(value).collect::<Vec<_>>().join(" ")
}
