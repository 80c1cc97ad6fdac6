//! Records that no row names.

use std::collections::BTreeSet;
use std::io;

use halfrow::Verdict;
use serde::Deserialize;
use serde_json::Value;

use super::blobs::read;
use super::{BlobError, Blobs, Piece};

/// A record, of this or another version, that no row names. If its run has a row, the program ended before the record was entered
/// there, or the database is a copy from before that; if not, the record is all that is left of the run.
#[derive(Clone, Debug)]
pub(crate) struct UnnamedRecord {
    /// Its hash.
    pub sha256: String,
    /// The run.
    pub run: String,
    /// The run's verdict by this record.
    pub verdict: Option<Verdict>,
    /// The hashes of the evidence that it names.
    pub attachments: Vec<String>,
}

impl Blobs {
    /// The records among `pieces` that are not in `named`, the hashes that rows name. Pieces that are gone by now are skipped.
    ///
    /// # Errors
    /// [`BlobError`] when a piece cannot be read.
    pub(crate) fn unnamed_records(
        &self,
        pieces: &[Piece],
        named: &BTreeSet<String>,
    ) -> Result<Vec<UnnamedRecord>, BlobError> {
        self.each_unnamed_record(pieces, named).collect()
    }

    /// Like [`Self::unnamed_records`], with an error for each piece that cannot be read.
    pub(crate) fn each_unnamed_record(
        &self,
        pieces: &[Piece],
        named: &BTreeSet<String>,
    ) -> impl Iterator<Item = Result<UnnamedRecord, BlobError>> {
        let unnamed = pieces.iter().filter(|piece| !named.contains(&piece.hash));
        unnamed.filter_map(|piece| self.as_record(&piece.hash).transpose())
    }

    /// The hashes of the evidence that the record with this hash names; none if it cannot be read.
    pub(crate) fn named_by(&self, record: &str) -> Vec<String> {
        self.as_record(record).ok().flatten().map_or_else(Vec::new, |record| record.attachments)
    }

    fn as_record(&self, hash: &str) -> Result<Option<UnnamedRecord>, BlobError> {
        let path = self.path(hash);
        let bytes = match read(&path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            read => read.map_err(|source| BlobError::Read { path, source })?,
        };
        let Ok(record) = serde_json::from_slice::<Record>(&bytes) else { return Ok(None) };
        let Record { run, conclusion, attachments, .. } = record;
        let attachments = attachments.into_iter().map(|one| one.sha256).collect();
        let verdict = Verdict::deserialize(&conclusion["verdict"]).ok();
        Ok(Some(UnnamedRecord { sha256: hash.to_owned(), run: run.id, verdict, attachments }))
    }
}

/// What records of every version have in common.
#[derive(Deserialize)]
struct Record {
    #[serde(rename = "schema")]
    _schema: u32,
    run: Run,
    #[serde(default)]
    conclusion: Value,
    attachments: Vec<Attachment>,
}

#[derive(Deserialize)]
struct Run {
    id: String,
}

#[derive(Deserialize)]
struct Attachment {
    sha256: String,
}
