//! Who is still at work: a file or folder under way is locked by the run that makes it, and the system frees the lock when that
//! run dies.

use std::fs::{self, File, Metadata, OpenOptions, TryLockError};
use std::io;
use std::os::unix::fs::{MetadataExt as _, OpenOptionsExt as _};
use std::path::Path;

use nix::fcntl::OFlag;

/// The result of trying a lock.
pub(super) enum Tried {
    /// It is ours until the file is dropped.
    Ours,
    /// A running program has it.
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

/// Opens the file or folder `path` in order to lock it. Does not follow a link, nor wait for a FIFO.
pub(super) fn open(path: &Path) -> io::Result<File> {
    let flags = OFlag::O_NOFOLLOW | OFlag::O_NONBLOCK;
    OpenOptions::new().read(true).custom_flags(flags.bits()).open(path)
}

/// Whether `file` still has the name `path`; the previous holder of the lock may have removed it.
pub(super) fn is_named(file: &File, path: &Path) -> bool {
    let same = |a: &Metadata, b: &Metadata| (a.dev(), a.ino()) == (b.dev(), b.ino());
    matches!((file.metadata(), fs::symlink_metadata(path)), (Ok(open), Ok(named)) if same(&open, &named))
}
