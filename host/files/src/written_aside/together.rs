//! Files that belong together: all of them are put in their places, or none is.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::under_way::{self, Noted};
use super::{Aside, WriteAsideError, check, place, rename, settle};

/// Puts all of these files in their places. If one of them is refused, what was in the places of the others comes back.
///
/// # Errors
/// That of [`Aside::put_in_place`] for the one that is refused. If what was in the place of another cannot come back, as on file
/// systems where names cannot be swapped, a warning names that place.
pub fn put_all_in_place(files: impl IntoIterator<Item = Aside>) -> Result<(), WriteAsideError> {
    let mut files: Vec<_> = files.into_iter().collect();
    // A disk may tell only then that it is full, when names that cannot be swapped would not come back.
    files.iter_mut().try_for_each(Aside::whole)?;
    let mut placed = Vec::new();
    for file in files {
        match Placed::by(file) {
            Ok(file) => placed.push(file),
            Err(error) => {
                placed.into_iter().rev().for_each(Placed::take_back);
                return Err(error);
            }
        }
    }
    placed.iter().for_each(|Placed { path, .. }| settle(path));
    Ok(())
}

/// A file that is in its place.
struct Placed {
    path: PathBuf,
    earlier: Earlier,
}

/// What was in the place before.
enum Earlier {
    Nothing,
    /// It has the name that the new file had aside.
    Aside(NamedTempFile, Noted),
    Lost,
}

impl Placed {
    /// Of a file that is whole.
    fn by(file: Aside) -> Result<Self, WriteAsideError> {
        let Aside { out, path, overwrite, _noted: noted, .. } = file;
        let mut aside = out.into_parts().0;
        if !overwrite {
            place(&mut aside, &path, false)?;
            return Ok(Self { path, earlier: Earlier::Nothing });
        }
        check(&path, true)?;
        match rename::swap(aside.path(), &path) {
            Ok(()) => Ok(Self { path, earlier: Earlier::Aside(aside, noted) }),
            Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::Unsupported) => {
                let earlier = if path.exists() { Earlier::Lost } else { Earlier::Nothing };
                place(&mut aside, &path, true)?;
                Ok(Self { path, earlier })
            }
            Err(source) => Err(WriteAsideError::Io { path, source }),
        }
    }

    fn take_back(self) {
        let Self { path, earlier } = self;
        let taken = match earlier {
            Earlier::Nothing => fs::remove_file(&path),
            Earlier::Aside(earlier, _noted) => bring_back(earlier, &path),
            Earlier::Lost => Err(io::ErrorKind::Unsupported.into()),
        };
        if let Err(error) = taken {
            tracing::warn!(path = %path.display(), %error, "it is the new one, and what belongs to it is not; write all of them again");
        }
    }
}

/// Puts the earlier file back into its place.
fn bring_back(mut file: NamedTempFile, path: &Path) -> io::Result<()> {
    let back = rename::swap(file.path(), path);
    if back.is_err() {
        let _ = under_way::spare(file.path(), path);
        file.disable_cleanup(true);
    }
    back
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAMES: [&str; 3] = ["a", "b", "c"];

    fn write(folder: &Path, overwrite: bool, text: &str) -> Vec<Aside> {
        let aside =
            |name| Aside::written(&folder.join(name), overwrite, |out| out.write_all(text.as_bytes()));
        NAMES.map(|name| aside(name).unwrap()).into()
    }

    fn texts(folder: &Path) -> Vec<(String, String)> {
        let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        let name = |path: &Path| path.file_name().unwrap().to_str().unwrap().to_owned();
        let mut texts: Vec<_> =
            entries.map(|path| (name(&path), fs::read_to_string(path).unwrap_or_default())).collect();
        texts.sort();
        texts
    }

    fn all(text: &str) -> Vec<(String, String)> {
        NAMES.map(|name| (name.to_owned(), text.to_owned())).into()
    }

    #[test]
    fn all_are_replaced_or_none_is() {
        let folder = tempfile::tempdir().unwrap();
        put_all_in_place(write(folder.path(), false, "first")).unwrap();
        assert_eq!(texts(folder.path()), all("first"));
        put_all_in_place(write(folder.path(), true, "second")).unwrap();
        assert_eq!(texts(folder.path()), all("second"));
        let third = write(folder.path(), true, "third");
        // A link that came meanwhile is in the way.
        let last = folder.path().join("c");
        fs::remove_file(&last).unwrap();
        std::os::unix::fs::symlink("nowhere", &last).unwrap();
        assert!(matches!(put_all_in_place(third), Err(WriteAsideError::Link { .. })));
        fs::remove_file(&last).unwrap();
        assert_eq!(texts(folder.path()), all("second")[..2]);
    }

    #[test]
    fn of_new_files_none_stays_when_one_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        for overwrite in [false, true] {
            let new = write(folder.path(), overwrite, "new");
            fs::create_dir(folder.path().join("c")).unwrap();
            put_all_in_place(new).unwrap_err();
            fs::remove_dir(folder.path().join("c")).unwrap();
            assert_eq!(texts(folder.path()), []);
        }
    }

    /// As on file systems where names cannot be swapped back.
    #[test]
    fn what_cannot_come_back_is_kept_under_another_name() {
        let folder = tempfile::tempdir().unwrap();
        let [place, other] = ["a", "other"].map(|name| folder.path().join(name));
        fs::write(&other, "earlier").unwrap();
        let file = tempfile::Builder::new().prefix("x").tempfile_in(folder.path()).unwrap();
        fs::rename(&other, file.path()).unwrap();
        bring_back(file, &place).unwrap_err();
        assert_eq!(texts(folder.path()), [("a.earlier".to_owned(), "earlier".to_owned())]);
    }
}
