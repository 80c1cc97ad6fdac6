//! The station's own store, on its own disk.
//!
//! ```text
//!  station.db          SQLite, the index; write-ahead log, every commit on the disk before it returns
//!  blobs/ab/abcd…      evidence by its hash; records among it
//!  spool/RUN/          what a run writes down while it is under way
//!  station.lock        held by the one program that writes
//! ```
//!
//! A run is in the store, open, before its board is touched, and its verdict is shown when a second connection has read
//! it back.

mod again;
mod audit;
mod bindings;
mod error;
mod keeping;
mod migrations;
mod rows;
mod shared;
mod shift;
mod snapshot;
pub(crate) mod statements;
mod waivers;

use std::collections::BTreeMap;
use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};
use std::time::Duration;

use rusqlite::{Connection, OpenFlags, OptionalExtension as _, TransactionBehavior};

pub use again::AgainError;
pub use bindings::{Admission, Change, RebindError, Rebinding, is_device};
pub use error::StoreError;
pub use keeping::Removed;
pub use shared::SharedStore;
pub use shift::{Checked, Owed};
pub use snapshot::{Rebuilt, Row, Snapshot, TABLES};
pub use waivers::{NoWaiver, Waiver};

use crate::clock;
use crate::record::{Blobs, PlanRecord, Record, RunHead};

/// How long a reader waits for a writer.
const PATIENCE: Duration = Duration::from_secs(10);

/// The folder of a station.
#[derive(Clone, Debug)]
pub struct Folder(PathBuf);

impl Folder {
    /// The station's folder `path`, whether it is there or not.
    #[must_use]
    pub fn new(path: &Path) -> Self {
        Self(path.to_owned())
    }

    /// The database.
    #[must_use]
    pub fn database(&self) -> PathBuf {
        self.0.join("station.db")
    }

    /// The evidence.
    #[must_use]
    pub fn blobs(&self) -> Blobs {
        Blobs::new(self.0.join("blobs"))
    }

    /// What the run of this id writes down while it is under way.
    #[must_use]
    pub fn spool(&self, run: &str) -> PathBuf {
        self.spools().join(run)
    }

    /// What all runs that are under way write down.
    #[must_use]
    pub fn spools(&self) -> PathBuf {
        self.0.join("spool")
    }

    fn refused(&self, source: std::io::Error) -> StoreError {
        StoreError::Folder { folder: self.0.clone(), source }
    }

    fn lock(&self) -> Result<File, StoreError> {
        let file = File::options().create(true).truncate(false).write(true).open(self.0.join("station.lock"));
        let file = file.map_err(|source| self.refused(source))?;
        match file.try_lock() {
            Ok(()) => Ok(file),
            Err(TryLockError::WouldBlock) => Err(StoreError::InUse { folder: self.0.clone() }),
            Err(TryLockError::Error(source)) => Err(self.refused(source)),
        }
    }

    /// A connection that cannot write.
    fn reader(&self) -> Result<Connection, StoreError> {
        let path = self.database();
        let open = || {
            let reader = Connection::open_with_flags(&path, OpenFlags::SQLITE_OPEN_READ_ONLY)?;
            reader.busy_timeout(PATIENCE)?;
            Ok(reader)
        };
        open().map_err(|source| StoreError::Database { path: path.clone(), doing: "to be read", source })
    }
}

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
    /// The verdict, as it is written.
    pub verdict: String,
    /// The exit code.
    pub exit_code: u8,
    /// The hash of the record.
    pub record_sha256: String,
    /// The how-manieth judgement of this unit by this plan it is.
    pub nth: i64,
}

/// The store, and the right to write to it.
#[derive(Debug)]
pub struct Store {
    folder: Folder,
    writer: Connection,
    /// Devices that are being tested, each with its run.
    admitted: BTreeMap<String, String>,
    _lock: File,
}

impl Store {
    /// The store in `folder`, which is made if it is not there.
    ///
    /// # Errors
    /// [`StoreError`] when another program has it, or it cannot be made, read or written.
    pub fn open(folder: &Folder) -> Result<Self, StoreError> {
        for place in ["blobs", "spool"] {
            fs::create_dir_all(folder.0.join(place)).map_err(|source| folder.refused(source))?;
        }
        let lock = folder.lock()?;
        let path = folder.database();
        let refused = |doing| move |source| StoreError::Database { path: folder.database(), doing, source };
        let mut writer = Connection::open(&path).map_err(refused("to be opened"))?;
        writer.busy_timeout(PATIENCE).map_err(refused("to wait"))?;
        let mode: String = writer
            .query_row("PRAGMA journal_mode = WAL", [], |row| row.get(0))
            .map_err(refused("a write-ahead log"))?;
        if mode != "wal" {
            return Err(StoreError::NoLog { path, mode });
        }
        // A commit that returns is on the disk. With less, a power cut takes back what was shown.
        writer
            .execute_batch("PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON")
            .map_err(refused("to be safe"))?;
        migrations::apply(&mut writer, &path, clock::now_ms())?;
        crate::record::synced(&folder.0)?;
        Ok(Self { folder: folder.clone(), writer, admitted: BTreeMap::new(), _lock: lock })
    }

    /// The store in `folder`, which must be there.
    ///
    /// # Errors
    /// As [`Self::open`], and when there is none.
    pub fn open_existing(folder: &Folder) -> Result<Self, StoreError> {
        folder.reader()?;
        Self::open(folder)
    }

    /// Its folder.
    #[must_use]
    pub fn folder(&self) -> &Folder {
        &self.folder
    }

    /// Enters an open run. Only then may its board be touched. Returns its head with the unit's id and the fence.
    ///
    /// # Errors
    /// [`StoreError`] when the lane or the unit has an open run already, or the database does not take it.
    pub fn begin(&mut self, run: RunHead, plan: &PlanRecord) -> Result<RunHead, StoreError> {
        let (unit_id, fence) = self.change("to begin a run", |to| rows::open(to, &run, plan))?;
        Ok(RunHead { unit_id, fence, ..run })
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
        let changed = self.change("to end a run", |to| rows::finish(to, record, &hash))?;
        if changed != 1 {
            return Err(StoreError::NotOpen { run: run() });
        }
        self.admitted.retain(|_, admitted| *admitted != record.run.id);
        let (stored, _) = self.saved(&run())?;
        if stored.record_sha256 == hash { Ok(stored) } else { Err(StoreError::ReadsOtherwise { run: run() }) }
    }

    /// A run that is over, as a second connection reads it back.
    ///
    /// # Errors
    /// [`StoreError`] when it is not there, or its row and its record differ.
    pub fn saved(&self, run: &str) -> Result<(Stored, Record), StoreError> {
        let otherwise = || StoreError::ReadsOtherwise { run: run.to_owned() };
        let stored = self.folder.verdict_of(run)?.ok_or_else(otherwise)?;
        let record = Record::parse(&self.folder.blobs().get(&stored.record_sha256)?)?;
        let is_same = stored.verdict == record.conclusion.verdict.to_string() && record.run.id == run;
        if is_same { Ok((stored, record)) } else { Err(otherwise()) }
    }

    /// Every run that is open, the earliest first.
    ///
    /// # Errors
    /// [`StoreError`] when the database cannot be read.
    pub fn open_runs(&self) -> Result<Vec<OpenRun>, StoreError> {
        let read = || -> rusqlite::Result<Vec<OpenRun>> {
            self.writer.prepare(statements::OPEN_RUNS)?.query_map([], open_run)?.collect()
        };
        read().map_err(|source| {
            let path = self.folder.database();
            StoreError::Database { path, doing: "to tell its open runs", source }
        })
    }

    fn refuses(&self, doing: &'static str, source: rusqlite::Error) -> StoreError {
        StoreError::Database { path: self.folder.database(), doing, source }
    }

    /// What `change` returns once all that it did is on the disk. A change of no row is taken back.
    fn change<T>(
        &mut self,
        doing: &'static str,
        change: impl FnOnce(&rusqlite::Transaction<'_>) -> rusqlite::Result<T>,
    ) -> Result<T, StoreError> {
        let path = self.folder.database();
        let run = || {
            let transaction = self.writer.transaction_with_behavior(TransactionBehavior::Immediate)?;
            let done = change(&transaction)?;
            transaction.commit()?;
            Ok(done)
        };
        run().map_err(|source| StoreError::Database { path, doing, source })
    }
}

impl Folder {
    /// The verdict of a run, as a connection of its own reads it; none if the run is open or not there.
    ///
    /// # Errors
    /// [`StoreError`] when the database cannot be read.
    pub fn verdict_of(&self, run: &str) -> Result<Option<Stored>, StoreError> {
        let reader = self.reader()?;
        let stored = reader.query_row(statements::VERDICT_OF, [run], |row| {
            Ok(Stored {
                verdict: row.get(0)?,
                exit_code: row.get(1)?,
                record_sha256: row.get(2)?,
                nth: row.get(3)?,
            })
        });
        let path = self.database();
        stored.optional().map_err(|source| StoreError::Database { path, doing: "to tell a verdict", source })
    }
}

fn open_run(row: &rusqlite::Row<'_>) -> rusqlite::Result<OpenRun> {
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
    };
    Ok(OpenRun { run, plan_sha256: row.get(6)?, plan: [row.get(12)?, row.get(13)?, row.get(14)?] })
}
