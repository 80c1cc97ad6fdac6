//! Renames that move nothing out of the way, and the one that swaps.

use std::io;
use std::path::Path;

use nix::errno::Errno;
use nix::fcntl::{RenameFlags, renameat2};

/// Renames a file or folder to a name that nothing has.
///
/// # Errors
/// `AlreadyExists` when something has it, or the system's reason.
pub(super) fn to_new(from: &Path, to: &Path) -> io::Result<()> {
    match renameat2(None, from, None, to, RenameFlags::RENAME_NOREPLACE) {
        Err(Errno::EINVAL | Errno::ENOSYS) => to_new_by_looking(from, to),
        renamed => Ok(renamed?),
    }
}

/// [`to_new`] where the file system cannot. Claims keep other runs of this program away between the two calls, where there are any.
fn to_new_by_looking(from: &Path, to: &Path) -> io::Result<()> {
    match std::fs::symlink_metadata(to) {
        Ok(_) => Err(io::ErrorKind::AlreadyExists.into()),
        Err(_) => std::fs::rename(from, to),
    }
}

/// Swaps two that are there. Whoever looks finds the one or the other.
///
/// # Errors
/// `Unsupported` when the file system cannot, or the system's reason.
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
