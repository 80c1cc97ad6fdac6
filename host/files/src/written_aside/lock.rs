//! Who is still at work: a file or folder under way is locked by its owner, and the system frees the lock when that
//! dies.

use std::fs::{self, File, Metadata, OpenOptions, TryLockError};
use std::io;
use std::os::unix::fs::{MetadataExt as _, OpenOptionsExt as _};
use std::path::Path;

use nix::fcntl::OFlag;

/// What came of trying a lock.
pub(super) enum Tried {
    /// It is ours until the file is dropped.
    Ours,
    /// A program that runs has it.
    Theirs,
    /// The file system has no locks.
    Unknown,
}

/// Tries the lock of an open file or folder.
pub(super) fn try_lock(file: &File) -> Tried {
    match file.try_lock() {
        Ok(()) => Tried::Ours,
        Err(TryLockError::WouldBlock) => Tried::Theirs,
        Err(TryLockError::Error(_)) => Tried::Unknown,
    }
}

/// Opens the file or folder `path` for its lock's sake. A link is not followed, and a FIFO not waited for.
pub(super) fn open(path: &Path) -> io::Result<File> {
    let flags = OFlag::O_NOFOLLOW | OFlag::O_NONBLOCK;
    OpenOptions::new().read(true).custom_flags(flags.bits()).open(path)
}

/// Whether `file` still goes by the name `path`, which whoever had the lock before may have removed.
pub(super) fn is_named(file: &File, path: &Path) -> bool {
    let same = |a: &Metadata, b: &Metadata| (a.dev(), a.ino()) == (b.dev(), b.ino());
    matches!((file.metadata(), fs::symlink_metadata(path)), (Ok(open), Ok(named)) if same(&open, &named))
}
