//! Renaming to a name that is free, and swapping two names.

use std::io;
use std::path::Path;

use nix::errno::Errno;
use nix::fcntl::{RenameFlags, renameat2};

/// Renames a file or folder to a name that must be free.
///
/// # Errors
/// `AlreadyExists` when something has it, or the system's reason.
pub(super) fn to_new(from: &Path, to: &Path) -> io::Result<()> {
    match renameat2(None, from, None, to, RenameFlags::RENAME_NOREPLACE) {
        Err(Errno::EINVAL | Errno::ENOSYS) => to_new_by_looking(from, to),
        renamed => Ok(renamed?),
    }
}

/// [`to_new`] on a file system that cannot do it in one step. Where claims are held, they keep other runs of this program away
/// between the two calls.
fn to_new_by_looking(from: &Path, to: &Path) -> io::Result<()> {
    match std::fs::symlink_metadata(to) {
        Ok(_) => Err(io::ErrorKind::AlreadyExists.into()),
        Err(_) => std::fs::rename(from, to),
    }
}

/// Swaps two existing names. At every moment each name has one of the two.
///
/// # Errors
/// `Unsupported` when the file system cannot do this, or the system's reason.
pub(super) fn swap(one: &Path, other: &Path) -> io::Result<()> {
    match renameat2(None, one, None, other, RenameFlags::RENAME_EXCHANGE) {
        Err(Errno::EINVAL | Errno::ENOSYS) => Err(io::ErrorKind::Unsupported.into()),
        swapped => Ok(swapped?),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_way_of_renaming_takes_a_name_that_something_has() {
        let folder = tempfile::tempdir().unwrap();
        let [new, old] = ["new", "old"].map(|name| folder.path().join(name));
        for rename in [to_new, to_new_by_looking] {
            std::fs::create_dir(&new).unwrap();
            std::fs::create_dir(&old).unwrap();
            // A plain rename replaces an empty folder.
            assert_eq!(rename(&new, &old).unwrap_err().kind(), io::ErrorKind::AlreadyExists);
            std::fs::remove_dir(&old).unwrap();
            rename(&new, &old).unwrap();
            std::fs::remove_dir(&old).unwrap();
        }
    }
}
