//! PostgreSQL, by a connection that ends when its server is silent for too long.

use std::collections::HashMap;
use std::error::Error;
use std::fmt;
use std::pin::pin;
use std::time::Duration;

use bytes::BytesMut;
use futures_util::TryStreamExt as _;
use tokio::runtime::{Builder, Runtime};
use tokio::task::JoinHandle;
use tokio::time::timeout;
use tokio_postgres::tls::MakeTlsConnect;
use tokio_postgres::types::{IsNull, ToSql, Type, to_sql_checked};
use tokio_postgres::{Client, Config, Socket, Statement};

use super::value::kept;
use super::{Database, DatabaseError, Each, Engine, Row, Value};

/// How long a server may take to hear that a connection ends.
const FAREWELL: Duration = Duration::from_secs(1);

/// A connection to a PostgreSQL server.
pub(crate) struct Postgres {
    /// Declared before `connection` so that it is dropped first: this ends the connection, for whose end that one waits.
    client: Client,
    connection: Connection,
    /// Prepared statements, by their text.
    ready: HashMap<String, Statement>,
}

/// What a connection runs on.
struct Connection {
    runtime: Runtime,
    task: JoinHandle<Result<(), tokio_postgres::Error>>,
    /// How long to wait for the server's answer; for ever if none.
    patience: Option<Duration>,
}

impl Connection {
    /// Waits for the server's answer. If none comes in time, the connection is ended.
    fn wait<T>(
        &self,
        answer: impl Future<Output = Result<T, tokio_postgres::Error>>,
    ) -> Result<T, DatabaseError> {
        let Some(patience) = self.patience else { return Ok(self.runtime.block_on(answer)?) };
        match self.runtime.block_on(async { timeout(patience, answer).await }) {
            Ok(answered) => Ok(answered?),
            Err(_) => {
                self.task.abort();
                Err(silent(patience))
            }
        }
    }
}

impl Drop for Connection {
    fn drop(&mut self) {
        let Self { runtime, task, .. } = self;
        // A server that does not hear of the end notices it by itself.
        let _ = runtime.block_on(async { timeout(FAREWELL, task).await });
    }
}

fn silent(patience: Duration) -> DatabaseError {
    DatabaseError::Silent { seconds: patience.as_secs() }
}

impl fmt::Debug for Postgres {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Postgres").field("ready", &self.ready.len()).finish_non_exhaustive()
    }
}

impl Postgres {
    /// Connects to the server of `config` within `reached`. After that, each answer must come within `patience`.
    pub(crate) fn connect<T>(
        config: &Config,
        tls: T,
        reached: Duration,
        patience: Option<Duration>,
    ) -> Result<Self, DatabaseError>
    where
        T: MakeTlsConnect<Socket>,
        T::Stream: Send + 'static,
    {
        let runtime = Builder::new_current_thread().enable_all().build().map_err(DatabaseError::Room)?;
        let Ok(connected) = runtime.block_on(async { timeout(reached, config.connect(tls)).await }) else {
            // The system may still be resolving the server's address.
            runtime.shutdown_background();
            return Err(silent(reached));
        };
        let (client, connection) = connected?;
        let connection = Connection { task: runtime.spawn(connection), runtime, patience };
        Ok(Self { client, connection, ready: HashMap::new() })
    }

    fn ready(&mut self, text: &str) -> Result<Statement, DatabaseError> {
        if let Some(statement) = self.ready.get(text) {
            return Ok(statement.clone());
        }
        let statement = self.connection.wait(self.client.prepare(&Engine::Postgres.words(text)))?;
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
        self.connection.wait(self.client.batch_execute(text))
    }

    fn execute(&mut self, text: &str, values: &[Value<'_>]) -> Result<u64, DatabaseError> {
        let statement = self.ready(text)?;
        let values: Vec<_> = values.iter().map(|value| value as &(dyn ToSql + Sync)).collect();
        self.connection.wait(self.client.execute(&statement, &values))
    }

    fn each(&mut self, text: &str, values: &[Value<'_>], row: Each<'_>) -> Result<(), DatabaseError> {
        let statement = self.ready(text)?;
        let mut rows = pin!(self.connection.wait(self.client.query_raw(&statement, values))?);
        while let Some(one) = self.connection.wait(rows.try_next())? {
            row(&Row::Postgres(&one))?;
        }
        Ok(())
    }
}

/// What the column at `place` holds.
pub(super) fn value(row: &tokio_postgres::Row, place: usize) -> Result<Value<'_>, DatabaseError> {
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

/// A value is sent as the type that the server inferred for its place in the statement.
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
