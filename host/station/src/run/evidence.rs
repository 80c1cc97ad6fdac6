//! What a lane wrote down, as evidence.

use std::fs::{self, File};
use std::io::{self, Read as _};
use std::path::Path;

use crate::lane::supervisor::{EVENTS, LOG};
use crate::lane::{FILE_MIB, kept_frame};
use crate::record::{Attachment, BlobError, Blobs};
use crate::said::Said;
use crate::store::StoreError;

/// A file in a spool of which something could not be read, and is in no record.
const UNREAD: &str = "unread";

/// Whether there is something in the spool of a run that is over which is in no record.
pub(super) fn has_unread(spool: &Path) -> bool {
    spool.join(UNREAD).exists()
}

/// Stores what a lane wrote down as evidence, each file up to [`FILE_MIB`].
pub(super) fn attached(blobs: &Blobs, spool: &Path) -> Result<Vec<Attachment>, StoreError> {
    attached_but(blobs, spool, &|unread| Err(unread))
}

/// Stores what a lane wrote down, without what cannot be read, which would keep the run open for ever. The spool stays then, for
/// whoever can read it.
pub(super) fn attached_as_can_be(blobs: &Blobs, spool: &Path) -> Result<Vec<Attachment>, StoreError> {
    // What an earlier try could not read may be read now.
    let _ = fs::remove_file(spool.join(UNREAD));
    attached_but(blobs, spool, &|unread| {
        tracing::warn!(
            "a record goes without what its lane wrote down: {}; {} stays for whoever can read it",
            Said::of(&unread),
            spool.display()
        );
        if let Err(error) = File::create(spool.join(UNREAD)) {
            tracing::warn!("{} may not stay: {error}; copy it now", spool.display());
        }
        Ok(())
    })
}

/// Like [`attached`], without what cannot be read, of which `unread` is told, unless that returns an error.
fn attached_but(
    blobs: &Blobs,
    spool: &Path,
    unread: &dyn Fn(BlobError) -> Result<(), BlobError>,
) -> Result<Vec<Attachment>, StoreError> {
    let mut attachments = Vec::new();
    let text = "text/plain; charset=utf-8";
    let told = [(EVENTS, "application/jsonl"), (LOG, text), (kept_frame::NOT_KEPT, text)];
    let told = told.map(|(name, media_type)| (name.to_owned(), media_type));
    let frames = match kept_frame::names(spool) {
        // A lane that was not started has no folder.
        Err(error) if error.kind() == io::ErrorKind::NotFound => Vec::new(),
        Err(source) => {
            unread(BlobError::Read { path: spool.to_owned(), source })?;
            Vec::new()
        }
        Ok(names) => names,
    };
    let frames = frames.into_iter().map(|name| (name, "image/png"));
    for (name, media_type) in told.into_iter().chain(frames) {
        let path = spool.join(&name);
        let bytes = match beginning(&path) {
            Ok(bytes) if bytes.is_empty() => continue,
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::NotFound => continue,
            Err(source) => {
                unread(BlobError::Read { path, source })?;
                continue;
            }
        };
        let sha256 = blobs.put(&bytes)?;
        let (bytes, media_type) = (bytes.len() as u64, media_type.to_owned());
        attachments.push(Attachment { name, sha256, bytes, media_type });
    }
    Ok(attachments)
}

/// The first bytes of a file, at most [`FILE_MIB`] of them.
fn beginning(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(FILE_MIB << 20).read_to_end(&mut bytes)?;
    Ok(bytes)
}
