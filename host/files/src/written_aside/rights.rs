//! Owner, group and mode of what is replaced. What replaces it gets them too, so that whoever had no access still has none.

use std::fs::{self, File, Permissions};
use std::io;
use std::os::unix::fs::{MetadataExt as _, PermissionsExt as _, fchown};
use std::path::Path;

/// Owner, group and mode of a file or folder.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rights {
    owner: u32,
    group: u32,
    mode: u32,
}

impl Rights {
    /// Those of what is at `path`; none if nothing is there.
    pub(super) fn of(path: &Path) -> Option<Self> {
        let there = fs::symlink_metadata(path).ok()?;
        // The owner must be able to write into the new folder.
        let needed = if there.is_dir() { 0o700 } else { 0 };
        Some(Self { owner: there.uid(), group: there.gid(), mode: there.mode() & 0o7777 | needed })
    }

    /// The mode to create something with before it gets these rights: nobody may open it in between who may not open it later.
    pub(super) fn mode(self) -> u32 {
        self.mode & 0o777
    }

    /// Gives these rights to what was `made`, as far as the system lets this user.
    ///
    /// # Errors
    /// The system's, when it refuses the mode.
    pub(super) fn give(self, made: &File) -> io::Result<()> {
        let Self { owner, group, mode } = self;
        // Only root may change the owner.
        let given = fchown(made, Some(owner), Some(group)).or_else(|_| fchown(made, None, Some(group)));
        // If the group is not the intended one, it gets only the rights of others.
        let mode = if given.is_ok() { mode } else { mode & !0o2070 | (mode & 0o007) << 3 };
        made.set_permissions(Permissions::from_mode(mode))
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::io::Write as _;
    use std::os::unix::fs::{MetadataExt as _, PermissionsExt as _, chown};

    use super::super::{Aside, write_aside};

    #[test]
    fn what_replaces_a_file_is_open_to_the_same_people() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        let write = |overwrite| write_aside(&path, overwrite, |out| out.write_all(b"text")).unwrap();
        write(false);
        // Only root may give a file to a group that it is not in.
        let group = if chown(&path, None, Some(54_321)).is_ok() {
            54_321
        } else {
            fs::metadata(&path).unwrap().gid()
        };
        for mode in [0o600, 0o664] {
            fs::set_permissions(&path, fs::Permissions::from_mode(mode)).unwrap();
            write(true);
            let mut stream = Aside::stream(&path, true).unwrap();
            let aside = stream.out.get_ref().path().to_owned();
            assert_eq!(fs::metadata(aside).unwrap().mode() & !mode & 0o777, 0, "more may read what is aside");
            stream.write_all(b"text").unwrap();
            stream.put_in_place().unwrap();
            let there = fs::metadata(&path).unwrap();
            assert_eq!((there.mode() & 0o7777, there.gid()), (mode, group), "{mode:o}");
        }
    }
}
