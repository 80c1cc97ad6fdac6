//! The station's own store, on its own disk.
//!
//! ```text
//!  station.db          SQLite, the index; write-ahead log, every commit on the disk before it returns
//!  blobs/ab/abcd…      evidence by its hash; records among it
//!  spool/RUN/          what a run writes down while it is under way
//!  station.lock        held by the one program that writes; says which database a log belongs to
//! ```
//!
//! A run is entered as open before its board is touched, and its verdict is shown only when a second connection has read
//! it back.

mod audit;
mod bindings;
mod clock_agreement;
mod database;
mod error;
mod folder;
mod generation;
mod migrations;
mod outbox;
mod owner;
mod plan_versions;
mod plant;
mod reason;
mod retention;
mod retest_policy;
mod rows;
mod shape;
mod shared_store;
mod shift;
mod snapshot;
pub(crate) mod statements;
mod table;
mod waivers;

use std::collections::BTreeMap;
use std::fs::File;
use std::sync::Arc;
use std::time::Duration;

use halfrow::Verdict;
use uuid::Uuid;

pub use audit::{By, Deed};
pub(crate) use bindings::is_device;
pub use bindings::{Admission, Change, RebindError, Rebinding};
pub(crate) use database::{Database, DatabaseError, Row as Found, Value, values};
pub use error::StoreError;
pub use folder::Folder;
pub(crate) use folder::{ASIDE, LOCK, make_folder};
use generation::{Log, Opened};
pub use outbox::{AtSink, AuditLine, Dead, Entry, Kind, Parcel, SINK_OF_PLANT, Tried, Unsent};
pub(crate) use outbox::{Backlog, DEAD_SHOWN, FIRST_WAIT_MS, LONGEST_WAIT_MS};
pub use plant::{
    Claim, Introduction, Job, JobState, LastTold, Lease, NewJob, Plant, PlantAddress, PlantAddressError,
    PlantError, PlantLink, SharedBoard, Turn, Waiter, Waiting, Wanted, Worker, boards, jobs,
};
pub(crate) use plant::{
    JobsInState, KeptRun, LEASE_MS, SILENT_MS, counted_jobs, open_jobs, publications, seen_units, waiters,
};
pub(crate) use reason::MOST_REASON;
pub use reason::{Reason, ReasonError};
pub use retention::Removed;
pub use retest_policy::AgainError;
pub(crate) use shape::lacks;
pub use shared_store::SharedStore;
pub use shift::{Checked, InLane, Owed};
pub(crate) use snapshot::Rebuilt;
pub use snapshot::{Snapshot, TABLES};
pub(crate) use table::Key;
pub use table::{Row, Rows};
pub use waivers::{NoWaiver, Waiver};

use crate::clock::{self, HeardClock};
use crate::ids;
use crate::record::{PlanRecord, Record, RunHead};

/// How long a reader waits for a writer.
const PATIENCE: Duration = Duration::from_secs(10);

/// A run that is open.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OpenRun {
    /// Its head.
    pub run: RunHead,
    /// The hash of its plan.
    pub plan_sha256: String,
    /// The plan's name, version and text.
    pub plan: [String; 3],
}

/// A verdict that the store has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stored {
    /// The verdict.
    pub verdict: Verdict,
    /// The exit code.
    pub exit_code: u8,
    /// The hash of the record.
    pub record_sha256: String,
    /// Which judgement of this unit under plans of this name it is, counted from 1; 0 for one that does not count.
    pub nth: i64,
}

impl Stored {
    /// That of a run; none if the run is open or not there.
    fn of_run(from: &mut dyn Database, run: &str) -> Result<Option<Self>, DatabaseError> {
        from.first(statements::VERDICT_OF, values![run], |row| {
            let (verdict, exit_code) = (row.get(0)?, row.get(1)?);
            Ok(Self { verdict, exit_code, record_sha256: row.get(2)?, nth: row.get(3)? })
        })
    }
}

/// The store, and the right to write to it.
#[derive(Debug)]
pub struct Store {
    folder: Folder,
    writer: Box<dyn Database>,
    /// Devices that are being tested, each with its run.
    admitted: BTreeMap<String, String>,
    /// The names of all sinks.
    sinks: Arc<[String]>,
    /// The plant's clock, if it was heard since the start.
    plant_clock: Option<HeardClock>,
    /// How many changes were begun.
    changes: u64,
    /// The file that the writer writes to. Another one may have its name by now.
    opened: Opened,
    lock: File,
}

impl Store {
    /// Opens the store in `folder`, which is made if it does not exist.
    ///
    /// # Errors
    /// [`StoreError`] when another program has it, or it cannot be made, read or written.
    pub fn open(folder: &Folder) -> Result<Self, StoreError> {
        folder.refuse_path()?;
        folder.refuse_unfinished_restore()?;
        folder.refuse_other_users()?;
        for place in [folder.evidence(), folder.spools()] {
            make_folder(&place).map_err(|source| folder.refused(source))?;
        }
        let lock = folder.lock()?;
        // A restore may have begun meanwhile.
        folder.refuse_unfinished_restore()?;
        folder.refuse_lost_database()?;
        let (log, known) = generation::of_left_log(folder)?;
        let known = generation::choose(folder, &lock, log, known)?;
        let mut writer = folder.writer()?;
        // If the start fails, a log that was left stays as it is: it may belong to another database after all.
        writer.leave_log(log != Log::None);
        if log == Log::Unknown {
            tracing::warn!(
                "station.db-wal was left by a program that was killed, or ended while another one read station.db; all of station.db is \
                 looked at first, which takes a while"
            );
            generation::refuse_damaged(folder, &mut *writer)?;
        }
        folder.refuse_lost_tables(&mut *writer)?;
        migrations::apply(&mut *writer, &folder.database(), clock::now_ms())?;
        let opened = generation::begin(folder, &lock, &mut *writer, known)?;
        writer.leave_log(false);
        crate::record::synced(&folder.0)?;
        Ok(Self {
            folder: folder.clone(),
            writer,
            admitted: BTreeMap::new(),
            sinks: Arc::default(),
            plant_clock: None,
            changes: 0,
            opened,
            lock,
        })
    }

    /// Opens the store in `folder`, which must exist.
    ///
    /// # Errors
    /// Like [`Self::open`], and when there is none.
    pub(crate) fn open_existing(folder: &Folder) -> Result<Self, StoreError> {
        folder.refuse_no_results()?;
        Self::open(folder)
    }

    /// Folds the write-ahead log into the database, so that this one file has everything. If it fails, nothing is lost.
    pub fn fold_log(&mut self) {
        if !self.opened.is_unspoilt() {
            return tracing::warn!("the write-ahead log stays beside the database, which is another one");
        }
        // The file changes, so it needs a new number: what is written from now on is no log of its earlier copies.
        if let Err(error) = self.opened.fold(&self.folder, &self.lock, &mut *self.writer) {
            return tracing::warn!("the write-ahead log stays beside the database: {error}");
        }
        let folded = self.writer.one("PRAGMA wal_checkpoint(TRUNCATE)", &[], |row| row.get::<i64>(0));
        match folded {
            Ok(0) => {}
            Ok(_) => tracing::warn!(
                "the write-ahead log stays beside the database, which somebody reads; the next start may look at all of the database"
            ),
            Err(error) => tracing::warn!("the write-ahead log stays beside the database: {error}"),
        }
    }

    /// Its folder.
    #[must_use]
    pub fn folder(&self) -> &Folder {
        &self.folder
    }

    /// An id of the moment `now_ms`, greater than those of all runs and rebindings here: ids are in the order in which these
    /// began, even if the clock was set back in between.
    ///
    /// # Errors
    /// [`StoreError`] when the database cannot be read, or there is no randomness.
    pub fn new_id(&mut self, now_ms: i64) -> Result<Uuid, StoreError> {
        let newest = self.newest_id()?;
        let id = ids::new(now_ms)?;
        match newest {
            Some(newest) if newest > id.to_string() => Ok(ids::new(ids::made_ms(&newest) + 1)?),
            _ => Ok(id),
        }
    }

    /// The greatest id of a run or a rebinding.
    fn newest_id(&mut self) -> Result<Option<String>, StoreError> {
        self.read("to tell its newest run", |from| from.one(statements::NEWEST_ID, &[], |row| row.get(0)))
    }

    /// Enters an open run. Only then may its board be touched. Returns its head with the unit's id and the fence.
    ///
    /// # Errors
    /// [`StoreError::BeingJudged`] when the lane or the unit has an open run already; others when the database does not take it,
    /// or the station's clock disagrees with the plant's or with the last run.
    pub fn begin(&mut self, run: RunHead, plan: &PlanRecord) -> Result<RunHead, StoreError> {
        self.refuse_misdated(&run)?;
        match self.change("to begin a run", |to| rows::open(to, &run, plan)) {
            Ok((unit_id, fence)) => Ok(RunHead { unit_id, fence, ..run }),
            Err(StoreError::Database { source, .. }) if source.is_conflict() => {
                Err(self.in_the_way(&run, source))
            }
            Err(error) => Err(error),
        }
    }

    /// Why `run` cannot begin, after a `conflict` in the database.
    fn in_the_way(&mut self, run: &RunHead, conflict: DatabaseError) -> StoreError {
        let is_in_the_way = |open: &RunHead| {
            (&open.product, &open.serial) == (&run.product, &run.serial)
                || (&open.station, &open.lane) == (&run.station, &run.lane)
        };
        let open = self.open_runs().map(|open| open.into_iter().map(|open| open.run).find(is_in_the_way));
        match open {
            Ok(Some(RunHead { serial, lane, .. })) => StoreError::BeingJudged { serial, lane },
            Ok(None) => StoreError::of_file(&self.folder.database(), "to begin a run", conflict),
            Err(error) => error,
        }
    }

    /// Ends an open run: the record on the disk first, then all rows in one transaction. Returns the verdict as a
    /// second connection reads it back. Only then may it be shown.
    ///
    /// # Errors
    /// [`StoreError`] when anything is not as it was written. There is no verdict then.
    pub fn finish(&mut self, record: &Record, steps: u32) -> Result<Stored, StoreError> {
        let bytes = record.bytes(steps)?;
        let hash = self.folder.blobs().put(&bytes)?;
        let run = || record.run.id.clone();
        let (sinks, is_reference) = (Arc::clone(&self.sinks), record.is_of_reference());
        let changed = self.change("to end a run", |to| {
            let changed = rows::finish(to, record, &hash, is_reference)?;
            if changed == 1 {
                outbox::enter(to, &sinks, Kind::Run, &record.run.id)?;
            }
            Ok(changed)
        })?;
        if changed != 1 {
            return Err(StoreError::NotOpen { run: run() });
        }
        self.forget_device_of(&record.run.id);
        let (stored, _) = self.saved(&run())?;
        if stored.record_sha256 == hash { Ok(stored) } else { Err(StoreError::ReadsOtherwise { run: run() }) }
    }

    /// Lets the device of a run that is over be judged again.
    fn forget_device_of(&mut self, run: &str) {
        self.admitted.retain(|_, admitted| admitted != run);
    }

    /// Like [`Self::saved`], for a run that was ended without being read back.
    ///
    /// # Errors
    /// Like [`Self::saved`].
    pub fn settled(&mut self, run: &str) -> Result<(Stored, Record), StoreError> {
        let saved = self.saved(run)?;
        self.forget_device_of(run);
        Ok(saved)
    }

    /// A run that is over, as a second connection reads it back.
    ///
    /// # Errors
    /// [`StoreError`] when it is not there, or its row and its record differ, or another file has the database's name.
    pub fn saved(&self, run: &str) -> Result<(Stored, Record), StoreError> {
        let otherwise = || StoreError::ReadsOtherwise { run: run.to_owned() };
        let stored = self.folder.verdict_of(run)?.ok_or_else(otherwise)?;
        let record = Record::parse(&self.folder.blobs().get(&stored.record_sha256)?)?;
        // If another file had the name, SQLite would have read it together with the log of this one.
        self.refuse_replaced()?;
        let is_same = stored.verdict == record.conclusion.verdict && record.run.id == run;
        if is_same { Ok((stored, record)) } else { Err(otherwise()) }
    }

    /// Every run that is open, the earliest first.
    ///
    /// # Errors
    /// [`StoreError`] when the database cannot be read.
    pub fn open_runs(&mut self) -> Result<Vec<OpenRun>, StoreError> {
        self.read("to tell its open runs", |from| from.all(statements::OPEN_RUNS, &[], open_run))
    }

    /// Another number after each change: whoever has found something out need not look again while it is the same.
    pub(crate) fn changes(&self) -> u64 {
        self.changes
    }

    /// What `read` finds.
    fn read<T>(
        &mut self,
        doing: &'static str,
        read: impl FnOnce(&mut dyn Database) -> Result<T, DatabaseError>,
    ) -> Result<T, StoreError> {
        let path = self.folder.database();
        read(&mut *self.writer).map_err(|source| StoreError::of_file(&path, doing, source))
    }

    /// Runs `change` in a transaction. Returns when all is on the disk, in the file that has the database's name.
    fn change<T>(
        &mut self,
        doing: &'static str,
        change: impl FnOnce(&mut dyn Database) -> Result<T, DatabaseError>,
    ) -> Result<T, StoreError> {
        self.refuse_replaced()?;
        self.changes += 1;
        let changed = self.read(doing, |writer| writer.transaction(change))?;
        self.refuse_replaced()?;
        if let Err(error) = self.opened.changed(&self.folder, &self.lock, &mut *self.writer) {
            tracing::warn!("station.db may still be taken for an earlier copy of it: {error}");
        }
        Ok(changed)
    }

    /// Refuses to go on when another file has the name of the database that was opened, or another database was written over it:
    /// what is written now would be lost. The same for the lock file, which keeps others from the folder by its name alone.
    fn refuse_replaced(&self) -> Result<(), StoreError> {
        self.folder.refuse_gone()?;
        let lock = self.folder.lock_file();
        if !self.opened.is_there(&self.folder) {
            Err(StoreError::Replaced { path: self.folder.database() })
        } else if !generation::is_named(&self.lock, &lock) {
            Err(StoreError::LockReplaced { path: lock })
        } else {
            Ok(())
        }
    }
}

impl Drop for Store {
    fn drop(&mut self) {
        if !self.opened.is_unspoilt() {
            self.writer.leave_log(true);
        }
    }
}

fn open_run(row: &Found<'_>) -> Result<OpenRun, DatabaseError> {
    let run = RunHead {
        id: row.get(0)?,
        station: row.get(1)?,
        lane: row.get(2)?,
        unit_id: row.get(3)?,
        product: row.get(4)?,
        serial: row.get(5)?,
        variant: row.get(7)?,
        operator: row.get(8)?,
        target: row.get(9)?,
        fence: row.get(10)?,
        started_ms: row.get(11)?,
        job: None,
    };
    Ok(OpenRun { run, plan_sha256: row.get(6)?, plan: [row.get(12)?, row.get(13)?, row.get(14)?] })
}

#[cfg(test)]
mod tests;
