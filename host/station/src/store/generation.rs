//! Which `station.db` a write-ahead log belongs to.
//!
//! SQLite does not know: it plays the pages of any log into whatever database lies beside it. So the database has a number in its
//! header (`user_version`), which is noted in `station.lock`, too. It gets a new one whenever the log is folded into it. In
//! between its file does not change: a copy with the noted number is identical to the file to which the log belongs, and any
//! other copy has no number, or an earlier one.

use std::fs::{self, File, Metadata};
use std::io::{self, Read as _};
use std::os::unix::fs::{FileExt as _, MetadataExt as _, OpenOptionsExt as _};
use std::path::Path;

use nix::fcntl::OFlag;
use parking_lot::Mutex;
use rusqlite::{Connection, ffi};

use super::folder::log_of;
use super::{Database, DatabaseError, Folder, StoreError};
use crate::ids;

/// The offset of the number in the file, big-endian (SQLite, "Database File Format", section 1.3).
const PLACE: u64 = 60;
/// The bytes of a log that has only a header and no pages (section 4.1 there).
const EMPTY_LOG: u64 = 32;

/// Changes after which the log is folded. A run makes two, of some fifteen pages each, so this is sooner than SQLite's own limit
/// of a thousand pages, which [`Folder::writer`] switches off.
const CHANGES: u32 = 32;

/// The numbers that the database of the log may have, the newest last.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Generations(Vec<u32>);

impl Generations {
    /// Gives the database the newest of them.
    fn give(&self, writer: &mut dyn Database) -> Result<(), DatabaseError> {
        let newest = self.0.last().copied().unwrap_or_default();
        writer.batch(&format!("PRAGMA user_version = {newest}"))
    }
}

/// A file, by its device and its inode.
type FileId = (u64, u64);

/// The databases that this process writes to.
static WRITTEN: Mutex<Vec<FileId>> = Mutex::new(Vec::new());

fn id(file: io::Result<Metadata>) -> Option<FileId> {
    file.map(|file| (file.dev(), file.ino())).ok()
}

/// Whether `file` is the one that has the name `path`.
pub(super) fn is_named(file: &File, path: &Path) -> bool {
    let own = id(file.metadata());
    own.is_some() && own == id(fs::metadata(path))
}

/// The database that a start opened. It stays open as long as a connection writes to it: to close the file would also release the
/// locks that SQLite has on it (fcntl(2)).
#[derive(Debug)]
pub(super) struct Opened {
    file: File,
    known: Generations,
    /// How many changes were made since the log was folded.
    changes: u32,
}

impl Opened {
    fn new(file: File, known: Generations) -> Self {
        WRITTEN.lock().extend(id(file.metadata()));
        Self { file, known, changes: 0 }
    }

    /// Whether it is still the file of its name, and no other database was written over it.
    pub(super) fn is_there(&self, folder: &Folder) -> bool {
        is_named(&self.file, &folder.database()) && self.is_unspoilt()
    }

    /// Whether no other database was written over it, which its log would spoil.
    pub(super) fn is_unspoilt(&self) -> bool {
        matches!(number(&self.file), Ok(Some(found)) if self.known.0.contains(&found))
    }

    /// Counts a change, and folds the log when that is due.
    pub(super) fn changed(
        &mut self,
        folder: &Folder,
        lock: &File,
        writer: &mut dyn Database,
    ) -> Result<(), StoreError> {
        self.changes += 1;
        if self.changes < CHANGES {
            self.settle(folder, lock, writer)
        } else {
            self.fold(folder, lock, writer)
        }
    }

    /// Folds the log into the database, which gets a new number. What a reader still needs stays in the log meanwhile.
    pub(super) fn fold(
        &mut self,
        folder: &Folder,
        lock: &File,
        writer: &mut dyn Database,
    ) -> Result<(), StoreError> {
        if let [known] = self.known.0[..] {
            let both = Generations(vec![known, chosen()?]);
            note(folder, lock, &both)?;
            both.give(writer).map_err(|source| refused(folder, source))?;
            // Only now that the database has the new number: with two known, the log is folded.
            self.known = both;
        }
        self.settle(folder, lock, writer)
    }

    /// Drops all numbers but the last, as soon as that is in the file itself: a copy may have an earlier one.
    fn settle(&mut self, folder: &Folder, lock: &File, writer: &mut dyn Database) -> Result<(), StoreError> {
        let [_, .., last] = self.known.0[..] else { return Ok(()) };
        let folded = writer.one("PRAGMA wal_checkpoint(PASSIVE)", &[], |row| {
            let [busy, pages, folded] = [row.get::<i64>(0)?, row.get(1)?, row.get(2)?];
            Ok(busy == 0 && pages == folded)
        });
        // A reader of an earlier state keeps later pages in the log.
        if folded.map_err(|source| refused(folder, source))? {
            let last = Generations(vec![last]);
            note(folder, lock, &last)?;
            self.known = last;
            self.changes = 0;
        }
        Ok(())
    }
}

impl Drop for Opened {
    fn drop(&mut self) {
        let own = id(self.file.metadata());
        let mut written = WRITTEN.lock();
        if let Some(place) = written.iter().position(|one| Some(*one) == own) {
            written.swap_remove(place);
        }
    }
}

fn refused(folder: &Folder, source: DatabaseError) -> StoreError {
    StoreError::of_file(&folder.database(), "a new number, by which it is told from its copies", source)
}

/// What is known of the log beside a database.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Log {
    /// There is none.
    None,
    /// It belongs to this database.
    Own,
    /// It was left by a program that had not noted, or not finally, which database it belongs to.
    Unknown,
}

/// Whether a log with pages was left in `folder`.
pub(super) fn has_left_log(folder: &Folder) -> bool {
    fs::metadata(log_of(&folder.database())).is_ok_and(|log| log.len() > EMPTY_LOG)
}

/// Examines the log that was left in `folder`, in which nobody works, before a connection plays it into the database.
pub(super) fn of_left_log(folder: &Folder) -> Result<(Log, Generations), StoreError> {
    let refused = |source| folder.refused(source);
    folder.refuse_pipe()?;
    let path = folder.database();
    let found = header(&path).map_err(refused)?;
    if !has_left_log(folder) {
        // A database that does not exist yet will have 0.
        return Ok((Log::None, Generations(vec![found.unwrap_or_default()])));
    }
    let Some(found) = found else { return Err(folder.no_database("it is too short for one")) };
    let mut noted = noted(folder);
    if noted.0.is_empty() {
        return Ok((Log::Unknown, Generations(vec![found])));
    }
    if !noted.0.contains(&found) {
        return Err(StoreError::OtherLog { path });
    }
    // With several noted, a start had not settled on one yet, and a copy may have any of them.
    let log = if noted.0.len() > 1 { Log::Unknown } else { Log::Own };
    noted.0.retain(|one| *one != found);
    noted.0.push(found);
    Ok((log, noted))
}

/// Refuses a log that belongs to another database; a station may start meanwhile. A database that this process writes to is not
/// examined: its log is known, and to open and close the file would release the locks that SQLite has on it.
pub(super) fn refuse_other_log(folder: &Folder) -> Result<(), StoreError> {
    if id(fs::metadata(folder.database())).is_some_and(|id| WRITTEN.lock().contains(&id)) {
        return Ok(());
    }
    loop {
        let before = noted(folder);
        match of_left_log(folder) {
            // A start has given the database another number meanwhile; it notes that first.
            Err(StoreError::OtherLog { .. }) if noted(folder) != before => {}
            looked => return looked.map(drop),
        }
    }
}

/// The number in the file of this database itself, whatever its log says; none if there is no database.
fn header(database: &Path) -> io::Result<Option<u32>> {
    match File::open(database) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        file => number(&file?),
    }
}

/// The number in this file; none if the file is too short for it.
fn number(file: &File) -> io::Result<Option<u32>> {
    let mut bytes = [0; 4];
    match file.read_exact_at(&mut bytes, PLACE) {
        Ok(()) => Ok(Some(u32::from_be_bytes(bytes))),
        Err(error) if matches!(error.kind(), io::ErrorKind::UnexpectedEof | io::ErrorKind::IsADirectory) => {
            Ok(None)
        }
        Err(error) => Err(error),
    }
}

/// The numbers that were noted last. Only the first line counts, because the end of a longer one may remain after it.
fn noted(folder: &Folder) -> Generations {
    let mut text = String::new();
    // Of a pipe in its place nobody waits for the other end.
    let file = File::options().read(true).custom_flags(OFlag::O_NONBLOCK.bits()).open(folder.lock_file());
    if file.is_ok_and(|mut file| file.read_to_string(&mut text).is_err()) {
        text.clear();
    }
    let words = text.lines().next().unwrap_or_default().split(' ').filter(|word| word.len() == 8);
    Generations(words.filter_map(|word| u32::from_str_radix(word, 16).ok()).collect())
}

/// Notes the numbers in the lock file.
fn note(folder: &Folder, lock: &File, Generations(all): &Generations) -> Result<(), StoreError> {
    let words: Vec<_> = all.iter().map(|one| format!("{one:08x}")).collect();
    let line = words.join(" ") + "\n";
    let written = lock.write_all_at(line.as_bytes(), 0).and_then(|()| lock.set_len(line.len() as u64));
    written.and_then(|()| lock.sync_all()).map_err(|source| folder.refused(source))
}

/// A number that no copy has: the random end of an id, but positive, since `user_version` is signed, and not 0, which copies
/// have.
fn chosen() -> Result<u32, StoreError> {
    Ok((ids::new(0)?.as_u128() as u32 >> 1) | 1)
}

/// Chooses the number that this start gives the database, and appends it to `known`. Where the database was put back, it is noted
/// before there is a log.
pub(super) fn choose(
    folder: &Folder,
    lock: &File,
    log: Log,
    mut known: Generations,
) -> Result<Generations, StoreError> {
    let before = noted(folder);
    let is_noted = log == Log::Unknown || before == known;
    known.0.push(chosen()?);
    if !is_noted {
        if !before.0.is_empty() && !known.0.iter().any(|one| before.0.contains(one)) {
            tracing::warn!(
                "station.db was put back, or is another one than that of the last start; `halfrow-station check` says what it lacks"
            );
        }
        note(folder, lock, &known)?;
    }
    Ok(known)
}

/// Gives the database the last number of `known`, which none of its copies has. Until that is in the file itself, the earlier
/// ones count as well, so that a start that is killed halfway does not block the next one.
pub(super) fn begin(
    folder: &Folder,
    lock: &File,
    writer: &mut dyn Database,
    known: Generations,
) -> Result<Opened, StoreError> {
    let before = noted(folder);
    note(folder, lock, &known)?;
    if let Err(source) = known.give(writer) {
        // Without room not even the log has the number. After any other error it may, though SQLite does not count it.
        if source.is_full() {
            note(folder, lock, &before)?;
        }
        return Err(refused(folder, source));
    }
    let file = File::open(folder.database()).map_err(|source| folder.refused(source))?;
    let mut opened = Opened::new(file, known);
    opened.settle(folder, lock, writer)?;
    if opened.is_there(folder) { Ok(opened) } else { Err(StoreError::Replaced { path: folder.database() }) }
}

/// Refuses a database in which SQLite finds anything wrong.
pub(super) fn refuse_damaged(folder: &Folder, database: &mut dyn Database) -> Result<(), StoreError> {
    let found = database.one("PRAGMA integrity_check(1)", &[], |row| row.get::<String>(0));
    let damage = match found {
        Ok(said) if said == "ok" => return Ok(()),
        Ok(said) => rusqlite::Error::SqliteFailure(ffi::Error::new(ffi::SQLITE_CORRUPT), Some(said)).into(),
        Err(error) => error,
    };
    Err(StoreError::of_file(&folder.database(), "to be checked", damage))
}

/// Removes the number from the copy of a database in the file `path`.
pub(super) fn remove(path: &Path) -> Result<(), StoreError> {
    let refused = |source: rusqlite::Error| StoreError::of_file(path, "to be told from its original", source);
    let copy = Connection::open(path).map_err(refused)?;
    copy.execute_batch("PRAGMA user_version = 0").map_err(refused)
}
