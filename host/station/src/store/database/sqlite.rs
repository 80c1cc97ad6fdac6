//! SQLite.

use std::borrow::Cow;

use rusqlite::config::DbConfig;
use rusqlite::types::{ToSqlOutput, ValueRef};
use rusqlite::{Connection, ToSql, params_from_iter};

use super::value::kept;
use super::{Database, DatabaseError, Each, Engine, Row, Value};

/// Statements that a connection keeps prepared: more than a run's record takes.
const PREPARED: usize = 128;

/// A connection to a SQLite file, or to one in memory.
#[derive(Debug)]
pub(crate) struct Sqlite(Connection);

impl Sqlite {
    pub(crate) fn new(connection: Connection) -> Self {
        connection.set_prepared_statement_cache_capacity(PREPARED);
        // Without this SQLite may plan a statement anew for each value. If it cannot be set, the connection is only slower.
        let _ = connection.set_db_config(DbConfig::SQLITE_DBCONFIG_ENABLE_QPSG, true);
        Self(connection)
    }
}

impl Database for Sqlite {
    fn engine(&self) -> Engine {
        Engine::Sqlite
    }

    fn begin(&mut self) -> Result<(), DatabaseError> {
        // A transaction that begins by reading could fail at its first write, because another one has written meanwhile.
        self.batch("BEGIN IMMEDIATE")
    }

    fn batch(&mut self, text: &str) -> Result<(), DatabaseError> {
        Ok(self.0.execute_batch(text)?)
    }

    fn execute(&mut self, text: &str, values: &[Value<'_>]) -> Result<u64, DatabaseError> {
        Ok(self.0.prepare_cached(text)?.execute(params_from_iter(values))? as u64)
    }

    fn leave_log(&mut self, leaves: bool) {
        // SQLite does not refuse this.
        let _ = self.0.set_db_config(DbConfig::SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, leaves);
    }

    fn each(&mut self, text: &str, values: &[Value<'_>], row: Each<'_>) -> Result<(), DatabaseError> {
        let mut statement = self.0.prepare_cached(text)?;
        let mut rows = statement.query(params_from_iter(values))?;
        while let Some(one) = rows.next()? {
            row(&Row::Sqlite(one))?;
        }
        Ok(())
    }
}

/// What the column at `place` holds. No table of a station has blobs.
pub(super) fn value<'a>(row: &'a rusqlite::Row<'a>, place: usize) -> Result<Value<'a>, DatabaseError> {
    Ok(match row.get_ref(place)? {
        ValueRef::Null => Value::Null,
        ValueRef::Integer(whole) => Value::Whole(whole),
        ValueRef::Real(real) => Value::Real(real),
        ValueRef::Text(_) => Value::Text(row.get_ref(place)?.as_str().map_err(rusqlite::Error::from)?),
        ValueRef::Blob(_) => {
            return Err(DatabaseError::Column { place, found: "bytes", expected: "a number or a text" });
        }
    })
}

impl ToSql for Value<'_> {
    fn to_sql(&self) -> rusqlite::Result<ToSqlOutput<'_>> {
        Ok(ToSqlOutput::Borrowed(match *self {
            Self::Null => ValueRef::Null,
            Self::Whole(whole) => ValueRef::Integer(whole),
            Self::Real(real) => ValueRef::Real(real),
            Self::Text(text) => match kept(text) {
                Cow::Borrowed(text) => ValueRef::Text(text.as_bytes()),
                Cow::Owned(text) => return Ok(ToSqlOutput::Owned(text.into())),
            },
        }))
    }
}
