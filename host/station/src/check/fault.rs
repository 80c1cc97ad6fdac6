//! What can be wrong.

use std::path::PathBuf;

use crate::record::{BlobError, RecordError};
use crate::store::StoreError;

/// Something that is not as it was written.
#[derive(Debug, thiserror::Error)]
pub enum Fault {
    /// SQLite finds the station's database file damaged.
    #[error("the database is damaged ({said}); restore it from a copy")]
    Database {
        /// What it says.
        said: String,
    },
    /// A record or an attachment of a run is missing, or does not match its hash.
    #[error("evidence of run {run} cannot be read as it was written")]
    Evidence {
        /// The run.
        run: String,
        /// What is wrong.
        source: BlobError,
    },
    /// What no row names cannot be read, and may be the record of a run.
    #[error("evidence that no row names cannot be read as it was written")]
    Piece(#[source] BlobError),
    /// A run's record matches its hash, but cannot be understood.
    #[error("the record of run {run} cannot be understood")]
    Record {
        /// The run.
        run: String,
        /// Why.
        source: RecordError,
    },
    /// A run's record does not fit the records before it.
    #[error(
        "the record of run {run} does not fit those before it, as happens when one of them cannot be read; mend \
         that one first, and check again"
    )]
    Contradiction {
        /// The run.
        run: String,
        /// Why.
        source: Box<StoreError>,
    },
    /// The plant does not have the record of a run, or has another text under the record's hash.
    #[error(
        "the record {sha256} of run {run} is not there, or not as it was sent; remove what the table `record` has under this hash, and have \
         the station that sent it send again by `halfrow-station outbox again plant`"
    )]
    Unkept {
        /// The run.
        run: String,
        /// The hash of its record.
        sha256: String,
    },
    /// A run's record is among the evidence, but the database has no row for the run.
    #[error(
        "the record {sha256} is of run {run}, which has no row: station.db has lost the run, or is from before it; stop the station, move \
         station.db, station.db-wal and station.db-shm out of the folder, and put a later copy of station.db there, or move the record \
         out of `blobs` when its run is written down elsewhere"
    )]
    Unnamed {
        /// The run.
        run: String,
        /// The hash of its record.
        sha256: String,
    },
    /// Among the plans that are kept of the plant is something that is neither a file nor a folder, and may lead out of the
    /// folder.
    #[error("{} is neither a file nor a folder, and no program puts such a thing there; remove it, and look who may write there", path.display())]
    Foreign {
        /// What it is.
        path: PathBuf,
    },
    /// A job is marked as done, but the run that did it is missing.
    #[error("the job {job} is done, and its run is not there; look at it by `halfrow-station job list`")]
    Job {
        /// The job.
        job: String,
    },
    /// A line of the audit does not fit the records.
    #[error("the binding of line {id} of the audit does not fit the records")]
    Audit {
        /// The line.
        id: String,
        /// Why.
        source: Box<StoreError>,
    },
    /// A waiver and its line in the audit contradict each other, or one of the two is missing.
    #[error(
        "the waiver of run {run} is not as the audit has it; look in both, and who may write to the database"
    )]
    Waiver {
        /// The run.
        run: String,
    },
    /// The plan in a run's record does not match its hash.
    #[error("the plan in the record of run {run} has another hash than it says; look at the record")]
    Plan {
        /// The run.
        run: String,
    },
    /// A row of a database table differs from what the records say.
    #[error("table {table}, row {key}: {column} is `{stored}`, and the records say `{rebuilt}`")]
    Differs {
        /// The table.
        table: &'static str,
        /// The row's key.
        key: String,
        /// The column.
        column: String,
        /// What is there.
        stored: String,
        /// What should be.
        rebuilt: String,
    },
    /// A row that the records call for is missing from a database table.
    #[error("table {table} has no row {key}, and the records have")]
    Missing {
        /// The table.
        table: &'static str,
        /// The row's key.
        key: String,
    },
    /// A database table has a row that no record calls for.
    #[error("table {table} has a row {key}, and no record has")]
    Surplus {
        /// The table.
        table: &'static str,
        /// The row's key.
        key: String,
    },
}

impl Fault {
    /// Whether a table differs from what the records say.
    pub(crate) const fn is_of_table(&self) -> bool {
        matches!(self, Self::Differs { .. } | Self::Missing { .. } | Self::Surplus { .. })
    }
}
