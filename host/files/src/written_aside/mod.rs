//! Outputs that are whole or as before: written aside in the same folder, then renamed into their place.
//!
//! What is aside has a name of our own and is locked. So a run can tell what killed runs left from what running ones write, and
//! clears it ([`clear`]).

mod claim;
mod error;
mod folder;
mod lock;
mod place;
mod rename;
mod rights;
mod temporary;
mod together;
mod under_way;

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

pub use claim::Claim;
pub use error::{Unfinished, WriteAsideError};
pub use folder::{AsideFolder, Misplaced};
pub use place::{Place, check, check_folder};
use rights::Rights;
pub use together::put_all_in_place;
pub use under_way::{Abandoned, abandon_all, clear, clear_older};

/// Bytes that are written at once: writes of whole multiples of it are handed on as they are.
pub const BUFFER: usize = 1 << 17;

/// Like [`BUFFER`], for streams.
const STREAM_BUFFER: usize = 1 << 13;

/// A file that is written but not yet in its place: it has another name in the same folder until [`Self::put_in_place`],
/// and is removed if that is never called.
#[derive(Debug)]
pub struct Aside {
    out: BufWriter<NamedTempFile>,
    path: PathBuf,
    overwrite: bool,
    /// Held until the file is in its place, so that two runs that may not overwrite cannot both begin.
    _claim: Option<Claim>,
    _noted: under_way::Noted,
}

impl Aside {
    /// A file for `path` with what `write` puts into it. It has the rights of the file that it replaces, or ordinary ones.
    ///
    /// # Errors
    /// Like [`write_aside`].
    pub fn written(
        path: &Path,
        overwrite: bool,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<Self, WriteAsideError> {
        check(path, overwrite)?;
        let mut aside = Self::begun(path, overwrite, None, None)?;
        match write(&mut aside.out).and_then(|()| aside.out.flush()) {
            Ok(()) => Ok(aside),
            Err(source) => Err(WriteAsideError::Io { path: path.to_owned(), source }),
        }
    }

    /// A file for `path` that grows for as long as a run takes, and that is worth keeping even if it is incomplete. No other
    /// run may begin a file of that name meanwhile, unless either may overwrite.
    ///
    /// # Errors
    /// Like [`write_aside`].
    pub fn stream(path: &Path, overwrite: bool) -> Result<Self, WriteAsideError> {
        check(path, overwrite)?;
        let claim = if overwrite { None } else { Some(Claim::take(path)?) };
        // The previous holder of the claim may have put its file in place.
        check(path, overwrite)?;
        Self::begun(path, overwrite, path.file_name(), claim)
    }

    fn begun(
        path: &Path,
        overwrite: bool,
        kept_for: Option<&std::ffi::OsStr>,
        claim: Option<Claim>,
    ) -> Result<Self, WriteAsideError> {
        let rights = if overwrite { Rights::of(path) } else { None };
        let (file, noted) = under_way::file(folder_of(path), kept_for, rights)
            .map_err(|source| WriteAsideError::Io { path: path.to_owned(), source })?;
        // What is worth keeping should reach the file soon.
        let capacity = if kept_for.is_some() { STREAM_BUFFER } else { BUFFER };
        let out = BufWriter::with_capacity(capacity, file);
        Ok(Self { out, path: path.to_owned(), overwrite, _claim: claim, _noted: noted })
    }

    /// Brings the bytes of the file to the disk, renames it into its place, and tries to bring the new name to the disk too.
    ///
    /// # Errors
    /// [`WriteAsideError`] when something has taken the place meanwhile and may not be replaced, or the system refuses.
    pub fn put_in_place(self) -> Result<(), WriteAsideError> {
        let path = self.path.clone();
        self.rename_into_place()?;
        settle(&path);
        Ok(())
    }

    /// Like [`Self::put_in_place`], for a caller that brings the new name to the disk itself because it must know when that
    /// fails.
    ///
    /// # Errors
    /// Like [`Self::put_in_place`].
    pub fn rename_into_place(mut self) -> Result<(), WriteAsideError> {
        let written = self.whole();
        let Self { out, path, overwrite, .. } = self;
        let mut file = out.into_parts().0;
        written.and_then(|()| place(&mut file, &path, overwrite))
    }

    /// Like [`Self::put_in_place`], but on an error keeps what there is under a name that is free.
    ///
    /// # Errors
    /// [`Unfinished`] where [`Self::put_in_place`] has an error.
    pub fn put_in_place_or_keep(mut self) -> Result<(), Unfinished> {
        let written = self.whole();
        let Self { out, path, overwrite, .. } = self;
        let mut file = out.into_parts().0;
        let placed = written.and_then(|()| place(&mut file, &path, overwrite));
        placed.map_err(|source| unfinished(file, &path, source))?;
        settle(&path);
        Ok(())
    }

    /// Keeps what there is under a name that is free, because writing failed with `source`.
    #[must_use]
    pub fn keep_unfinished(self, source: io::Error) -> Unfinished {
        let source = WriteAsideError::Io { path: self.path.clone(), source };
        unfinished(self.out.into_parts().0, &self.path, source)
    }

    fn whole(&mut self) -> Result<(), WriteAsideError> {
        let written = self.out.flush().and_then(|()| self.out.get_ref().as_file().sync_all());
        written.map_err(|source| WriteAsideError::Io { path: self.path.clone(), source })
    }
}

fn unfinished(file: NamedTempFile, path: &Path, source: WriteAsideError) -> Unfinished {
    let kept = keep(file).and_then(|kept| Some(path.with_file_name(kept.file_name()?)));
    Unfinished { kept, source }
}

impl Write for Aside {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.out.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

/// Writes the file `path` with what `write` puts into it. Whatever goes wrong, the file is whole or as before.
///
/// # Errors
/// [`WriteAsideError`] when `path` is a link or not a regular file, exists and `overwrite` is false, or cannot be written.
pub fn write_aside(
    path: &Path,
    overwrite: bool,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), WriteAsideError> {
    Aside::written(path, overwrite, write)?.put_in_place()
}

/// Renames a file into its place.
fn place(file: &mut NamedTempFile, path: &Path, overwrite: bool) -> Result<(), WriteAsideError> {
    if overwrite {
        check(path, true)?;
    }
    let renamed = if overwrite { fs::rename(file.path(), path) } else { rename::to_new(file.path(), path) };
    let path = path.to_owned();
    match renamed {
        Ok(()) => {
            // It has its final name by now, and must not be removed on drop.
            file.disable_cleanup(true);
            Ok(())
        }
        Err(source) if source.kind() == io::ErrorKind::AlreadyExists => Err(WriteAsideError::Exists { path }),
        Err(source) => Err(WriteAsideError::Io { path, source }),
    }
}

/// Keeps what there is of a file, and returns its path; none if it is empty or gone.
fn keep(file: NamedTempFile) -> Option<PathBuf> {
    if file.as_file().metadata().is_ok_and(|about| about.len() == 0) {
        return None;
    }
    let (_file, path) = file.keep().ok()?;
    // It may have gone with its folder.
    Some(under_way::kept(&path).unwrap_or(path)).filter(|kept| kept.exists())
}

/// The folder that contains `path`.
#[must_use]
pub fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Makes the name of a file that is whole and in its place last through a power cut. A failure here leaves the file as it is.
fn settle(path: &Path) {
    if let Err(error) = sync_folder(folder_of(path)) {
        tracing::warn!(path = %path.display(), %error, "it is written, and a power cut may take it away again");
    }
}

/// Makes the names in `folder` last through a power cut, if its file system can do that and the folder may be opened.
///
/// # Errors
/// The system's reason.
pub fn sync_folder(folder: &Path) -> io::Result<()> {
    use io::ErrorKind::{InvalidInput, PermissionDenied, Unsupported};
    match File::open(folder).and_then(|folder| folder.sync_all()) {
        Err(error) if matches!(error.kind(), InvalidInput | PermissionDenied | Unsupported) => {
            tracing::info!(folder = %folder.display(), %error, "its names are not brought to the disk at once");
            Ok(())
        }
        synced => synced,
    }
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
    fn a_link_that_came_meanwhile_is_not_replaced_either() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        let aside = Aside::written(&path, true, |out| out.write_all(b"late")).unwrap();
        std::os::unix::fs::symlink("elsewhere", &path).unwrap();
        assert!(matches!(aside.put_in_place(), Err(WriteAsideError::Link { .. })));
        assert_eq!(fs::read_link(&path).unwrap(), Path::new("elsewhere"));
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

    #[test]
    fn what_is_no_regular_file_is_never_replaced() {
        // A socket serves as the device: run as root, a broken check would replace a real device.
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("socket");
        let _socket = std::os::unix::net::UnixListener::bind(&path).unwrap();
        assert!(matches!(write(&path, true, "text"), Err(WriteAsideError::NotAFile { .. })));
    }

    #[test]
    fn a_link_is_never_written_through_nor_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, "first").unwrap();
        for to in ["file", "nowhere"] {
            std::os::unix::fs::symlink(to, &link).unwrap();
            let refused = write(&link, true, "second").unwrap_err();
            assert!(matches!(&refused, WriteAsideError::Link { .. }), "{refused}");
            assert!(refused.to_string().contains(&format!("link is a link to {to}")), "{refused}");
            assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
            fs::remove_file(&link).unwrap();
        }
        assert_eq!(fs::read_to_string(&file).unwrap(), "first");
    }

    #[test]
    fn the_permissions_are_those_of_an_ordinary_file() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let mode = |name| fs::metadata(folder.path().join(name)).unwrap().permissions().mode();
        write(&folder.path().join("aside"), false, "text").unwrap();
        fs::write(folder.path().join("ordinary"), "text").unwrap();
        assert_eq!(mode("aside"), mode("ordinary"));
    }

    #[test]
    fn a_stream_of_nothing_is_not_kept() {
        let folder = tempfile::tempdir().unwrap();
        let aside = Aside::stream(&folder.path().join("a"), true).unwrap();
        let unfinished = aside.keep_unfinished(io::ErrorKind::StorageFull.into());
        assert_eq!((unfinished.kept, names(folder.path()).len()), (None, 0));
    }

    #[test]
    fn what_went_with_its_folder_is_not_said_to_be_kept() {
        let folder = tempfile::tempdir().unwrap();
        for is_gone in [false, true] {
            let place = folder.path().join("place");
            fs::create_dir(&place).unwrap();
            let mut aside = Aside::stream(&place.join("a"), true).unwrap();
            aside.write_all(b"half a stream").unwrap();
            aside.flush().unwrap();
            if is_gone {
                fs::remove_dir_all(&place).unwrap();
            }
            let unfinished = aside.keep_unfinished(io::ErrorKind::StorageFull.into());
            assert_eq!(unfinished.kept, (!is_gone).then(|| place.join("a.partial")));
            let _ = fs::remove_dir_all(&place);
        }
    }

    #[test]
    fn what_is_kept_of_a_long_name_tells_which_it_was() {
        let folder = tempfile::tempdir().unwrap();
        for first in ["a", "b"] {
            let mut aside = Aside::stream(&folder.path().join(first.repeat(240)), true).unwrap();
            aside.write_all(b"half a stream").unwrap();
            aside.flush().unwrap();
            let _ = aside.keep_unfinished(io::ErrorKind::StorageFull.into());
        }
        let mut kept = names(folder.path());
        kept.sort_unstable();
        assert_eq!(kept, ["a", "b"].map(|first| first.repeat(200) + ".partial"));
    }
}
