//! PostgreSQL.

use std::collections::HashMap;
use std::error::Error;
use std::fmt;

use bytes::BytesMut;
use postgres::fallible_iterator::FallibleIterator as _;
use postgres::types::{IsNull, ToSql, Type, to_sql_checked};
use postgres::{Client, Statement};

use super::value::kept;
use super::{Database, DatabaseError, Each, Engine, Row, Value};

/// A connection to a PostgreSQL server.
pub(crate) struct Postgres {
    client: Client,
    /// Statements by their text, which the server has read already.
    ready: HashMap<String, Statement>,
}

impl fmt::Debug for Postgres {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Postgres").field("ready", &self.ready.len()).finish_non_exhaustive()
    }
}

impl Postgres {
    pub(crate) fn new(client: Client) -> Self {
        Self { client, ready: HashMap::new() }
    }

    fn ready(&mut self, text: &str) -> Result<Statement, DatabaseError> {
        if let Some(statement) = self.ready.get(text) {
            return Ok(statement.clone());
        }
        let statement = self.client.prepare(text)?;
        self.ready.insert(text.to_owned(), statement.clone());
        Ok(statement)
    }
}

impl Database for Postgres {
    fn engine(&self) -> Engine {
        Engine::Postgres
    }

    fn begin(&mut self) -> Result<(), DatabaseError> {
        self.batch("BEGIN")
    }

    fn batch(&mut self, text: &str) -> Result<(), DatabaseError> {
        Ok(self.client.batch_execute(text)?)
    }

    fn execute(&mut self, text: &str, values: &[Value<'_>]) -> Result<u64, DatabaseError> {
        let statement = self.ready(text)?;
        let values: Vec<_> = values.iter().map(|value| value as &(dyn ToSql + Sync)).collect();
        Ok(self.client.execute(&statement, &values)?)
    }

    fn each(&mut self, text: &str, values: &[Value<'_>], row: Each<'_>) -> Result<(), DatabaseError> {
        let statement = self.ready(text)?;
        let mut rows = self.client.query_raw(&statement, values)?;
        while let Some(one) = rows.next()? {
            row(&Row::Postgres(&one))?;
        }
        Ok(())
    }
}

/// What the column at `place` holds.
pub(super) fn value(row: &postgres::Row, place: usize) -> Result<Value<'_>, DatabaseError> {
    let Some(column) = row.columns().get(place) else {
        return Err(DatabaseError::Column { place, found: "nothing", expected: "a column" });
    };
    Ok(match *column.type_() {
        Type::BOOL => row.try_get::<_, Option<bool>>(place)?.map(i64::from).into(),
        Type::INT4 => row.try_get::<_, Option<i32>>(place)?.map(i64::from).into(),
        Type::INT8 => row.try_get::<_, Option<i64>>(place)?.into(),
        Type::FLOAT8 => row.try_get::<_, Option<f64>>(place)?.into(),
        _ => row.try_get::<_, Option<&str>>(place)?.into(),
    })
}

/// A value is sent as the type that the server has found for its place in the statement.
impl ToSql for Value<'_> {
    fn to_sql(&self, of: &Type, out: &mut BytesMut) -> Result<IsNull, Box<dyn Error + Sync + Send>> {
        match (*self, of) {
            (Self::Null, _) => Ok(IsNull::Yes),
            (Self::Whole(whole), &Type::INT4) => i32::try_from(whole)?.to_sql(of, out),
            (Self::Whole(whole), &Type::BOOL) => (whole != 0).to_sql(of, out),
            (Self::Whole(whole), &Type::FLOAT8) => (whole as f64).to_sql(of, out),
            (Self::Whole(whole), _) => whole.to_sql(of, out),
            (Self::Real(real), _) => real.to_sql(of, out),
            (Self::Text(text), _) => kept(text).as_ref().to_sql(of, out),
        }
    }

    fn accepts(of: &Type) -> bool {
        [Type::BOOL, Type::INT4, Type::INT8, Type::FLOAT8, Type::TEXT, Type::VARCHAR, Type::UNKNOWN]
            .contains(of)
    }

    to_sql_checked!();
}
