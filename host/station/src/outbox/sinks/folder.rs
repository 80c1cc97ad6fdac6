//! A folder as a sink: a file for each run and each waiver.

use std::fs;
use std::path::{Path, PathBuf};

use halfrow::frames::written_aside::{WriteAsideError, write_aside};

use super::SinkError;
use super::letter::letter;
use crate::export::Format;
use crate::outbox::{Sink, Undelivered};
use crate::store::Parcel;

/// A folder, which is there when what it lies on is mounted.
#[derive(Debug)]
pub(super) struct FolderSink {
    pub(super) name: String,
    pub(super) folder: PathBuf,
    pub(super) format: Format,
}

impl FolderSink {
    fn put(&self, parcel: &Parcel) -> Result<(), SinkError> {
        let Some(letter) = letter(parcel, self.format)? else { return Ok(()) };
        // A folder that was made here would hide the one that is to be mounted.
        if !self.folder.is_dir() {
            return Err(SinkError::NoFolder { path: self.folder.clone() });
        }
        let path = self.folder.join(letter.id + letter.ending);
        match write_aside(&path, false, |file| file.write_all(&letter.bytes)) {
            Err(WriteAsideError::Exists { .. }) => is_as(&path, &letter.bytes),
            written => Ok(written?),
        }
    }
}

/// Whether the file that is there already is the same.
fn is_as(path: &Path, bytes: &[u8]) -> Result<(), SinkError> {
    let there = fs::read(path).map_err(|source| SinkError::Unread { path: path.to_owned(), source })?;
    if there == bytes { Ok(()) } else { Err(SinkError::OtherFile { path: path.to_owned() }) }
}

impl Sink for FolderSink {
    fn name(&self) -> &str {
        &self.name
    }

    fn take(&mut self, parcel: &Parcel) -> Result<(), Undelivered> {
        Ok(self.put(parcel)?)
    }
}
