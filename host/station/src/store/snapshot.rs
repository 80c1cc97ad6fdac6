//! The tables as they are at one moment, and as they come out when they are made anew from the records.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;

use halfrow::result::sha256;

use rusqlite::Connection;

use super::database::{Database, DatabaseError, Engine, Row as Found, Sqlite, Value, values};
use super::shape::Shape;
use super::table::{Rows, page};
use super::{
    Folder, OpenRun, Plant, Rebinding, StoreError, Stored, bindings, folder, generation, migrations,
    open_run, rows, statements,
};
use crate::plan::Production;
use crate::record::{PlanRecord, Record};

/// The tables that follow from the records and the audit, each with its key.
pub const TABLES: [(&str, &str); 11] = [
    ("plan", "sha256"),
    ("unit", "id"),
    ("binding", "id"),
    ("run", "id"),
    ("step", "run_id, seq, attempt"),
    ("measurement", "run_id, seq, attempt, name"),
    ("suspect", "run_id, rank"),
    ("attachment", "run_id, name"),
    ("day_count", "plan_sha256, station, lane, day"),
    ("retest", "unit_id, plan"),
    ("failure", "run_id, kind, name"),
];

/// The tables as they are at one moment, whatever is written meanwhile.
#[derive(Debug)]
pub struct Snapshot {
    of: Of,
    reader: RefCell<Box<dyn Database>>,
}

/// Whose tables they are.
#[derive(Debug)]
enum Of {
    Station(Folder),
    /// The one at this address.
    Plant(PathBuf),
}

impl Snapshot {
    /// The tables of the station in `folder`.
    ///
    /// # Errors
    /// [`StoreError`] when the database is not there or cannot be read.
    pub fn take(folder: &Folder) -> Result<Self, StoreError> {
        folder.refuse_no_results()?;
        generation::refuse_other_log(folder)?;
        let mut reader = folder.reader()?;
        folder.refuse_lost_tables(&mut *reader)?;
        folder.refuse_foreign_tables(&mut *reader)?;
        let reader = RefCell::new(reader);
        let snapshot = Self { of: Of::Station(folder.clone()), reader };
        let found = snapshot.read("to be read", |reader| {
            reader.batch("BEGIN")?;
            // The transaction begins with the first read.
            if folder::tables(reader)? == 0 { Ok(0) } else { migrations::newest(reader) }
        })?;
        if found == 0 {
            return Err(StoreError::Unfinished { path: folder.database() });
        }
        migrations::refuse_unknown_version(&folder.database(), found)?;
        Ok(snapshot)
    }

    /// The tables of the station that is at work in `folder`. Its start made the database, so that a folder without one was moved
    /// away since, or its disk was unmounted.
    ///
    /// # Errors
    /// Like [`Self::take`].
    pub(crate) fn at_work(folder: &Folder) -> Result<Self, StoreError> {
        Self::take(folder).map_err(|error| match (error, fs::metadata(folder.database())) {
            (StoreError::NoResults { .. }, Err(source)) => folder.refused(source),
            (error, _) => error,
        })
    }

    /// The tables of a plant, until [`Self::end`].
    ///
    /// # Errors
    /// [`StoreError`] when it is not there, or its tables were made older or newer since the connection was made.
    pub fn of_plant(plant: Plant) -> Result<Self, StoreError> {
        let Plant { shown, database } = plant;
        let snapshot = Self { of: Of::Plant(shown.clone()), reader: RefCell::new(database) };
        let found = snapshot.read("to be read", |reader| {
            reader.batch("BEGIN ISOLATION LEVEL REPEATABLE READ READ ONLY")?;
            migrations::newest(reader)
        })?;
        migrations::refuse_unknown_version(&shown, found)?;
        Ok(snapshot)
    }

    /// The verdict of a run; none if the run is open or not there.
    pub(crate) fn verdict_of(&self, run: &str) -> Result<Option<Stored>, StoreError> {
        self.read("to tell a verdict", |from| Stored::of_run(from, run))
    }

    /// The connection to the plant, to be used again; none for a station, or when it does not work any more.
    #[must_use]
    pub fn end(self) -> Option<Plant> {
        let Of::Plant(shown) = self.of else { return None };
        let mut database = self.reader.into_inner();
        database.batch("ROLLBACK").ok().map(|()| Plant { shown, database })
    }

    /// The version of the tables.
    ///
    /// # Errors
    /// [`StoreError`] when the database cannot be read.
    pub fn version(&self) -> Result<i64, StoreError> {
        self.read("to tell its version", |reader| reader.one(migrations::NEWEST, &[], |row| row.get(0)))
    }

    /// The record with this hash, and its bytes.
    ///
    /// # Errors
    /// [`StoreError`] when it is not there, or not as it was written.
    pub fn record(&self, hash: &str) -> Result<(Record, Vec<u8>), StoreError> {
        let bytes = self.record_bytes(hash)?;
        Ok((Record::parse(&bytes)?, bytes))
    }

    fn record_bytes(&self, hash: &str) -> Result<Vec<u8>, StoreError> {
        let shown = match &self.of {
            Of::Station(folder) => return Ok(folder.blobs().get(hash)?),
            Of::Plant(shown) => shown,
        };
        let found = self.rows("to tell a record", statements::RECORD, values![hash], |row| row.get(0))?;
        let text: Option<String> = found.into_iter().next();
        let text = text.filter(|text| sha256([text.as_bytes()]) == hash);
        text.map(String::into_bytes).ok_or_else(|| StoreError::NoRecord {
            plant: shown.display().to_string(),
            sha256: hash.to_owned(),
        })
    }

    /// The bytes of a piece of evidence of this hash; none at a plant, which leaves it with the station.
    ///
    /// # Errors
    /// [`StoreError`] when it is not there, or not as it was written.
    pub fn evidence(&self, hash: &str) -> Result<Option<Vec<u8>>, StoreError> {
        match &self.of {
            Of::Station(folder) => Ok(Some(folder.blobs().get(hash)?)),
            Of::Plant(_) => Ok(None),
        }
    }

    /// Whether they are a plant's.
    pub(crate) const fn is_plant(&self) -> bool {
        matches!(self.of, Of::Plant(_))
    }

    /// Whether there is a piece of evidence of this hash here.
    #[must_use]
    pub(crate) fn has_evidence(&self, hash: &str) -> bool {
        matches!(&self.of, Of::Station(folder) if folder.blobs().path(hash).is_file())
    }

    /// What SQLite itself finds wrong with its file, and the tables, columns and indices that are missing, which it does not notice
    /// because it knows only the names in that file; nothing when all is well.
    ///
    /// # Errors
    /// [`StoreError`] when it cannot even look.
    pub fn damage(&self) -> Result<Vec<String>, StoreError> {
        let said: Vec<String> =
            self.read("to be checked", |reader| reader.all("PRAGMA integrity_check", &[], |row| row.get(0)))?;
        let wrong = said.into_iter().filter(|line| line != "ok");
        let here = self.read("to tell its tables", Shape::of)?;
        let right = Shape::of(&mut *Rebuilt::new()?.database).map_err(refused)?;
        Ok(wrong.chain(right.lost_in(&here)).collect())
    }

    /// The ids of all runs that are over, with the hashes of their records, the earliest first.
    ///
    /// # Errors
    /// [`StoreError`] when the database cannot be read.
    pub(crate) fn final_runs(&self) -> Result<Vec<(String, String)>, StoreError> {
        self.read("to tell its runs", |reader| {
            reader.all(statements::FINAL_RUNS, &[], |row| Ok((row.get(0)?, row.get(1)?)))
        })
    }

    /// Every run that is open, the earliest first.
    ///
    /// # Errors
    /// [`StoreError`] when the database cannot be read.
    pub fn open_runs(&self) -> Result<Vec<OpenRun>, StoreError> {
        self.read("to tell its open runs", |reader| reader.all(statements::OPEN_RUNS, &[], open_run))
    }

    /// Every binding that a person changed, the earliest first.
    ///
    /// # Errors
    /// [`StoreError`] when the database cannot be read.
    pub(crate) fn rebindings(&self) -> Result<Vec<Rebinding>, StoreError> {
        self.read("to tell who bound what", bindings::rebindings)
    }

    /// The runs of which waiver and audit tell different things.
    ///
    /// # Errors
    /// [`StoreError`] when the database cannot be read.
    pub(crate) fn waivers_unlike_audit(&self) -> Result<Vec<String>, StoreError> {
        self.rows("to tell its waivers", statements::WAIVERS_UNLIKE_AUDIT, values![], |row| row.get(0))
    }

    /// All rows of the table `name`, by its `key`.
    #[must_use]
    pub fn table(&self, name: &'static str, key: &'static str) -> Rows<'_> {
        Rows::by(move |after| self.read("to tell a table", |reader| page(reader, name, key, after)))
    }

    /// What `row` makes of each row of the query `text` with `values`.
    pub(crate) fn rows<T>(
        &self,
        doing: &'static str,
        text: &str,
        values: &[Value<'_>],
        row: impl FnMut(&Found<'_>) -> Result<T, DatabaseError>,
    ) -> Result<Vec<T>, StoreError> {
        self.read(doing, |reader| reader.all(text, values, row))
    }

    fn read<T>(
        &self,
        doing: &'static str,
        read: impl FnOnce(&mut dyn Database) -> Result<T, DatabaseError>,
    ) -> Result<T, StoreError> {
        let (engine, place) = match &self.of {
            Of::Station(folder) => (Engine::Sqlite, folder.database()),
            Of::Plant(shown) => (Engine::Postgres, shown.clone()),
        };
        read(&mut **self.reader.borrow_mut())
            .map_err(|source| StoreError::refused(engine, &place, doing, source))
    }
}

/// Tables that are made anew: in memory, and beyond 64 MiB in a temporary file.
#[derive(Debug)]
pub(crate) struct Rebuilt {
    database: Box<dyn Database>,
    /// What plans demand, by their hashes, as far as they had to be read; `None` where this program cannot.
    plans: BTreeMap<String, Option<Production>>,
}

impl Rebuilt {
    /// Empty tables.
    ///
    /// # Errors
    /// [`StoreError`] when there is no room for it.
    pub(crate) fn new() -> Result<Self, StoreError> {
        let opened = Connection::open("").and_then(|database| {
            database.execute_batch("PRAGMA journal_mode = MEMORY; PRAGMA cache_size = -65536")?;
            Ok(database)
        });
        let database = opened.map_err(|source| refused(source.into()))?;
        let mut database: Box<dyn Database> = Box::new(Sqlite::new(database));
        migrations::apply(&mut *database, "a rebuilt index".as_ref(), 0)?;
        Ok(Self { database, plans: BTreeMap::new() })
    }

    /// Enters the run of this record, whose hash is `hash`. Runs must come in the order of their ids.
    ///
    /// # Errors
    /// [`StoreError`] when it contradicts the runs before.
    pub(crate) fn add(&mut self, record: &Record, hash: &str) -> Result<(), StoreError> {
        let is_reference = self.is_reference(record);
        self.change(|to| {
            rows::open(to, &record.run, &record.plan)?;
            rows::finish(to, record, hash, is_reference).map(drop)
        })
    }

    /// Whether the unit of this record checks shifts. There may be a million records by one plan, and only that is read.
    pub(super) fn is_reference(&mut self, record: &Record) -> bool {
        let PlanRecord { sha256, text, .. } = &record.plan;
        if !self.plans.contains_key(sha256) {
            self.plans.insert(sha256.clone(), Production::of_text(text));
        }
        record.is_reference_by(self.plans.get(sha256).and_then(Option::as_ref))
    }

    /// Enters an open run.
    ///
    /// # Errors
    /// Like [`Self::add`].
    pub(crate) fn add_open(&mut self, open: &OpenRun) -> Result<(), StoreError> {
        let [name, version, text] = open.plan.clone();
        let plan = PlanRecord { sha256: open.plan_sha256.clone(), name, version, text, files: None };
        self.change(|to| rows::open(to, &open.run, &plan).map(drop))
    }

    /// Enters a binding that a person changed.
    ///
    /// # Errors
    /// Like [`Self::add`].
    pub(crate) fn add_rebinding(&mut self, change: &Rebinding) -> Result<(), StoreError> {
        self.change(|to| bindings::rebind(to, change))
    }

    /// All rows of the table `name`, by its `key`.
    pub(crate) fn table(&mut self, name: &'static str, key: &'static str) -> Rows<'_> {
        Rows::by(move |after| page(&mut *self.database, name, key, after).map_err(refused))
    }

    /// Runs `change` in a transaction.
    pub(super) fn change<T>(
        &mut self,
        change: impl FnOnce(&mut dyn Database) -> Result<T, DatabaseError>,
    ) -> Result<T, StoreError> {
        self.database.transaction(change).map_err(refused)
    }
}

fn refused(source: DatabaseError) -> StoreError {
    StoreError::Database { path: "a rebuilt index".into(), doing: "a record", source }
}
