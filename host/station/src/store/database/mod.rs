//! The two engines behind one door: SQLite at a station, PostgreSQL at a plant. Both take the same text.

mod postgres;
mod sqlite;
mod value;

use std::fmt::Debug;
use std::io;

use rusqlite::ErrorCode;

pub(crate) use self::postgres::Postgres;
pub(crate) use sqlite::Sqlite;
pub(crate) use value::{FromValue, Value, values};

use super::statements::OF_BOARDS;

/// Something that an engine does not do.
#[derive(Debug, thiserror::Error)]
pub enum DatabaseError {
    /// SQLite says why.
    #[error(transparent)]
    Sqlite(#[from] rusqlite::Error),
    /// PostgreSQL says why, or the connection to it does.
    #[error(transparent)]
    Postgres(#[from] tokio_postgres::Error),
    /// The server of a plant is not there, or does as if it were not.
    #[error("the server has said nothing for {seconds} s")]
    Silent {
        /// How long.
        seconds: u64,
    },
    /// The system does not let anybody wait for a server.
    #[error("the system has no room for a connection")]
    Room(#[source] io::Error),
    /// A column holds something else than it should.
    #[error("column {place} of a row holds {found} where {expected} should be")]
    Column {
        /// Its place, from 0.
        place: usize,
        /// What it holds.
        found: &'static str,
        /// What it should hold.
        expected: &'static str,
    },
    /// A row names another one that is not there.
    #[error("a row names {what} that is not there")]
    Dangling {
        /// What it names.
        what: &'static str,
    },
    /// A text that should be JSON is none, or the other way round.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
}

impl DatabaseError {
    /// Whether the file itself is not what it should be.
    pub(crate) fn is_damage(&self) -> bool {
        use rusqlite::Error::{SqlInputError, SqliteFailure};
        let Self::Sqlite(SqliteFailure(error, _) | SqlInputError { error, .. }) = self else { return false };
        matches!(error.code, ErrorCode::DatabaseCorrupt | ErrorCode::NotADatabase)
    }

    /// Whether the station's engine has a row already that there may be only one of.
    pub(crate) fn is_conflict(&self) -> bool {
        matches!(self, Self::Sqlite(error) if error.sqlite_error_code() == Some(ErrorCode::ConstraintViolation))
    }

    /// Whether the engine is not there, or not for now, rather than that it does not do this one thing.
    pub(crate) fn is_away(&self) -> bool {
        let error = match self {
            Self::Postgres(error) => error,
            Self::Silent { .. } | Self::Room(_) => return true,
            _ => return false,
        };
        // Connections and resources that are no more, and an operator's intervention: PostgreSQL, appendix A.
        let away = |code: &str| ["08", "53", "57", "58"].iter().any(|class| code.starts_with(class));
        error.as_db_error().is_none_or(|said| away(said.code().code()))
    }

    /// Whether the engine can never hold what it was given. What contradicts other rows may be taken once they have changed.
    pub(crate) fn is_of_content(&self) -> bool {
        let Self::Postgres(error) = self else { return false };
        // Data exceptions: PostgreSQL, appendix A.
        error.code().is_some_and(|code| code.code().starts_with("22"))
    }
}

/// A row as an engine brings it.
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

    /// The text in the column at `place`, where it stands.
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
    /// A schema, or a statement of a plant, with what its words stand for: those that the engines have for whole numbers, other numbers,
    /// and tables that take nothing else; and of boards that are shared, which only a plant has, [those](OF_BOARDS).
    pub(crate) fn words(self, text: &str) -> String {
        let [int, real, strict] = match self {
            Self::Sqlite => ["INTEGER", "REAL", " STRICT"],
            Self::Postgres => ["BIGINT", "DOUBLE PRECISION", ""],
        };
        let words = OF_BOARDS.into_iter().chain([("{int}", int), ("{real}", real), ("{strict}", strict)]);
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

    /// Carries out statements without values.
    fn batch(&mut self, text: &str) -> Result<(), DatabaseError>;

    /// Carries a statement out. Returns how many rows it changed.
    fn execute(&mut self, text: &str, values: &[Value<'_>]) -> Result<u64, DatabaseError>;

    /// Whether at its end nothing is brought from the log into the file.
    fn leave_log(&mut self, _leaves: bool) {}

    /// Brings every row of a statement that reads.
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

    /// What `change` returns, once all that it did is kept; of what fails, or panics, nothing is.
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

/// A transaction that is taken back unless it is over.
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
