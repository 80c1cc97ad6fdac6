//! Errors of which the system is the cause, and not the name that a call gives.

use std::io;

use nix::errno::Errno;

/// Whether the same call may succeed later: the disk was full, the device had a fault, or no file could be opened because too
/// many were.
#[must_use]
pub fn is_of_system(error: &io::Error) -> bool {
    let is_full = matches!(error.kind(), io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded);
    let number = error.raw_os_error().map(Errno::from_i32);
    is_full || matches!(number, Some(Errno::EIO | Errno::EMFILE | Errno::ENFILE))
}
