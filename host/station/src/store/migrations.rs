//! Brings a database to the version that this program knows.

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
    let (found, known) = (newest.unwrap_or(0), SCHEMAS.len() as i64);
    if found > known {
        return Err(StoreError::Newer { path: path.to_owned(), found, known });
    }
    for (version, schema) in (1_i64..).zip(SCHEMAS) {
        let hash = sha256([schema]);
        if version <= found {
            check(database, path, version, &hash)?;
            continue;
        }
        if version > 1 {
            let copy = path.with_extension(format!("before-{version}.db"));
            database.execute("VACUUM INTO $1", [copy.to_string_lossy()]).map_err(refused)?;
        }
        let change = database.transaction_with_behavior(TransactionBehavior::Immediate).map_err(refused)?;
        change.execute_batch(&for_sqlite(schema)).map_err(refused)?;
        let note = "INSERT INTO schema_version (n, sha256, applied_ms) VALUES ($1, $2, $3)";
        change.execute(note, params![version, hash, now_ms]).map_err(refused)?;
        change.commit().map_err(refused)?;
    }
    Ok(())
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
        let newer = opened("INSERT INTO schema_version VALUES (2, 'x', 1)");
        assert!(matches!(newer, Err(StoreError::Newer { found: 2, known: 1, .. })), "{newer:?}");
        let other = opened("UPDATE schema_version SET sha256 = 'x'");
        assert!(matches!(other, Err(StoreError::OtherSchema { version: 1, .. })), "{other:?}");
    }
}
