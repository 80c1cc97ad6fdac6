//! Checking a place before anything is written to it.

use std::fs;
use std::io;
use std::os::unix::ffi::OsStrExt as _;
use std::os::unix::fs::MetadataExt as _;
use std::path::{Component, Path, PathBuf};

use super::{WriteAsideError, folder_of, under_way};

/// Checks that a file may be written to `path` as things stand. [`check_folder`] checks its folder.
///
/// # Errors
/// [`WriteAsideError`] when it is a link or not a regular file, or its name could be only a folder's, or it exists and `overwrite`
/// is false.
pub fn check(path: &Path, overwrite: bool) -> Result<(), WriteAsideError> {
    let path = path.to_owned();
    if path.as_os_str().is_empty() {
        // As the folder that an empty path means, since a message could not show it.
        return Err(WriteAsideError::NotAFile { path: ".".into() });
    }
    if names_a_folder(&path) {
        return Err(WriteAsideError::NotAFile { path });
    }
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

/// Whether only a folder can have that name, be it there or not.
fn names_a_folder(path: &Path) -> bool {
    let name = path.as_os_str().as_bytes();
    path.file_name().is_none() || name.ends_with(b"/") || name.ends_with(b"/.")
}

/// Checks that files can be made in `folder`. If it does not exist and `may_be_made`, checks that it could be made.
///
/// # Errors
/// The system's reason.
pub fn check_folder(folder: &Path, may_be_made: bool) -> io::Result<()> {
    match fs::metadata(folder) {
        // Only trying it shows quotas, read-only mounts, and folders that cannot have files.
        Ok(_) => under_way::file(folder, None, None).map(drop),
        Err(error) if error.kind() == io::ErrorKind::NotFound && may_be_made && !is_link(folder) => {
            check_folder(folder_of(folder), true)
        }
        Err(error) => Err(error),
    }
}

fn is_link(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|there| there.is_symlink())
}

/// A place, however it is named: two paths that lead to the same file or folder, or would, are the same place.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Place(Identity);

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
enum Identity {
    /// Device and inode of what is there.
    Taken(u64, u64),
    /// Device and inode of the nearest folder that exists, and the path in it.
    Free(u64, u64, PathBuf),
    /// No folder on the path exists.
    Nowhere(PathBuf),
}

impl Place {
    /// Where `path` leads.
    #[must_use]
    pub fn of(path: &Path) -> Self {
        if let Ok(there) = fs::metadata(path) {
            return Self(Identity::Taken(there.dev(), there.ino()));
        }
        let path = resolved(path);
        let within = |above: &Path| {
            let folder = fs::metadata(above).ok()?;
            let rest = path.strip_prefix(above).ok()?.to_owned();
            Some(Identity::Free(folder.dev(), folder.ino(), rest))
        };
        Self(path.ancestors().skip(1).find_map(within).unwrap_or(Identity::Nowhere(path)))
    }

    /// Whether `path` leads here, or to something inside.
    #[must_use]
    pub fn holds(&self, path: &Path) -> bool {
        resolved(path).ancestors().any(|above| Self::of(above) == *self)
    }
}

/// `path` from the root on, without links and `..`; folders that do not exist count as if they were made.
fn resolved(path: &Path) -> PathBuf {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let mut resolved = PathBuf::new();
    for step in path.components() {
        if step == Component::ParentDir {
            resolved.pop();
        } else {
            resolved.push(step);
        }
        if let Ok(there) = resolved.canonicalize() {
            resolved = there;
        }
    }
    resolved
}

#[cfg(test)]
mod tests {
    use std::os::unix::fs::symlink;

    use super::*;

    #[test]
    fn a_name_that_only_a_folder_can_have_is_refused_for_a_file() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("file"), "").unwrap();
        for name in ["new/", "new/.", "new/..", "new//", "file/"] {
            let refused = check(&folder.path().join(name), true);
            assert!(matches!(refused, Err(WriteAsideError::NotAFile { .. })), "{name}: {refused:?}");
        }
        let refused = check(Path::new(""), true).unwrap_err();
        assert_eq!(refused.to_string(), ". is no regular file; name a file, not a folder or a device");
        check(&folder.path().join("./new"), true).unwrap();
        check(&folder.path().join("new."), true).unwrap();
    }

    #[test]
    fn names_of_one_place_are_one_place_whether_it_is_there_or_not() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        symlink(".", at("same")).unwrap();
        let names =
            ["new/a.png", "same/new/a.png", "new/./a.png", "made/../new/a.png", "same/made/../new/a.png"];
        let all = || names.map(|name| Place::of(&at(name)));
        assert_eq!(all(), names.map(|_| Place::of(&at(names[0]))));
        assert_ne!(Place::of(&at("new/b.png")), Place::of(&at("new/a.png")));
        assert_ne!(Place::of(&at("a.png")), Place::of(&at("new/a.png")));
        fs::create_dir_all(at("made/x")).unwrap();
        fs::create_dir(at("new")).unwrap();
        fs::write(at("new/a.png"), "").unwrap();
        assert_eq!(all(), names.map(|_| Place::of(&at(names[0]))));
    }

    #[test]
    fn what_lies_beside_a_folder_is_not_in_it_and_what_leads_into_it_is() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("out")).unwrap();
        fs::write(at("out/inside"), "").unwrap();
        symlink("out/inside", at("link")).unwrap();
        let out = Place::of(&at("out"));
        let held =
            ["out", "out/inside", "out/new/one", "link", "out/../out/inside", "out/../beside", "beside"];
        assert_eq!(held.map(|name| out.holds(&at(name))), [true, true, true, true, true, false, false]);
    }
}
