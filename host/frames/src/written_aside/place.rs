//! Looking at a place before anything is written to it.

use std::ffi::OsString;
use std::fs;
use std::io;
use std::os::unix::fs::MetadataExt as _;
use std::path::{Path, PathBuf};

use super::{WriteAsideError, folder_of, under_way};

/// Whether a file may go to `path` as things are there. Its folder is [`check_folder`]'s.
///
/// # Errors
/// [`WriteAsideError`] when it is a link or no regular file, or is there and `overwrite` is false.
pub fn check(path: &Path, overwrite: bool) -> Result<(), WriteAsideError> {
    let path = path.to_owned();
    let there = match fs::symlink_metadata(&path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(source) => return Err(WriteAsideError::Io { path, source }),
        Ok(there) => there,
    };
    if there.is_symlink() {
        let to = fs::read_link(&path).unwrap_or_default();
        Err(WriteAsideError::Link { path, to })
    } else if !there.is_file() {
        Err(WriteAsideError::NotAFile { path })
    } else if !overwrite {
        Err(WriteAsideError::Exists { path })
    } else {
        Ok(())
    }
}

/// Whether `folder` takes files, or, where it is not there and `may_be_made`, whether it could be made.
///
/// # Errors
/// The system's reason.
pub fn check_folder(folder: &Path, may_be_made: bool) -> io::Result<()> {
    match fs::metadata(folder) {
        // Only the system knows of quotas, of read-only mounts, and of folders that have no files.
        Ok(_) => under_way::file(folder, None).map(drop),
        Err(error) if error.kind() == io::ErrorKind::NotFound && may_be_made && !is_link(folder) => {
            check_folder(folder_of(folder), true)
        }
        Err(error) => Err(error),
    }
}

fn is_link(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|there| there.is_symlink())
}

/// Clears `folder` of what runs that were killed left in it. Of streams that are worth keeping, what there is goes by a
/// name that nothing else has, which is returned.
#[must_use]
pub fn clear(folder: &Path) -> Vec<PathBuf> {
    under_way::clean(folder)
}

/// A place, however it is named: two paths that lead to the same file or folder, or would, are one.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Place(Identity);

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
enum Identity {
    /// Device and inode of what is there.
    Taken(u64, u64),
    /// Device and inode of the folder, and the name in it.
    Free(u64, u64, OsString),
    /// Not even the folder is there.
    Nowhere(PathBuf),
}

impl Place {
    /// Where `path` leads.
    #[must_use]
    pub fn of(path: &Path) -> Self {
        if let Ok(there) = fs::metadata(path) {
            return Self(Identity::Taken(there.dev(), there.ino()));
        }
        Self(match (fs::metadata(folder_of(path)), path.file_name()) {
            (Ok(folder), Some(name)) => Identity::Free(folder.dev(), folder.ino(), name.to_owned()),
            _ => Identity::Nowhere(std::path::absolute(path).unwrap_or_else(|_| path.to_owned())),
        })
    }

    /// Whether `path` leads here, or to something inside.
    #[must_use]
    pub fn holds(&self, path: &Path) -> bool {
        let above = path.ancestors().filter(|above| !above.as_os_str().is_empty());
        above.map(Self::of).any(|above| above == *self)
    }
}
