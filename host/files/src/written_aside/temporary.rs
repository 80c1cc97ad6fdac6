//! A folder of our own that is removed when it is not needed any more.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A folder that is removed when this is dropped, with everything in it. If it cannot be, a warning names it.
#[derive(Debug)]
pub(super) struct Temporary {
    path: PathBuf,
    stays: bool,
}

impl Temporary {
    /// A folder that was made just now.
    pub(super) fn new(path: PathBuf) -> Self {
        Self { path, stays: false }
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    pub(super) fn keep(mut self) {
        self.stays = true;
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        let Self { path, stays: false } = self else { return };
        // To look into it takes a descriptor, which this process may have run out of. An empty one is removed without.
        let removed = fs::remove_dir(&*path).or_else(|_| fs::remove_dir_all(&*path));
        if let Err(error) = removed
            && error.kind() != io::ErrorKind::NotFound
        {
            tracing::warn!(path = %path.display(), %error, "it cannot be removed, and is not needed any more; remove it");
        }
    }
}
