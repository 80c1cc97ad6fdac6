//! Errors of which the system is the cause, and not the name that a call gives.

use std::io;

use nix::errno::Errno;

/// What to do so that the same call may succeed later, if it may: the disk was full, the device had a fault, or no file could be
/// opened because too many were.
#[must_use]
pub fn asked_of_system(error: &io::Error) -> Option<&'static str> {
    if matches!(error.kind(), io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded) {
        return Some("free some space there, then run again");
    }
    match Errno::from_i32(error.raw_os_error()?) {
        Errno::EIO => Some("look for a fault of the disk or device in the system's log, then run again"),
        Errno::EMFILE | Errno::ENFILE => Some("end other programs or allow more open files, then run again"),
        _ => None,
    }
}

/// Whether the same call may succeed later.
#[must_use]
pub fn is_of_system(error: &io::Error) -> bool {
    asked_of_system(error).is_some()
}
