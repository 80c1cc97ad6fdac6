//! The plant: the results of all stations in one PostgreSQL database, which their outboxes fill.
//!
//! The tables are those of a station. The rows of a run follow from its record alone, so the plant has what the station
//! has. Only what is counted over the runs of a unit is counted over all stations.

mod address;
pub(super) mod arrived;
mod audit;
mod boards;
mod jobs;
mod kept;
mod link;
mod plans;
mod prune;

pub use address::{PlantAddress, PlantAddressError};
pub(crate) use boards::{LEASE_MS, waiters};
pub use boards::{Lease, SharedBoard, Turn, Waiter, Waiting, boards};
pub use jobs::{Claim, Job, JobState, NewJob, Wanted, Worker, jobs};
pub(crate) use jobs::{JobsInState, counted_jobs, open_jobs, seen_units};
pub(crate) use kept::KeptRun;
pub use link::PlantLink;
pub(crate) use plans::publications;

use std::path::PathBuf;
use std::sync::Arc;

use parking_lot::Mutex;

use super::database::{Database, DatabaseError, values};
use super::{By, Parcel, StoreError, migrations, statements as sql};
use crate::clock::{self, HeardClock};
use crate::trust::CertificateError;

/// A delivery that failed.
#[derive(Debug, thiserror::Error)]
pub enum PlantError {
    /// The plant has another record of this run: two runs were made under one number, or one was changed.
    #[error(
        "the plant has the run {run} with the record {theirs}, and this station with {ours}; nothing was changed: keep both, and \
         find out which is right"
    )]
    OtherContent {
        /// The run.
        run: String,
        /// The hash of this station's record.
        ours: String,
        /// The hash of the plant's.
        theirs: String,
    },
    /// The plant does not yet have the run that this entry belongs to.
    #[error(
        "the plant does not have the run {run} yet, which comes first, so this is tried again; if the plant was put back, have all sent \
         again by `halfrow-station outbox again plant`"
    )]
    NotYet {
        /// The run, by its id, or of which unit.
        run: String,
    },
    /// The plant lacks a run that it had before: it was restored from a copy, or is another plant.
    #[error(
        "the plant has lost the run {run}, so it was put back or is another one, and takes nothing more; have all sent again by \
         `halfrow-station outbox again plant`"
    )]
    Lost {
        /// The newest run that it certainly had.
        run: String,
    },
    /// The plant does not have what was just sent to it.
    #[error("the plant has not kept {subject}, which was sent; it is tried again")]
    NotKept {
        /// What was sent.
        subject: String,
    },
    /// Another station of the plant has this station's name, perhaps with a copy of its folder.
    #[error(
        "another station of this plant is called {name}; nothing is sent until one of the two has another name in its settings, no \
         copy of this folder is at work any more, or `halfrow-station plant forget {name}` says that this folder is the station's \
         new one"
    )]
    OtherStation {
        /// The name.
        name: String,
    },
    /// The plant's database has another order of texts or another encoding than a station needs.
    #[error(
        "the database {plant} has the collation {collation} and the encoding {encoding}; make one by: createdb --template \
         template0 --encoding UTF8 --locale C NAME"
    )]
    Collation {
        /// Its address.
        plant: String,
        /// Its collation.
        collation: String,
        /// Its encoding.
        encoding: String,
    },
    /// Its database.
    #[error(transparent)]
    Store(#[from] StoreError),
}

impl PlantError {
    /// Whether the plant is unavailable, as opposed to refusing this one thing.
    #[must_use]
    pub fn is_away(&self) -> bool {
        matches!(self, Self::Store(error) if error.is_away())
    }

    /// Whether its tables are of another version than this program's.
    #[must_use]
    pub(crate) fn is_of_other_version(&self) -> bool {
        matches!(self, Self::Store(StoreError::Newer { .. } | StoreError::Older { .. }))
    }

    /// Whether the plant will never take this one thing as it is.
    #[must_use]
    pub(crate) fn is_final(&self) -> bool {
        match self {
            Self::OtherContent { .. } => true,
            Self::Store(error) => error.is_of_content(),
            _ => false,
        }
    }
}

/// How long a station may be silent before it is taken to be away, in milliseconds: it reports every half minute.
pub(crate) const SILENT_MS: i64 = 120_000;

/// When this program told the plant of its station last, in milliseconds since 1970, UTC, by the plant's clock; `None` if that is
/// not known. Clones share it.
#[derive(Clone, Debug, Default)]
pub struct LastTold(Arc<Mutex<Option<i64>>>);

/// What a station tells the plant of itself.
#[derive(Clone, Debug)]
pub struct Introduction {
    /// The station's name.
    pub name: String,
    /// The id of its folder.
    pub origin: String,
    /// Its program's version.
    pub program: String,
    /// Its plans: product, name and version of each, one a line.
    pub plans: String,
    /// Entries that the plant does not have yet.
    pub unsent: u32,
    /// Those of them that wait for a person.
    pub dead: u32,
    /// When the plant was told so last.
    pub told: LastTold,
}

/// A connection to a plant.
#[derive(Debug)]
pub struct Plant {
    pub(super) shown: PathBuf,
    pub(super) database: Box<dyn Database>,
}

impl Plant {
    /// The plant at `address`, which must have the tables that this program knows.
    ///
    /// # Errors
    /// [`StoreError`] when it is not there, or its tables are older or newer.
    pub fn connect(address: &PlantAddress) -> Result<Self, StoreError> {
        let mut plant = Self::reach(address)?;
        let found = plant.carry_out("to tell its version", |database| {
            let there = "SELECT to_regclass('schema_version') IS NOT NULL, current_schema() IS NULL";
            match database.one(there, &[], |row| Ok((row.get(0)?, row.get(1)?)))? {
                (true, _) => migrations::newest(database),
                (false, true) => Err(DatabaseError::NoSchema),
                (false, false) => Ok(0),
            }
        })?;
        migrations::refuse_unknown_version(&plant.shown, found)?;
        Ok(plant)
    }

    /// Makes the tables of the plant at `address`, or copies those that exist and brings them up to date. A program that
    /// does so at the same time waits. Returns the version.
    ///
    /// # Errors
    /// [`PlantError::Store`] when it is not there or its tables are newer, [`PlantError::Collation`].
    pub fn prepare(address: &PlantAddress) -> Result<usize, PlantError> {
        let mut plant = Self::reach(address)?;
        plant.refuse_other_collation()?;
        plant.carry_out("to be prepared", |database| database.batch(LOCK))?;
        migrations::apply(&mut *plant.database, &plant.shown, clock::now_ms())?;
        Ok(sql::SCHEMAS.len())
    }

    /// Stores a parcel, completely or not at all. When this returns, it is certainly there: it was read back after the commit.
    ///
    /// # Errors
    /// [`PlantError`] when it is not there, or that is not known.
    pub fn take(&mut self, parcel: &Parcel) -> Result<(), PlantError> {
        match parcel {
            Parcel::Run { record, text, sha256 } => {
                self.change("a run", |to| arrived::run(to, record, text, sha256))?;
                self.read_back_run(&record.run.id, sha256)
            }
            Parcel::Waiver { id, waiver } => {
                if self.hash_of(&waiver.run)?.is_none() {
                    return Err(PlantError::NotYet { run: waiver.run.clone() });
                }
                self.change("a waiver", |to| arrived::waiver(to, id, waiver))?;
                self.read_back(sql::WAIVER_BY_ID, id)
            }
            Parcel::Audit(line) => {
                let is_entered = self.change("a line of the audit", |to| arrived::audit(to, line))?;
                if let Some([product, serial]) = line.unit.as_ref().filter(|_| !is_entered) {
                    return Err(PlantError::NotYet { run: format!("of {product} {serial}") });
                }
                self.read_back(sql::AUDIT_BY_ID, &line.id)
            }
        }
    }

    /// Enters that this station is at work. Returns the plant's clock.
    ///
    /// # Errors
    /// [`PlantError::OtherStation`] when another station has its name, or a copy of its folder is at work, too: somebody else has told
    /// the plant of it since this program did.
    pub fn see(&mut self, station: &Introduction) -> Result<HeardClock, PlantError> {
        let Introduction { name, origin, program, plans, unsent, dead, told } = station;
        // Its clones must not tell the plant meanwhile, or that would look like a copy.
        let mut told = told.0.lock();
        // Should there be no answer, the plant may have been told all the same.
        let last_ms = told.take().unwrap_or(i64::MAX);
        let seen_ms: Option<i64> = self.carry_out("to hear of a station", |to| {
            let of = values![name, origin, program, plans, *unsent, *dead, last_ms, SILENT_MS];
            to.first(sql::SEEN, of, |row| row.get(0))
        })?;
        *told = Some(seen_ms.unwrap_or(last_ms));
        seen_ms.map(HeardClock::shows).ok_or_else(|| PlantError::OtherStation { name: name.clone() })
    }

    /// Checks that the plant still has this run, which it certainly had.
    ///
    /// # Errors
    /// [`PlantError::Lost`] when it does not.
    pub(crate) fn refuse_loss_of(&mut self, run: &str) -> Result<(), PlantError> {
        self.hash_of(run)?.map(drop).ok_or_else(|| PlantError::Lost { run: run.to_owned() })
    }

    /// Forgets which folder the station of this name has, so that it may have another one; the audit keeps who said so, and
    /// why. Its results stay. Returns whether there was one.
    ///
    /// # Errors
    /// [`StoreError`] when the plant does not take it.
    pub fn forget(&mut self, station: &str, by: By<'_>) -> Result<bool, StoreError> {
        self.audited("to forget a station", by.does("forget station", station), |to| {
            to.execute(sql::FORGET_STATION, values![station])
        })
    }

    /// The time by the plant's clock, in milliseconds since 1970, UTC.
    ///
    /// # Errors
    /// [`StoreError`] when the plant does not tell it.
    pub fn now_ms(&mut self) -> Result<i64, StoreError> {
        self.carry_out("to tell the time", |database| database.one(sql::NOW, &[], |row| row.get(0)))
    }

    fn reach(address: &PlantAddress) -> Result<Self, StoreError> {
        let shown = PathBuf::from(address.to_string());
        let database = address.connect().map_err(|source| {
            let plant = address.to_string();
            match CertificateError::of(&plant, &source) {
                Some(error) => error.into(),
                None => StoreError::Plant { plant, doing: "a connection", source },
            }
        })?;
        Ok(Self { shown, database: Box::new(database) })
    }

    fn refuse_other_collation(&mut self) -> Result<(), PlantError> {
        let (collation, encoding): (String, String) =
            self.carry_out("to tell its collation", |database| {
                let text = "SELECT datcollate::text, pg_encoding_to_char(encoding)::text FROM pg_database
                WHERE datname = current_database()";
                database.one(text, &[], |row| Ok((row.get(0)?, row.get(1)?)))
            })?;
        let is_by_bytes = ["C", "POSIX", "C.UTF-8", "C.utf8"].contains(&collation.as_str());
        if is_by_bytes && encoding == "UTF8" {
            return Ok(());
        }
        Err(PlantError::Collation { plant: self.shown.display().to_string(), collation, encoding })
    }

    /// The hash of a run's record, and whether that record is there; none if the run is not.
    fn hash_of(&mut self, run: &str) -> Result<Option<(String, bool)>, PlantError> {
        Ok(self.carry_out("to be read back", |database| {
            database.first(sql::HASH_OF, values![run], |row| Ok((row.get(0)?, row.get(1)?)))
        })?)
    }

    fn read_back_run(&mut self, run: &str, ours: &str) -> Result<(), PlantError> {
        match self.hash_of(run)? {
            Some((theirs, true)) if theirs == ours => Ok(()),
            Some((theirs, _)) if theirs != ours => {
                Err(PlantError::OtherContent { run: run.to_owned(), ours: ours.to_owned(), theirs })
            }
            _ => Err(PlantError::NotKept { subject: run.to_owned() }),
        }
    }

    fn read_back(&mut self, text: &str, subject: &str) -> Result<(), PlantError> {
        let found =
            self.carry_out("to be read back", |database| database.first(text, values![subject], |_| Ok(())))?;
        found.ok_or_else(|| PlantError::NotKept { subject: subject.to_owned() })
    }

    /// Changes what the plant has, in a transaction that checks the version of the tables: they may have been upgraded since the
    /// connection was made, and this program does not know what belongs in others. What it holds it may keep, and give back.
    fn change<T>(
        &mut self,
        doing: &'static str,
        act: impl FnOnce(&mut dyn Database) -> Result<T, DatabaseError>,
    ) -> Result<T, StoreError> {
        let shown = self.shown.clone();
        self.carry_out(doing, |database| {
            database.transaction(|to| {
                let found = migrations::newest(to)?;
                match migrations::refuse_unknown_version(&shown, found) {
                    Ok(()) => act(to).map(Ok),
                    Err(other) => Ok(Err(other)),
                }
            })
        })?
    }

    fn carry_out<T>(
        &mut self,
        doing: &'static str,
        act: impl FnOnce(&mut dyn Database) -> Result<T, DatabaseError>,
    ) -> Result<T, StoreError> {
        let plant = || self.shown.display().to_string();
        act(&mut *self.database).map_err(|source| StoreError::Plant { plant: plant(), doing, source })
    }
}

/// Lets one program at a time prepare a plant. The lock ends with the connection.
const LOCK: &str = "SELECT pg_advisory_lock(7249613001)";
/// Lets one program at a time share a board. The lock ends with the transaction.
const LOCK_BOARDS: &str = "SELECT pg_advisory_xact_lock(7249613002)";
