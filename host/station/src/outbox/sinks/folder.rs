//! A folder as a sink: a file for each run and each waiver.

use std::fs::{self, File, Permissions};
use std::io;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::time::Duration;

use halfrow::files::written_aside::{Aside, WriteAsideError, clear_older, sync_folder};

use super::SinkError;
use super::letter::letter;
use crate::export::Format;
use crate::outbox::{Sink, Undelivered};
use crate::store::Parcel;

/// A folder, which exists when what it lies on is mounted.
#[derive(Debug)]
pub(super) struct FolderSink {
    pub(super) name: String,
    pub(super) folder: PathBuf,
    pub(super) format: Format,
    /// Whether it was cleared of what a killed program left in it.
    pub(super) is_clear: bool,
}

/// How old a file is that nobody writes any more, on a share of which no lock may tell.
const LEFT: Duration = Duration::from_secs(86_400);

impl FolderSink {
    fn put(&mut self, parcel: &Parcel) -> Result<(), SinkError> {
        let Some(letter) = letter(parcel, self.format)? else { return Ok(()) };
        self.is_there()?;
        if !self.is_clear {
            clear_older(&self.folder, LEFT);
            self.is_clear = true;
        }
        let path = self.folder.join(letter.id + letter.ending);
        let written = Aside::written(&path, false, |file| file.write_all(&letter.bytes));
        match written.and_then(Aside::rename_into_place) {
            Err(WriteAsideError::Exists { .. }) => {
                is_as(&path, &letter.bytes)?;
                // A program that was killed may have left it without bringing it to the disk.
                self.synced(&path, File::open(&path).and_then(|file| file.sync_all()))?;
            }
            written => written.map_err(|error| self.unwritten(error))?,
        }
        self.synced(&path, sync_folder(&self.folder))?;
        self.open_to_readers(&path);
        Ok(())
    }

    /// Refuses to count the file `path` as there for certain unless it was `brought` to the disk.
    fn synced(&self, path: &Path, brought: io::Result<()>) -> Result<(), SinkError> {
        brought.map_err(|source| self.unwritten(WriteAsideError::Io { path: path.to_owned(), source }))
    }

    /// Refuses a folder that does not exist. One made here would hide the one that is to be mounted.
    fn is_there(&self) -> Result<(), SinkError> {
        let path = self.folder.clone();
        match fs::metadata(&path) {
            Ok(about) if about.is_dir() => Ok(()),
            Err(source) if source.kind() != io::ErrorKind::NotFound => Err(SinkError::Shut { path, source }),
            _ => Err(SinkError::NoFolder { path }),
        }
    }

    fn unwritten(&self, error: WriteAsideError) -> SinkError {
        match error {
            WriteAsideError::Io { ref source, .. } if source.kind() == io::ErrorKind::ReadOnlyFilesystem => {
                SinkError::ReadOnly { path: self.folder.clone(), source: error }
            }
            error => error.into(),
        }
    }

    /// Lets whoever may read the folder read a file in it; the service's umask is for the station's own files.
    fn open_to_readers(&self, path: &Path) {
        let mode = |path: &Path| fs::metadata(path).map(|about| about.permissions().mode() & 0o777);
        if let (Ok(folder), Ok(file)) = (mode(&self.folder), mode(path)) {
            let wanted = 0o600 | (folder & 0o044);
            if file != wanted {
                // A file system without modes has its own way to say who may read.
                let _ = fs::set_permissions(path, Permissions::from_mode(wanted));
            }
        }
    }
}

/// Refuses a file that exists already with other bytes.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_that_may_be_there_is_not_said_to_be_away() {
        let place = tempfile::tempdir().unwrap();
        let sink = |name: &str| FolderSink {
            name: "share".to_owned(),
            folder: place.path().join(name),
            format: Format::default(),
            is_clear: false,
        };
        std::os::unix::fs::symlink("loop", place.path().join("loop")).unwrap();
        assert!(matches!(sink("nothing").is_there(), Err(SinkError::NoFolder { .. })));
        // As root no folder is shut, but this cannot be reached either.
        let shut = sink("loop").is_there().unwrap_err();
        assert!(shut.to_string().contains("ProtectHome="), "{shut}");
        assert!(matches!(shut.into(), Undelivered::Away(_)), "nothing else need be tried");
    }

    #[test]
    fn a_read_only_folder_is_told_with_what_opens_it_to_the_service() {
        let folder = PathBuf::from("/mnt/share/results");
        let sink =
            FolderSink { name: "share".to_owned(), folder, format: Format::default(), is_clear: false };
        let failed = |kind| {
            let path = sink.folder.join("run.json");
            sink.unwritten(WriteAsideError::Io { path, source: io::Error::from(kind) })
        };
        let read_only = failed(io::ErrorKind::ReadOnlyFilesystem);
        let said = read_only.to_string();
        assert!(said.contains("ReadWritePaths=/mnt/share/results below [Service]"), "{said}");
        assert!(matches!(read_only.into(), Undelivered::Away(_)), "nothing else need be tried");
        let full = failed(io::ErrorKind::StorageFull);
        assert!(full.to_string().contains("has space"));
        // A smaller one may have room, and this one will when somebody has made some.
        assert!(matches!(full.into(), Undelivered::NotNow(_)));
    }
}
