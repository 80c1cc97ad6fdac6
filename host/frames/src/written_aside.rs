//! Files that are whole or as they were: written aside in the same folder, then renamed into their place.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

/// Bytes that are written at once.
pub(crate) const BUFFER: usize = 1 << 17;

/// A file that could not be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteAsideError {
    /// The file is there and may not be replaced.
    #[error("{} exists; allow it to be overwritten, or name another file", path.display())]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// What is there is a folder, a device or the like, which a file must not replace.
    #[error("{} is no regular file; name a file, not a folder or a device", path.display())]
    NotAFile {
        /// What is there.
        path: PathBuf,
    },
    /// The system did not take the file.
    #[error("cannot write {}; check that its folder exists, is writable and has space", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
}

/// A file that is written but not in its place: it goes by another name in the same folder until [`Self::put_in_place`],
/// and is removed if that is never called.
#[derive(Debug)]
pub struct Aside {
    file: NamedTempFile,
    path: PathBuf,
    overwrite: bool,
}

impl Aside {
    /// A file for `path` with what `write` puts into it and the permissions of an ordinary file.
    ///
    /// # Errors
    /// As [`write_aside`].
    pub fn written(
        path: &Path,
        overwrite: bool,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<Self, WriteAsideError> {
        let path = destination(path, overwrite)?;
        match filled(folder(&path), write) {
            Ok(file) => Ok(Self { file, path, overwrite }),
            Err(source) => Err(WriteAsideError::Io { path, source }),
        }
    }

    /// Renames the file into its place, once its bytes are on the disk, and sees that the new name is too.
    ///
    /// # Errors
    /// [`WriteAsideError`] when the place has been taken meanwhile and may not be, or the system refuses.
    pub fn put_in_place(self) -> Result<(), WriteAsideError> {
        let Self { file, path, overwrite } = self;
        let placed = file.as_file().sync_all().and_then(|()| {
            let placed = if overwrite { file.persist(&path) } else { file.persist_noclobber(&path) };
            placed.map_err(|refused| refused.error)?;
            sync_folder(folder(&path))
        });
        placed.map_err(|source| match source.kind() {
            io::ErrorKind::AlreadyExists => WriteAsideError::Exists { path },
            _ => WriteAsideError::Io { path, source },
        })
    }
}

/// Writes the file `path` with what `write` puts into it. Whatever goes wrong, the file is whole or as it was. A link to a
/// file stays a link.
///
/// # Errors
/// [`WriteAsideError`] when `path` is no regular file, is there and `overwrite` is false, or cannot be written.
pub fn write_aside(
    path: &Path,
    overwrite: bool,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), WriteAsideError> {
    Aside::written(path, overwrite, write)?.put_in_place()
}

/// Whether the file `path` could be written, as far as can be told beforehand.
///
/// # Errors
/// As those of [`write_aside`].
pub fn check(path: &Path, overwrite: bool) -> Result<(), WriteAsideError> {
    let path = destination(path, overwrite)?;
    match fs::metadata(folder(&path)) {
        Ok(_) => Ok(()),
        Err(source) => Err(WriteAsideError::Io { path, source }),
    }
}

/// A temporary file in `folder` with what `write` puts into it.
fn filled(folder: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let file = builder.tempfile_in(folder)?;
    let mut out = BufWriter::with_capacity(BUFFER, file.as_file());
    write(&mut out)?;
    out.flush()?;
    drop(out);
    Ok(file)
}

/// Where a file for `path` belongs: where its link leads, if it is one.
fn destination(path: &Path, overwrite: bool) -> Result<PathBuf, WriteAsideError> {
    let path = path.to_owned();
    match fs::metadata(&path) {
        Ok(there) if !there.is_file() => Err(WriteAsideError::NotAFile { path }),
        Ok(_) if !overwrite => Err(WriteAsideError::Exists { path }),
        Ok(_) => fs::canonicalize(&path).map_err(|source| WriteAsideError::Io { path, source }),
        // Nothing is there, or whatever is wrong stops the file from being made.
        Err(_) => Ok(path),
    }
}

fn folder(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Brings the folder's names to the disk, where the file system knows how to.
#[cfg(unix)]
fn sync_folder(folder: &Path) -> io::Result<()> {
    match File::open(folder).and_then(|folder| folder.sync_all()) {
        Err(error) if matches!(error.kind(), io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported) => {
            Ok(())
        }
        synced => synced,
    }
}

#[cfg(not(unix))]
fn sync_folder(_: &Path) -> io::Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn write(path: &Path, overwrite: bool, text: &str) -> Result<(), WriteAsideError> {
        write_aside(path, overwrite, |out| out.write_all(text.as_bytes()))
    }

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    }

    #[test]
    fn a_file_that_is_there_is_replaced_only_when_it_may_be() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        write(&path, false, "first").unwrap();
        let refused = write(&path, false, "second").unwrap_err();
        assert!(matches!(&refused, WriteAsideError::Exists { path: named } if *named == path));
        assert!(refused.to_string().contains("allow it to be overwritten"));
        assert_eq!(fs::read_to_string(&path).unwrap(), "first");
        write(&path, true, "second").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "second");
        assert_eq!(names(folder.path()), ["a"]);
    }

    #[test]
    fn a_write_that_fails_leaves_the_old_file_and_no_other() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        write(&path, false, "first").unwrap();
        let failed = write_aside(&path, true, |out| {
            out.write_all(b"half a fi")?;
            Err(io::ErrorKind::StorageFull.into())
        });
        assert!(matches!(failed, Err(WriteAsideError::Io { .. })));
        assert_eq!(fs::read_to_string(&path).unwrap(), "first");
        assert_eq!(names(folder.path()), ["a"]);
    }

    #[test]
    fn a_place_that_was_taken_meanwhile_is_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        let aside = Aside::written(&path, false, |out| out.write_all(b"late")).unwrap();
        fs::write(&path, "early").unwrap();
        assert!(matches!(aside.put_in_place(), Err(WriteAsideError::Exists { .. })));
        assert_eq!(fs::read_to_string(&path).unwrap(), "early");
        assert_eq!(names(folder.path()), ["a"]);
    }

    #[test]
    fn a_folder_that_is_not_there_is_an_error_of_the_system() {
        let folder = tempfile::tempdir().unwrap();
        let refused = write(&folder.path().join("none/a"), true, "text").unwrap_err();
        let WriteAsideError::Io { path, source } = refused else { panic!("{refused}") };
        assert_eq!((path, source.kind()), (folder.path().join("none/a"), io::ErrorKind::NotFound));
    }

    #[test]
    fn a_folder_is_never_replaced() {
        let folder = tempfile::tempdir().unwrap();
        assert!(matches!(write(folder.path(), true, "text"), Err(WriteAsideError::NotAFile { .. })));
    }

    #[cfg(unix)]
    #[test]
    fn what_is_no_regular_file_is_never_replaced() {
        // A socket stands for a device: run as root, a broken check would replace a real one.
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("socket");
        let _socket = std::os::unix::net::UnixListener::bind(&path).unwrap();
        assert!(matches!(write(&path, true, "text"), Err(WriteAsideError::NotAFile { .. })));
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_a_link_and_its_file_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, "first").unwrap();
        std::os::unix::fs::symlink("file", &link).unwrap();
        write(&link, true, "second").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&file).unwrap(), "second");
    }

    #[cfg(unix)]
    #[test]
    fn the_permissions_are_those_of_an_ordinary_file() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let mode = |name| fs::metadata(folder.path().join(name)).unwrap().permissions().mode();
        write(&folder.path().join("aside"), false, "text").unwrap();
        fs::write(folder.path().join("ordinary"), "text").unwrap();
        assert_eq!(mode("aside"), mode("ordinary"));
    }
}
