//! One interface to two engines: SQLite at a station, PostgreSQL at a plant. Both take the same statements.

mod postgres;
mod sqlite;
mod value;

use std::error::Error as _;
use std::fmt::Debug;
use std::{io, iter};

use rusqlite::{ErrorCode, ffi};

pub(crate) use self::postgres::Postgres;
pub(crate) use sqlite::Sqlite;
pub(crate) use value::{FromValue, Value, values};

use super::statements::OF_PLANT;

/// An error of an engine.
#[derive(Debug, thiserror::Error)]
pub enum DatabaseError {
    /// An error of SQLite.
    #[error(transparent)]
    Sqlite(rusqlite::Error),
    /// An error of PostgreSQL, or of the connection to it.
    #[error(transparent)]
    Postgres(#[from] tokio_postgres::Error),
    /// The server of a plant does not answer.
    #[error("the server has said nothing for {seconds} s")]
    Silent {
        /// How long.
        seconds: u64,
    },
    /// The system lacks the resources to wait for a server.
    #[error("the system has no room for a connection")]
    Room(#[source] io::Error),
    /// The role may use no schema of the plant's database.
    #[error("the role may use no schema there; grant it USAGE on the schema with the tables")]
    NoSchema,
    /// A column holds something other than it should.
    #[error("column {place} of a row holds {found} where {expected} should be")]
    Column {
        /// Its place, from 0.
        place: usize,
        /// What it holds.
        found: &'static str,
        /// What it should hold.
        expected: &'static str,
    },
    /// A row names another one that does not exist.
    #[error("a row names {what} that is not there")]
    Dangling {
        /// What it names.
        what: &'static str,
    },
    /// A text is not the JSON that it should be, or something cannot be written as JSON.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
}

impl From<rusqlite::Error> for DatabaseError {
    fn from(error: rusqlite::Error) -> Self {
        use rusqlite::Error::SqliteFailure;
        Self::Sqlite(match error {
            // SQLite has no words for this one, by which alone a full disk is known where a database is opened.
            SqliteFailure(error, None) if error.extended_code == ffi::SQLITE_IOERR_SHMSIZE => {
                SqliteFailure(error, Some("the disk has no room for the file station.db-shm".to_owned()))
            }
            error => error,
        })
    }
}

impl DatabaseError {
    /// Whether the file itself is not what it should be.
    pub(crate) fn is_damage(&self) -> bool {
        use rusqlite::Error::{SqlInputError, SqliteFailure};
        let Self::Sqlite(SqliteFailure(error, _) | SqlInputError { error, .. }) = self else { return false };
        matches!(error.code, ErrorCode::DatabaseCorrupt | ErrorCode::NotADatabase)
    }

    /// Whether another program holds the file.
    pub(crate) fn is_lock(&self) -> bool {
        let code = if let Self::Sqlite(error) = self { error.sqlite_error_code() } else { None };
        matches!(code, Some(ErrorCode::DatabaseBusy | ErrorCode::DatabaseLocked))
    }

    /// Whether a file could not grow.
    pub(crate) fn is_full(&self) -> bool {
        matches!(self, Self::Sqlite(error) if error.sqlite_error_code() == Some(ErrorCode::DiskFull))
    }

    /// Whether the file could not be read, as opposed to another one that was to be written from it.
    pub(crate) fn is_of_reading(&self) -> bool {
        let code = if let Self::Sqlite(error) = self { error.sqlite_error() } else { None };
        let unread = [ffi::SQLITE_IOERR_READ, ffi::SQLITE_IOERR_SHORT_READ];
        self.is_damage() || code.is_some_and(|code| unread.contains(&code.extended_code))
    }

    /// Whether the station's engine already has a row that must be unique.
    pub(crate) fn is_conflict(&self) -> bool {
        matches!(self, Self::Sqlite(error) if error.sqlite_error_code() == Some(ErrorCode::ConstraintViolation))
    }

    /// Whether the engine is unavailable, as opposed to refusing this one statement.
    pub(crate) fn is_away(&self) -> bool {
        let error = match self {
            Self::Postgres(error) => error,
            Self::Silent { .. } | Self::Room(_) => return true,
            _ => return false,
        };
        // Connection exceptions, insufficient resources, operator interventions and system errors: PostgreSQL, appendix A.
        let away = |code: &str| ["08", "53", "57", "58"].iter().any(|class| code.starts_with(class));
        error.as_db_error().map_or_else(|| is_of_connection(error), |said| away(said.code().code()))
    }

    /// Whether the engine can never store what it was given. What contradicts other rows may be accepted once they have changed.
    pub(crate) fn is_of_content(&self) -> bool {
        let Self::Postgres(error) = self else { return false };
        // Data exceptions: PostgreSQL, appendix A.
        error.code().is_some_and(|code| code.code().starts_with("22"))
    }
}

/// Whether an error that is not the server's is one of the connection, and not of a value.
fn is_of_connection(error: &tokio_postgres::Error) -> bool {
    let mut causes = iter::successors(error.source(), |&cause| cause.source());
    error.is_closed() || causes.any(<dyn std::error::Error>::is::<io::Error>)
}

/// A row as an engine returns it.
#[derive(Debug)]
pub(crate) enum Row<'a> {
    Sqlite(&'a rusqlite::Row<'a>),
    Postgres(&'a tokio_postgres::Row),
}

impl Row<'_> {
    /// What the column at `place`, from 0, holds.
    pub(crate) fn get<T: FromValue>(&self, place: usize) -> Result<T, DatabaseError> {
        let value = self.value(place)?;
        let found = value.kind();
        T::from_value(value).ok_or(DatabaseError::Column { place, found, expected: T::EXPECTED })
    }

    /// The text in the column at `place`, borrowed.
    pub(crate) fn text(&self, place: usize) -> Result<&str, DatabaseError> {
        match self.value(place)? {
            Value::Text(text) => Ok(text),
            other => Err(DatabaseError::Column { place, found: other.kind(), expected: "a text" }),
        }
    }

    /// Each column with its name.
    pub(crate) fn columns(&self) -> Result<Vec<(String, Value<'_>)>, DatabaseError> {
        let names: Vec<String> = match self {
            Self::Sqlite(row) => row.as_ref().column_names().map(str::to_owned).collect(),
            Self::Postgres(row) => row.columns().iter().map(|column| column.name().to_owned()).collect(),
        };
        names.into_iter().enumerate().map(|(place, name)| Ok((name, self.value(place)?))).collect()
    }

    fn value(&self, place: usize) -> Result<Value<'_>, DatabaseError> {
        match self {
            Self::Sqlite(row) => sqlite::value(row, place),
            Self::Postgres(row) => postgres::value(row, place),
        }
    }
}

/// An engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Engine {
    /// A station's.
    Sqlite,
    /// A plant's.
    Postgres,
}

impl Engine {
    /// A schema, or a statement of a plant, with its words in braces replaced: the engine's types for whole and for other
    /// numbers, its mark of strict tables, and what is said [of jobs and boards](OF_PLANT), which only a plant has.
    pub(crate) fn words(self, text: &str) -> String {
        let [int, real, strict] = match self {
            Self::Sqlite => ["INTEGER", "REAL", " STRICT"],
            Self::Postgres => ["BIGINT", "DOUBLE PRECISION", ""],
        };
        let words = OF_PLANT.into_iter().chain([("{int}", int), ("{real}", real), ("{strict}", strict)]);
        words.fold(text.to_owned(), |text, (word, meaning)| text.replace(word, meaning))
    }
}

/// What is done with each row.
pub(crate) type Each<'a> = &'a mut dyn FnMut(&Row<'_>) -> Result<(), DatabaseError>;

/// A connection to an engine.
pub(crate) trait Database: Debug + Send {
    /// Which engine it is.
    fn engine(&self) -> Engine;

    /// Begins a transaction that writes.
    fn begin(&mut self) -> Result<(), DatabaseError>;

    /// Executes statements without values.
    fn batch(&mut self, text: &str) -> Result<(), DatabaseError>;

    /// Executes a statement. Returns how many rows it changed.
    fn execute(&mut self, text: &str, values: &[Value<'_>]) -> Result<u64, DatabaseError>;

    /// Sets whether the log is left alone when the connection closes, instead of being folded into the file.
    fn leave_log(&mut self, _leaves: bool) {}

    /// Hands every row of a query to `row`.
    fn each(&mut self, text: &str, values: &[Value<'_>], row: Each<'_>) -> Result<(), DatabaseError>;
}

impl dyn Database + '_ {
    /// What `row` makes of every row.
    pub(crate) fn all<T>(
        &mut self,
        text: &str,
        values: &[Value<'_>],
        mut row: impl FnMut(&Row<'_>) -> Result<T, DatabaseError>,
    ) -> Result<Vec<T>, DatabaseError> {
        let mut all = Vec::new();
        self.each(text, values, &mut |one| {
            all.push(row(one)?);
            Ok(())
        })?;
        Ok(all)
    }

    /// What `row` makes of the first row, if there is one.
    pub(crate) fn first<T>(
        &mut self,
        text: &str,
        values: &[Value<'_>],
        row: impl FnMut(&Row<'_>) -> Result<T, DatabaseError>,
    ) -> Result<Option<T>, DatabaseError> {
        Ok(self.all(text, values, row)?.into_iter().next())
    }

    /// What `row` makes of the one row that there always is.
    pub(crate) fn one<T>(
        &mut self,
        text: &str,
        values: &[Value<'_>],
        row: impl FnMut(&Row<'_>) -> Result<T, DatabaseError>,
    ) -> Result<T, DatabaseError> {
        self.first(text, values, row)?.ok_or(DatabaseError::Dangling { what: "a row" })
    }

    /// Runs `change` in a transaction, which is committed. If it fails or panics, it is rolled back.
    pub(crate) fn transaction<T>(
        &mut self,
        change: impl FnOnce(&mut dyn Database) -> Result<T, DatabaseError>,
    ) -> Result<T, DatabaseError> {
        self.begin()?;
        let mut open = Open { database: self, is_over: false };
        let done = change(open.database)?;
        open.database.batch("COMMIT")?;
        open.is_over = true;
        Ok(done)
    }
}

/// A transaction that is rolled back unless it is over.
struct Open<'a, 'b> {
    database: &'a mut (dyn Database + 'b),
    is_over: bool,
}

impl Drop for Open<'_, '_> {
    fn drop(&mut self) {
        if !self.is_over
            && let Err(error) = self.database.batch("ROLLBACK")
        {
            tracing::debug!("a transaction was over before it was taken back: {error}");
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use rusqlite::Connection;
    use tokio_postgres::{Config, NoTls};

    use super::*;

    /// <https://www.sqlite.org/rescode.html#ioerr_shmsize>
    #[test]
    fn a_disk_that_is_full_at_the_start_is_told_in_words() {
        let full = DatabaseError::from(rusqlite::Error::SqliteFailure(ffi::Error::new(4874), None));
        assert_eq!(full.to_string(), "the disk has no room for the file station.db-shm");
    }

    #[test]
    fn a_file_that_another_program_holds_is_told_from_one_that_cannot_be_written() {
        let place = tempfile::tempdir().unwrap();
        let [held, other] = [(); 2].map(|()| Connection::open(place.path().join("station.db")).unwrap());
        held.execute_batch("BEGIN IMMEDIATE").unwrap();
        other.busy_timeout(Duration::ZERO).unwrap();
        let begun = |sql: &str| DatabaseError::from(other.execute_batch(sql).unwrap_err());
        assert!(begun("BEGIN IMMEDIATE").is_lock());
        assert!(!begun("PRAGMA query_only = ON; CREATE TABLE run (id)").is_lock());
    }

    #[test]
    fn an_error_of_the_connection_means_that_the_engine_is_away_and_one_of_a_text_does_not() {
        // Nothing answers there.
        let nobody: Config = "host=127.0.0.1 port=1".parse().unwrap();
        let refused = Postgres::connect(&nobody, NoTls, Duration::from_secs(60), None).unwrap_err();
        assert!(refused.is_away(), "{refused:?}");
        let wrong = DatabaseError::from("host='".parse::<Config>().unwrap_err());
        assert!(!wrong.is_away(), "{wrong:?}");
    }
}
