//! Files that a call has read.

use std::path::{Path, PathBuf};

use crate::result::{FileHash, sha256};

/// A file that was read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Input {
    /// Its path. Unlike that of a [`FileHash`] it need not be text.
    pub path: PathBuf,
    /// SHA-256 of the bytes that were read from it.
    pub sha256: String,
}

impl Input {
    /// The file `path`, from which `bytes` were read. It may have changed since, so it is not read again.
    #[must_use]
    pub fn of_bytes(path: &Path, bytes: &[u8]) -> Self {
        Self { path: path.to_owned(), sha256: sha256([bytes]) }
    }
}

impl From<Input> for FileHash {
    fn from(input: Input) -> Self {
        Self { path: input.path.display().to_string(), sha256: input.sha256 }
    }
}
