//! Why the store cannot do what it was asked.

use std::io;
use std::path::{Path, PathBuf};

use super::database::{DatabaseError, Engine};
use crate::ids::NoRandomness;
use crate::record::{BlobError, RecordError};
use crate::trust::CertificateError;

/// Something that the store cannot do.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// Another program is using the station's folder.
    #[error("another halfrow-station works in {}; wait until it is done, name another folder, or use the page of the one that serves it", folder.display())]
    InUse {
        /// The folder.
        folder: PathBuf,
    },
    /// The station's folder cannot be used.
    #[error("the station's folder {} cannot be used; check that it is there, is writable and has space", folder.display())]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The station's folder is another user's, or has something of another user's that this one may not change.
    #[error(
        "{} belongs to {owner}, and {user}, by whom this program is run, may not change it; run it as the user of the station, and if \
         anything in the folder is not that user's, as root: chown -R USER: {}",
        path.display(),
        folder.display()
    )]
    OtherUser {
        /// What may not be changed.
        path: PathBuf,
        /// Whose it is.
        owner: String,
        /// Whose process this is.
        user: String,
        /// The station's folder.
        folder: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The folder's path is not UTF-8. Lanes are told it in JSON, and SQLite copies a database only to a file of such a name.
    #[error("the path {} is not UTF-8, and no station works in such a folder; rename what is not, or name another folder", folder.display())]
    Path {
        /// The folder.
        folder: PathBuf,
    },
    /// No station has ever written to the folder.
    #[error("{} has no station's results; name the folder that a station writes to", folder.display())]
    NoResults {
        /// The folder.
        folder: PathBuf,
    },
    /// The folder has evidence of earlier runs, or a log of them, but no database, or an empty one.
    #[error(
        "{} has evidence of earlier runs and no station.db that tells of them; bring back station.db and station.db-wal, restore the folder from a copy, or name \
         another folder",
        folder.display()
    )]
    DatabaseGone {
        /// The folder.
        folder: PathBuf,
    },
    /// A copy is being restored into the folder, or its program was killed.
    #[error(
        "a restore in {} has not ended; wait for it, or, if none is at work, remove .partial there and what was \
         already moved out of it into the folder, and restore again",
        folder.display()
    )]
    Unrestored {
        /// The folder.
        folder: PathBuf,
    },
    /// The station's database refused an operation. Most often its disk is full: `halfrow-station prune` makes room while the station
    /// is stopped, as the handbook's page on storage says.
    #[error("the database {} refuses {doing}; check that its folder is writable and has space", path.display())]
    Database {
        /// The file.
        path: PathBuf,
        /// What was under way.
        doing: &'static str,
        /// Why.
        source: DatabaseError,
    },
    /// Another program holds the station's database.
    #[error(
        "another program has the database {} locked, which refuses {doing}; end that program, such as sqlite3 or one that \
         copies the folder",
        path.display()
    )]
    Locked {
        /// The file.
        path: PathBuf,
        /// What was under way.
        doing: &'static str,
        /// What SQLite says.
        source: DatabaseError,
    },
    /// The database file is damaged or not a database, or the log beside it belongs to another one.
    #[error(
        "the database {} is damaged, or no database at all, or the station.db-wal beside it is the log of another \
         one; move them aside, look at the disk, and restore the folder from a copy",
        path.display()
    )]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What SQLite found.
        source: DatabaseError,
    },
    /// The database file was replaced or removed while the program was using it.
    #[error(
        "the database {} was replaced or removed while this program was using it, and nothing more is kept, since \
         it would be lost; end the program, run `halfrow-station check` to see what the new database lacks, and \
         start the program again",
        path.display()
    )]
    Replaced {
        /// The file.
        path: PathBuf,
    },
    /// The file `station.lock` was replaced or removed while the program was using it.
    #[error(
        "{} was replaced or removed while this program was using its folder, and nothing more is kept, since \
         another program could start there as well; end this one, make sure that no other uses the folder, and \
         start it again",
        path.display()
    )]
    LockReplaced {
        /// The file.
        path: PathBuf,
    },
    /// The log beside the database belongs to another database.
    #[error(
        "the database {} was put there while station.db-wal beside it is the log of another database, which would spoil this one; if both files \
         were put there together, or an earlier program has worked there since, move station.lock out of the folder, or else bring back \
         the database that was there, or move station.db-wal and station.db-shm out of the folder, keep them, and see by \
         `halfrow-station check` what this one lacks",
        path.display()
    )]
    OtherLog {
        /// The file.
        path: PathBuf,
    },
    /// The database has a log beside it that cannot be read, since nothing can be made in the folder.
    #[error(
        "the database {} has the log station.db-wal beside it, which cannot be read where nothing may be written; copy the \
         folder, and name the copy",
        path.display()
    )]
    ReadOnlyLog {
        /// The file.
        path: PathBuf,
    },
    /// The database was begun at a first start that did not end.
    #[error(
        "the database {} was begun and never finished, as when the disk is full at the first start, and has no results; \
         make room, and start the station once",
        path.display()
    )]
    Unfinished {
        /// The file.
        path: PathBuf,
    },
    /// The disk has no room to bring the database up to date.
    #[error(
        "the database {} cannot be brought up to date: its disk lacks {megabytes} MB for a copy of it as it is; \
         make room there, or go on with the earlier program",
        path.display()
    )]
    NoRoom {
        /// The file.
        path: PathBuf,
        /// How many are missing.
        megabytes: u64,
    },
    /// The plant's database refused an operation.
    #[error(
        "the plant {plant} refuses {doing}; check that it is there and lets this station in, and ask whoever keeps \
         it"
    )]
    Plant {
        /// Its address, without the password.
        plant: String,
        /// What was under way.
        doing: &'static str,
        /// Why.
        source: DatabaseError,
    },
    /// It is not known to be the plant.
    #[error(transparent)]
    Certificate(#[from] CertificateError),
    /// The plant lacks a record, or has another text under the record's hash.
    #[error(
        "the plant {plant} does not have the record {sha256}, or not as it was sent; the station that sent it has it"
    )]
    NoRecord {
        /// Its address.
        plant: String,
        /// The hash of the record.
        sha256: String,
    },
    /// The file system cannot keep the log that SQLite needs.
    #[error(
        "the database {} cannot have a write-ahead log where it is ({mode}); put the folder on a local disk",
        path.display()
    )]
    NoLog {
        /// The file.
        path: PathBuf,
        /// The journal that it has instead.
        mode: String,
    },
    /// The database was made by a newer version of the program.
    #[error(
        "the database {} has version {found} and this program knows {known}; use the halfrow-station that made it",
        path.display()
    )]
    Newer {
        /// The file.
        path: PathBuf,
        /// Its version.
        found: i64,
        /// The newest that is known.
        known: i64,
    },
    /// The database was made by an older version of the program, and a command that only looks does not change it.
    #[error(
        "the database {} has version {found} and this program reads {known}; start the station on it once, which \
         brings it up to date and keeps a copy, or a plant's by `halfrow-station plant prepare`",
        path.display()
    )]
    Older {
        /// The file.
        path: PathBuf,
        /// Its version.
        found: i64,
        /// The one that is read.
        known: i64,
    },
    /// The database has a version of this program's, but was made by another schema of that version.
    #[error("version {version} of the database {} is not this program's; restore it from a copy", path.display())]
    OtherSchema {
        /// The file.
        path: PathBuf,
        /// The version.
        version: i64,
    },
    /// The station's clock and the plant's show different times.
    #[error(
        "the station's clock and the plant's are {minutes} min apart, and the plant uses them to tell which \
         judgement of a unit is the last one; set the one that is wrong"
    )]
    ClockApart {
        /// How far.
        minutes: u64,
    },
    /// A run that was kept here began later than this moment.
    #[error(
        "the last run here is dated {minutes} min ahead of the station's clock, and the plant would take each run from now on for \
         as late; set the clock if it is slow, or else give the station a new folder once all is sent (docs/plant.md)"
    )]
    DatedAhead {
        /// How far.
        minutes: u64,
    },
    /// The unit is in a lane already, or the lane has a unit.
    #[error("{serial} is being judged in lane {lane}; wait until that run is over")]
    BeingJudged {
        /// The serial number of the run that is open.
        serial: String,
        /// Its lane.
        lane: String,
    },
    /// The run is no longer open, or belongs to another program.
    #[error("the run {run} is no longer this program's to finish; its lane was taken over")]
    NotOpen {
        /// The run.
        run: String,
    },
    /// A lane's process that outlived its station is of a run that the database does not have, as where an earlier copy of it was put
    /// back: nobody knows which board it may still have.
    #[error(
        "{} is of a run that station.db does not have, and its lane may still have a board; end the process {process}, or \
         restart the computer, and start again",
        spool.display()
    )]
    UnknownProcess {
        /// What the run has written.
        spool: PathBuf,
        /// The id of the process.
        process: u32,
    },
    /// The run read back otherwise than it was written.
    #[error("the run {run} reads back otherwise than it was written; check the disk")]
    ReadsOtherwise {
        /// The run.
        run: String,
    },
    /// The evidence.
    #[error(transparent)]
    Blob(#[from] BlobError),
    /// The record.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// An id cannot be made.
    #[error(transparent)]
    NoRandomness(#[from] NoRandomness),
}

impl StoreError {
    /// The error of the database in the file `path`, which refused `doing`.
    pub(super) fn of_file(path: &Path, doing: &'static str, source: impl Into<DatabaseError>) -> Self {
        let (path, source) = (path.to_owned(), source.into());
        if source.is_damage() {
            Self::Damaged { path, source }
        } else if source.is_lock() {
            Self::Locked { path, doing, source }
        } else {
            Self::Database { path, doing, source }
        }
    }

    /// The error of an engine at `place`, a file or an address, which refused `doing`.
    pub(super) fn refused(engine: Engine, place: &Path, doing: &'static str, source: DatabaseError) -> Self {
        match engine {
            Engine::Sqlite => Self::of_file(place, doing, source),
            Engine::Postgres => Self::Plant { plant: place.display().to_string(), doing, source },
        }
    }

    /// Whether the plant is unavailable for now, as opposed to refusing this one thing.
    #[must_use]
    pub fn is_away(&self) -> bool {
        match self {
            Self::Plant { source, .. } => source.is_away(),
            Self::Certificate(_) => true,
            _ => false,
        }
    }

    /// Whether whoever waits for the plant goes on waiting: it is away, or its server refuses what it may take later, as while it
    /// is read-only or its passwords are being changed.
    #[must_use]
    pub(crate) const fn may_pass(&self) -> bool {
        matches!(self, Self::Plant { .. } | Self::Certificate(_))
    }

    /// Whether this one record cannot be read, and the rest of the store may be well.
    #[must_use]
    pub(crate) const fn is_of_record(&self) -> bool {
        matches!(self, Self::Blob(_) | Self::Record(_) | Self::NoRecord { .. })
    }

    /// Whether the plant can never store what it was given.
    #[must_use]
    pub(super) fn is_of_content(&self) -> bool {
        matches!(self, Self::Plant { source, .. } if source.is_of_content())
    }
}
