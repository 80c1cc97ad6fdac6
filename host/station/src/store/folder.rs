//! The folder of a station, and what is in it.

use std::fs::{self, DirBuilder, File, TryLockError};
use std::io;
use std::os::unix::ffi::OsStrExt as _;
use std::os::unix::fs::{DirBuilderExt as _, OpenOptionsExt as _};
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

use halfrow::files::check_regular;
use nix::errno::Errno;
use nix::fcntl::OFlag;
use nix::unistd::{AccessFlags, access};
use rusqlite::config::DbConfig;
use rusqlite::{Connection, ErrorCode, OpenFlags, ffi};

use super::database::Sqlite;
use super::{Database, DatabaseError, PATIENCE, StoreError, Stored, generation};
use crate::record::Blobs;

/// How long to wait for a program that is just ending to leave the folder, and the time between two tries.
const LEAVES: Duration = Duration::from_secs(1);
const AGAIN: Duration = Duration::from_millis(20);

/// The name of an unfinished copy, within the folder where the copy is to be.
pub(crate) const ASIDE: &str = ".partial";
/// The name of the file that is locked by the program that writes.
pub(crate) const LOCK: &str = "station.lock";

/// Makes the folder `path`, of a station or in one, and those above it, where they do not exist. Whatever the umask, nobody else may
/// put another database, key or plan there.
pub(crate) fn make_folder(path: &Path) -> io::Result<()> {
    DirBuilder::new().recursive(true).mode(0o750).create(path)
}

/// The folder of a station.
#[derive(Clone, Debug)]
pub struct Folder(pub(super) PathBuf);

impl Folder {
    /// The station's folder `path`, whether it exists or not.
    #[must_use]
    pub fn new(path: &Path) -> Self {
        Self(path.to_owned())
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// The database.
    #[must_use]
    pub fn database(&self) -> PathBuf {
        self.0.join("station.db")
    }

    /// Makes it, where it does not exist.
    pub(crate) fn make(&self) -> Result<(), StoreError> {
        make_folder(&self.0).map_err(|source| self.refused(source))
    }

    /// Refuses a folder whose path is not UTF-8.
    pub(crate) fn refuse_path(&self) -> Result<(), StoreError> {
        if self.0.to_str().is_none() { Err(StoreError::Path { folder: self.0.clone() }) } else { Ok(()) }
    }

    /// Refuses a `station.db` that is a pipe or a device, whose other end SQLite would wait for.
    pub(super) fn refuse_pipe(&self) -> Result<(), StoreError> {
        check_regular(&self.database()).map_err(|_| self.no_database("it is a pipe or a device"))
    }

    /// Refuses a folder without a database, which no station has ever written to.
    pub(super) fn refuse_no_results(&self) -> Result<(), StoreError> {
        self.refuse_lost_database()?;
        let is_there = self.database().try_exists().unwrap_or(true);
        if is_there { Ok(()) } else { Err(StoreError::NoResults { folder: self.0.clone() }) }
    }

    /// Refuses the `database` of another program. A station's has a table of its version from the very start.
    pub(super) fn refuse_foreign_tables(&self, database: &mut dyn Database) -> Result<(), StoreError> {
        let version = "SELECT count(*) FROM sqlite_schema WHERE name = 'schema_version'";
        let counted =
            tables(database).and_then(|all| Ok((all, database.one(version, &[], |row| row.get::<i64>(0))?)));
        match counted {
            Ok((1.., 0)) => Err(self.no_database("its tables are not a station's")),
            counted => counted
                .map(drop)
                .map_err(|source| StoreError::of_file(&self.database(), "to be read", source)),
        }
    }

    /// What is in the database's place is something else.
    pub(super) fn no_database(&self, why: &str) -> StoreError {
        let code = ffi::Error::new(ffi::SQLITE_NOTADB);
        let source = rusqlite::Error::SqliteFailure(code, Some(why.to_owned()));
        StoreError::of_file(&self.database(), "to be read", source)
    }

    /// Refuses a folder in which a restore is at work, or was when its program was killed: what begins there would be in its way.
    pub(super) fn refuse_unfinished_restore(&self) -> Result<(), StoreError> {
        let is_unfinished = self.0.join(ASIDE).exists() && !self.database().exists();
        if is_unfinished { Err(StoreError::Unrestored { folder: self.0.clone() }) } else { Ok(()) }
    }

    /// Refuses a folder that was moved away since the start, or whose disk was unmounted: the start made `blobs` in it.
    pub(crate) fn refuse_gone(&self) -> Result<(), StoreError> {
        fs::metadata(self.evidence()).map(drop).map_err(|source| self.refused(source))
    }

    /// Refuses a folder that has evidence, or a log, and no database or an empty file: no station may start from scratch there,
    /// and SQLite would remove the log.
    pub(super) fn refuse_lost_database(&self) -> Result<(), StoreError> {
        let is_gone = fs::metadata(self.database()).map_or(true, |about| about.is_file() && about.len() == 0);
        self.refuse_lost(is_gone, generation::has_left_log(self))
    }

    /// The same for a `database` without any table, as where it was copied without its write-ahead log.
    pub(super) fn refuse_lost_tables(&self, database: &mut dyn Database) -> Result<(), StoreError> {
        let tables =
            tables(database).map_err(|source| StoreError::of_file(&self.database(), "to be read", source))?;
        // The log may be of a first start that did not end.
        self.refuse_lost(tables == 0, false)
    }

    fn refuse_lost(&self, is_empty: bool, has_log: bool) -> Result<(), StoreError> {
        let is_lost = is_empty && (has_log || self.blobs().has_any());
        if is_lost { Err(StoreError::DatabaseGone { folder: self.0.clone() }) } else { Ok(()) }
    }

    /// The evidence.
    #[must_use]
    pub fn blobs(&self) -> Blobs {
        Blobs::new(self.evidence())
    }

    /// The folder of all evidence.
    pub(crate) fn evidence(&self) -> PathBuf {
        self.0.join("blobs")
    }

    /// The folder of what the run of this id writes down while it is under way.
    #[must_use]
    pub fn spool(&self, run: &str) -> PathBuf {
        self.spools().join(run)
    }

    /// The folder of the spools of all runs that are under way.
    #[must_use]
    pub fn spools(&self) -> PathBuf {
        self.0.join("spool")
    }

    pub(crate) fn refused(&self, source: io::Error) -> StoreError {
        // Only then, because it asks the disk, which may be failing, about each folder of evidence.
        if source.kind() == io::ErrorKind::PermissionDenied
            && let Err(others) = self.refuse_other_users()
        {
            return others;
        }
        StoreError::Folder { folder: self.0.clone(), source }
    }

    /// The file that is locked by the program that writes.
    pub(crate) fn lock_file(&self) -> PathBuf {
        self.0.join(LOCK)
    }

    /// The right to write to the folder, which must exist. It lasts as long as the file is open.
    ///
    /// # Errors
    /// [`StoreError`] when another program has it.
    pub(crate) fn lock(&self) -> Result<File, StoreError> {
        let until = Instant::now() + LEAVES;
        let mut file = self.opened_to_lock()?;
        loop {
            match file.try_lock() {
                Ok(()) if generation::is_named(&file, &self.lock_file()) => return Ok(file),
                // A restore that failed removes the one that it made: its lock keeps nobody out any more.
                Ok(()) if Instant::now() < until => file = self.opened_to_lock()?,
                Err(TryLockError::WouldBlock) if Instant::now() < until => thread::sleep(AGAIN),
                Ok(()) | Err(TryLockError::WouldBlock) => {
                    return Err(StoreError::InUse { folder: self.0.clone() });
                }
                Err(TryLockError::Error(source)) => return Err(self.refused(source)),
            }
        }
    }

    fn opened_to_lock(&self) -> Result<File, StoreError> {
        // What a link leads to would be overwritten, and the other end of a pipe waited for.
        let flags = (OFlag::O_NOFOLLOW | OFlag::O_NONBLOCK).bits();
        let path = self.lock_file();
        let file = File::options().create(true).truncate(false).write(true).custom_flags(flags).open(&path);
        let is_other = fs::symlink_metadata(&path).is_ok_and(|about| !about.is_file());
        let other =
            || io::Error::new(io::ErrorKind::InvalidInput, "station.lock there is a link or no regular file");
        let file = if is_other { Err(other()) } else { file };
        file.map_err(|source| self.refused(source))
    }

    /// The connection that writes. It does not fold the log into the database by itself, nor when it closes unless told to.
    pub(super) fn writer(&self) -> Result<Box<dyn Database>, StoreError> {
        let path = self.database();
        let place = &path;
        let refused = |doing| move |source| StoreError::of_file(place, doing, source);
        let opened = self.opened_to_write().map_err(DatabaseError::from).map_err(refused("to be opened"))?;
        let mut writer: Box<dyn Database> = Box::new(Sqlite::new(opened));
        // Before the first change: a log is one.
        self.refuse_foreign_tables(&mut *writer)?;
        let mode: String = writer
            .one("PRAGMA journal_mode = WAL", &[], |row| row.get(0))
            .map_err(refused("a write-ahead log"))?;
        if mode != "wal" {
            return Err(StoreError::NoLog { path, mode });
        }
        // A commit that returned is on the disk. With less, a power cut could undo what was shown.
        writer.batch("PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON").map_err(refused("to be safe"))?;
        Ok(writer)
    }

    fn opened_to_write(&self) -> Result<Connection, rusqlite::Error> {
        let writer = Connection::open(self.database())?;
        writer.busy_timeout(PATIENCE)?;
        writer.set_db_config(DbConfig::SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, true)?;
        writer.execute_batch("PRAGMA wal_autocheckpoint = 0")?;
        Ok(writer)
    }

    /// A connection that cannot write.
    pub(super) fn reader(&self) -> Result<Box<dyn Database>, StoreError> {
        self.refuse_pipe()?;
        let path = self.database();
        let opened = self.opened_to_read().map_err(|source| match self.refuse_gone() {
            Err(gone) if !path.exists() => gone,
            _ => StoreError::of_file(&path, "to be read", source),
        });
        let reader = opened?;
        if self.may_only_be_read() {
            let first = reader.query_row("PRAGMA schema_version", [], |_| Ok(()));
            let code = first.err().and_then(|error| error.sqlite_error_code());
            if matches!(code, Some(ErrorCode::CannotOpen | ErrorCode::ReadOnly)) {
                return Err(StoreError::ReadOnlyLog { path });
            }
        }
        Ok(Box::new(Sqlite::new(reader)))
    }

    /// What `read` finds by a connection of its own.
    pub(super) fn read<T>(
        &self,
        doing: &'static str,
        read: impl FnOnce(&mut dyn Database) -> Result<T, DatabaseError>,
    ) -> Result<T, StoreError> {
        let path = self.database();
        read(&mut *self.reader()?).map_err(|source| StoreError::of_file(&path, doing, source))
    }

    /// The verdict of a run, as a connection of its own reads it; none if the run is open or not there.
    ///
    /// # Errors
    /// [`StoreError`] when the database cannot be read.
    pub fn verdict_of(&self, run: &str) -> Result<Option<Stored>, StoreError> {
        self.read("to tell a verdict", |from| Stored::of_run(from, run))
    }

    /// Opens the database to read it. If it has no log, SQLite makes one, unless it is told that nothing changes the file. Where
    /// no log can be made, that is so unless another user's station starts meanwhile.
    fn opened_to_read(&self) -> Result<Connection, rusqlite::Error> {
        let (path, flags) = (self.database(), OpenFlags::SQLITE_OPEN_READ_ONLY);
        let has_log = log_of(&path).try_exists().unwrap_or(true);
        let reader = if !has_log && self.may_only_be_read() {
            Connection::open_with_flags(unchanging(&path), flags | OpenFlags::SQLITE_OPEN_URI)?
        } else {
            Connection::open_with_flags(&path, flags)?
        };
        reader.busy_timeout(PATIENCE)?;
        Ok(reader)
    }

    /// Whether nothing can be made in the folder, because it is another user's, or its disk was mounted to be read only.
    fn may_only_be_read(&self) -> bool {
        matches!(access(&self.0, AccessFlags::W_OK), Err(Errno::EACCES | Errno::EROFS))
    }
}

/// The write-ahead log of the file `database`.
pub(super) fn log_of(database: &Path) -> PathBuf {
    database.with_extension("db-wal")
}

/// How many tables and indices the database has.
pub(super) fn tables(database: &mut dyn Database) -> Result<i64, DatabaseError> {
    database.one("SELECT count(*) FROM sqlite_schema", &[], |row| row.get(0))
}

/// What SQLite calls a file that nothing changes (<https://www.sqlite.org/uri.html>).
fn unchanging(path: &Path) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"/-_.".contains(&byte);
    let letter = |&byte: &u8| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") };
    let named: String = path.as_os_str().as_bytes().iter().map(letter).collect();
    let host = if path.is_absolute() { "//" } else { "" };
    format!("file:{host}{named}?immutable=1")
}
