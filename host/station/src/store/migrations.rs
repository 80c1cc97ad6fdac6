//! Brings a database to the version that this program knows, on either engine.

use std::fs::{self, File};
use std::io::{self, Read as _};
use std::iter;
use std::os::unix::fs::OpenOptionsExt as _;
use std::path::{Path, PathBuf};

use halfrow::result::sha256;

use super::database::{Database, DatabaseError, Engine, values};
use super::folder::log_of;
use super::statements::{PLAN_TEXTS, SCHEMA_VERSION, SCHEMAS, UNCOUNT_UNIT};
use super::{StoreError, generation};
use crate::disk::Room;
use crate::plan::Production;
use crate::record::synced;

/// The newest version that a database has.
pub(super) const NEWEST: &str = "SELECT max(n) FROM schema_version";
/// Notes that the database has another version.
const NOTE: &str = "INSERT INTO schema_version (n, sha256, applied_ms) VALUES ($1, $2, $3)";

/// The schema that counts anew without the units that check shifts. Which ones these are is in the texts of the plans.
const WITHOUT_REFERENCES: i64 = 8;

/// How many bytes of two copies are compared at a time: a database may have gigabytes.
const BLOCK: usize = 64 << 10;

/// Applies all schemas that `database`, which is at `path`, does not have yet, in one transaction: whatever happens, it has the
/// version that was found, or the newest. Before a database that holds results is changed, it is copied: to a file beside it, or
/// to a schema `before_N`, or `before_N_2` and so on where that name is taken.
pub(super) fn apply(database: &mut dyn Database, path: &Path, now_ms: i64) -> Result<(), StoreError> {
    let engine = database.engine();
    let refused = |source| StoreError::refused(engine, path, "a new version", source);
    database.batch(&engine.words(SCHEMA_VERSION)).map_err(refused)?;
    let found = newest(database).map_err(refused)?;
    refuse_newer(path, found)?;
    let (had, new): (Vec<_>, Vec<_>) = (1_i64..).zip(SCHEMAS).partition(|(version, _)| *version <= found);
    for (version, schema) in had {
        check(database, path, version, &sha256([schema]))?;
    }
    let Some((next, _)) = new.first() else { return Ok(()) };
    let mut kept = String::new();
    if found > 0 {
        tracing::warn!("{} is upgraded, which takes a while if it is large", name(engine, path));
    }
    if found > 0 && engine == Engine::Sqlite {
        refuse_full_disk(path)?;
        kept = name(engine, &copy(database, path, *next)?);
    }
    let change = |to: &mut dyn Database| {
        if found > 0 && engine == Engine::Postgres {
            kept = format!("the schema {}", copy_tables(to, *next)?);
            // A program that has read the version in its transaction relies on it until that is over.
            to.batch("LOCK TABLE schema_version")?;
        }
        new.iter().try_for_each(|(version, schema)| {
            if *version == WITHOUT_REFERENCES {
                uncount_references(to)?;
            }
            to.batch(&engine.words(schema))?;
            to.execute(NOTE, values![*version, &sha256([schema]), now_ms]).map(drop)
        })
    };
    database.transaction(change).map_err(refused)?;
    if found > 0 {
        let (database, newest) = (name(engine, path), SCHEMAS.len());
        tracing::warn!("{database} has version {newest}; as it was, with version {found}, it is in {kept}");
    }
    Ok(())
}

/// What a database is called. Its folder may have another name soon, if it is restored.
fn name(engine: Engine, path: &Path) -> String {
    let shown = path.file_name().filter(|_| engine == Engine::Sqlite).map_or(path, Path::new);
    shown.display().to_string()
}

/// Gives the number 0 to every run of a unit that checks shifts by its plan.
fn uncount_references(to: &mut dyn Database) -> Result<(), DatabaseError> {
    let plans = to.all(PLAN_TEXTS, &[], |row| {
        Ok((row.get::<String>(0)?, row.get::<String>(1)?, row.get::<String>(2)?))
    })?;
    for (plan, product, text) in plans {
        // Where a plan cannot be read, `check` takes nothing for such a unit either.
        let Some(production) = Production::of_text(&text) else { continue };
        for serial in production.references() {
            to.execute(UNCOUNT_UNIT, values![&plan, &product, serial])?;
        }
    }
    Ok(())
}

/// The version of a database; 0 if it has none.
pub(super) fn newest(database: &mut dyn Database) -> Result<i64, DatabaseError> {
    Ok(database.one(NEWEST, &[], |row| row.get::<Option<i64>>(0))?.unwrap_or(0))
}

/// Refuses the database in the file `path` if its version, `found`, is not this program's.
pub(super) fn refuse_unknown_version(path: &Path, found: i64) -> Result<(), StoreError> {
    refuse_newer(path, found)?;
    let known = SCHEMAS.len() as i64;
    if found < known {
        return Err(StoreError::Older { path: path.to_owned(), found, known });
    }
    Ok(())
}

fn refuse_newer(path: &Path, found: i64) -> Result<(), StoreError> {
    let known = SCHEMAS.len() as i64;
    if found > known {
        return Err(StoreError::Newer { path: path.to_owned(), found, known });
    }
    Ok(())
}

/// Refuses when the disk has no room for a copy of the database in the file `path`. A change that runs out of room is rolled
/// back.
fn refuse_full_disk(path: &Path) -> Result<(), StoreError> {
    let folder = path.parent().unwrap_or(path);
    let refused = |source| StoreError::Folder { folder: folder.to_owned(), source };
    // Some file systems do not report it.
    let room = Room::of(folder).map_err(refused)?;
    let free = (room.size() > 0).then_some(room.free);
    // Where there is no log, it has no bytes.
    let log = fs::metadata(log_of(path)).map_or(0, |log| log.len());
    let bytes = fs::metadata(path).map_err(refused)?.len() + log;
    match missing(bytes, free) {
        0 => Ok(()),
        megabytes => Err(StoreError::NoRoom { path: path.to_owned(), megabytes }),
    }
}

/// How many megabytes are missing for a copy of `bytes` bytes where `free` bytes are free; 0 if that is not known.
fn missing(bytes: u64, free: Option<u64>) -> u64 {
    free.map_or(0, |free| bytes.saturating_sub(free).div_ceil(1_000_000))
}

/// Copies `database`, the file `path`, to a file beside it, completely or not at all, and returns that file's path.
fn copy(database: &mut dyn Database, path: &Path, version: i64) -> Result<PathBuf, StoreError> {
    let aside = path.with_extension(format!("before-{version}.partial"));
    let folder = path.parent().unwrap_or(path);
    let refused = |source| StoreError::Folder { folder: folder.to_owned(), source };
    let unfinished = [path.with_extension(format!("before-{version}.partial-journal")), aside.clone()];
    unfinished.iter().try_for_each(|left| remove(left)).map_err(refused)?;
    let copied = for_the_same(path, &aside).map_err(refused).and_then(|()| {
        let copied = database.execute("VACUUM INTO $1", values![&*aside.to_string_lossy()]);
        copied.map_err(|source| StoreError::of_file(path, "a copy before a new version", source))
    });
    let named = copied.and_then(|_| {
        generation::remove(&aside)?;
        File::open(&aside).and_then(|file| file.sync_all()).map_err(refused)?;
        let whole = free_name(path, version, &aside).map_err(refused)?;
        fs::rename(&aside, &whole).map_err(refused)?;
        Ok(whole)
    });
    if named.is_err() {
        // If this fails, the next attempt removes them first.
        for left in &unfinished {
            let _ = remove(left);
        }
    }
    let whole = named?;
    synced(folder)?;
    Ok(whole)
}

/// Makes the empty file `aside`, which whoever may read the file `path` may read, and nobody else, whatever the umask.
fn for_the_same(path: &Path, aside: &Path) -> io::Result<()> {
    let file = File::options().write(true).create_new(true).mode(0o600).open(aside)?;
    file.set_permissions(fs::metadata(path)?.permissions())
}

/// The name for the copy in `aside`. It is not that of a different copy, which may be all that is left of an earlier state.
fn free_name(path: &Path, version: i64, aside: &Path) -> io::Result<PathBuf> {
    let mut whole = path.with_extension(format!("before-{version}.db"));
    let mut number = 2;
    while whole.exists() && !hold_the_same(aside, &whole)? {
        whole = path.with_extension(format!("before-{version}.{number}.db"));
        number += 1;
    }
    Ok(whole)
}

fn hold_the_same(one: &Path, other: &Path) -> io::Result<bool> {
    let [mut one, mut other] = [File::open(one)?, File::open(other)?];
    let mut left = one.metadata()?.len();
    if left != other.metadata()?.len() {
        return Ok(false);
    }
    let [mut of_one, mut of_other] = [vec![0; BLOCK], vec![0; BLOCK]];
    while left > 0 {
        let size = usize::try_from(left).map_or(BLOCK, |left| left.min(BLOCK));
        one.read_exact(&mut of_one[..size])?;
        other.read_exact(&mut of_other[..size])?;
        if of_one[..size] != of_other[..size] {
            return Ok(false);
        }
        left -= size as u64;
    }
    Ok(true)
}

/// Removes the file `path`, if it exists.
fn remove(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

/// Copies every table of a plant into a schema of its own, in the transaction that changes them, and returns that schema's name.
fn copy_tables(to: &mut dyn Database, version: i64) -> Result<String, DatabaseError> {
    let tables = "SELECT tablename::text FROM pg_tables WHERE schemaname = current_schema() ORDER BY 1";
    let tables: Vec<String> = to.all(tables, &[], |row| row.get(0))?;
    let taken: Vec<String> = to.all("SELECT nspname::text FROM pg_namespace", &[], |row| row.get(0))?;
    let first = format!("before_{version}");
    let mut names = iter::once(first.clone()).chain((2..).map(|nth| format!("{first}_{nth}")));
    let copy = names.find(|name| !taken.contains(name)).unwrap_or_else(|| first.clone());
    to.batch(&format!("CREATE SCHEMA {copy}"))?;
    tables.iter().try_for_each(|table| to.batch(&format!("CREATE TABLE {copy}.{table} AS TABLE {table}")))?;
    Ok(copy)
}

/// Refuses a database if its `version` was made by another text.
fn check(database: &mut dyn Database, path: &Path, version: i64, hash: &str) -> Result<(), StoreError> {
    let text = "SELECT sha256 FROM schema_version WHERE n = $1";
    let applied = database.first(text, values![version], |row| row.get::<String>(0));
    let engine = database.engine();
    let applied =
        applied.map_err(|source| StoreError::refused(engine, path, "to tell its version", source))?;
    match applied {
        Some(applied) if applied == hash => Ok(()),
        _ => Err(StoreError::OtherSchema { path: path.to_owned(), version }),
    }
}

#[cfg(test)]
mod tests {
    use rusqlite::Connection;

    use super::super::database::Sqlite;
    use super::*;

    fn opened(change: &str) -> Result<(), StoreError> {
        let mut database: Box<dyn Database> = Box::new(Sqlite::new(Connection::open_in_memory().unwrap()));
        let path = Path::new("station.db");
        apply(&mut *database, path, 1).unwrap();
        apply(&mut *database, path, 2).unwrap();
        database.batch(change).unwrap();
        apply(&mut *database, path, 3)
    }

    #[test]
    fn a_copy_is_to_have_room_where_the_disk_tells_how_much_it_has() {
        let found = [missing(10, Some(10)), missing(10, Some(9)), missing(3_000_000, Some(999_999))];
        assert_eq!(found, [0, 1, 3]);
        assert_eq!([missing(10, Some(0)), missing(10, None)], [1, 0]);
    }

    #[test]
    fn copies_are_the_same_if_every_byte_is() {
        let folder = tempfile::tempdir().unwrap();
        let [one, other] = ["one", "other"].map(|name| folder.path().join(name));
        for length in [0, 1, 65_535, 65_536, 65_537, 200_000] {
            let bytes = vec![7; length];
            fs::write(&one, &bytes).unwrap();
            fs::write(&other, &bytes).unwrap();
            assert!(hold_the_same(&one, &other).unwrap(), "{length}");
            for place in [0, length / 2, length.saturating_sub(1)] {
                let mut bytes = bytes.clone();
                if let Some(byte) = bytes.get_mut(place) {
                    *byte = 8;
                    fs::write(&other, &bytes).unwrap();
                    assert!(!hold_the_same(&one, &other).unwrap(), "{place} of {length}");
                }
            }
            fs::write(&other, [&bytes[..], &[7]].concat()).unwrap();
            assert!(!hold_the_same(&one, &other).unwrap(), "one more than {length}");
        }
    }

    #[test]
    fn a_database_of_a_newer_program_or_of_another_text_is_refused() {
        assert!(opened("").is_ok());
        let newest = SCHEMAS.len() as i64;
        let newer = opened(&format!("INSERT INTO schema_version VALUES ({}, 'x', 1)", newest + 1));
        assert!(
            matches!(newer, Err(StoreError::Newer { found, known, .. }) if (found, known) == (newest + 1, newest)),
            "{newer:?}"
        );
        let other = opened("UPDATE schema_version SET sha256 = 'x'");
        assert!(matches!(other, Err(StoreError::OtherSchema { version: 1, .. })), "{other:?}");
    }
}
