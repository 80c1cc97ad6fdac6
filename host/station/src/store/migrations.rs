//! Brings a database to the version that this program knows.

use std::fs::{self, File};
use std::io;
use std::path::Path;

use halfrow::result::sha256;
use rusqlite::{Connection, OptionalExtension as _, TransactionBehavior, params};

use super::StoreError;
use super::statements::{SCHEMA_VERSION, SCHEMAS, for_sqlite};

/// Applies each schema that `database`, the file `path`, does not have yet, in a transaction of its own. Before a
/// database that holds results is changed, a copy of it is laid beside it.
pub(super) fn apply(database: &mut Connection, path: &Path, now_ms: i64) -> Result<(), StoreError> {
    let refused = |source| StoreError::Database { path: path.to_owned(), doing: "a new version", source };
    database.execute_batch(&for_sqlite(SCHEMA_VERSION)).map_err(refused)?;
    let newest: Option<i64> =
        database.query_row("SELECT max(n) FROM schema_version", [], |row| row.get(0)).map_err(refused)?;
    let found = newest.unwrap_or(0);
    not_newer(path, found)?;
    for (version, schema) in (1_i64..).zip(SCHEMAS) {
        let hash = sha256([schema]);
        if version <= found {
            check(database, path, version, &hash)?;
            continue;
        }
        if found > 0 {
            copy(database, path, version)?;
        }
        let change = database.transaction_with_behavior(TransactionBehavior::Immediate).map_err(refused)?;
        change.execute_batch(&for_sqlite(schema)).map_err(refused)?;
        let note = "INSERT INTO schema_version (n, sha256, applied_ms) VALUES ($1, $2, $3)";
        change.execute(note, params![version, hash, now_ms]).map_err(refused)?;
        change.commit().map_err(refused)?;
    }
    Ok(())
}

/// Refuses a database that is not of this program's version: `found`, and the file is `path`.
pub(super) fn is_known(path: &Path, found: i64) -> Result<(), StoreError> {
    not_newer(path, found)?;
    let known = SCHEMAS.len() as i64;
    if found < known {
        return Err(StoreError::Older { path: path.to_owned(), found, known });
    }
    Ok(())
}

fn not_newer(path: &Path, found: i64) -> Result<(), StoreError> {
    let known = SCHEMAS.len() as i64;
    if found > known {
        return Err(StoreError::Newer { path: path.to_owned(), found, known });
    }
    Ok(())
}

/// Lays a copy of `database`, the file `path`, beside it, whole or not at all.
fn copy(database: &Connection, path: &Path, version: i64) -> Result<(), StoreError> {
    let whole = path.with_extension(format!("before-{version}.db"));
    let aside = path.with_extension(format!("before-{version}.partial"));
    let refused = |source| StoreError::Folder { folder: path.parent().unwrap_or(path).to_owned(), source };
    match fs::remove_file(&aside) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(refused(error)),
        _ => {}
    }
    database.execute("VACUUM INTO $1", [aside.to_string_lossy()]).map_err(|source| StoreError::Database {
        path: path.to_owned(),
        doing: "a copy before a new version",
        source,
    })?;
    File::open(&aside).and_then(|file| file.sync_all()).map_err(refused)?;
    fs::rename(&aside, &whole).map_err(refused)
}

/// Refuses a database whose version was made by another text.
fn check(database: &Connection, path: &Path, version: i64, hash: &str) -> Result<(), StoreError> {
    let text = "SELECT sha256 FROM schema_version WHERE n = $1";
    let applied = database.query_row(text, [version], |row| row.get::<_, String>(0)).optional();
    let applied = applied.map_err(|source| StoreError::Database {
        path: path.to_owned(),
        doing: "to tell its version",
        source,
    })?;
    match applied {
        Some(applied) if applied == hash => Ok(()),
        _ => Err(StoreError::OtherSchema { path: path.to_owned(), version }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn opened(change: &str) -> Result<(), StoreError> {
        let mut database = Connection::open_in_memory().unwrap();
        let path = Path::new("station.db");
        apply(&mut database, path, 1).unwrap();
        apply(&mut database, path, 2).unwrap();
        database.execute_batch(change).unwrap();
        apply(&mut database, path, 3)
    }

    #[test]
    fn a_database_of_a_newer_program_or_of_another_text_is_refused() {
        assert!(opened("").is_ok());
        let newer = opened("INSERT INTO schema_version VALUES (3, 'x', 1)");
        assert!(matches!(newer, Err(StoreError::Newer { found: 3, known: 2, .. })), "{newer:?}");
        let other = opened("UPDATE schema_version SET sha256 = 'x'");
        assert!(matches!(other, Err(StoreError::OtherSchema { version: 1, .. })), "{other:?}");
    }
}
