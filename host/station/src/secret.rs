//! Files of secrets, which nobody else may read.

use std::fs::{self, File, Metadata, Permissions};
use std::io::{self, Write as _};
use std::os::unix::fs::{MetadataExt as _, PermissionsExt as _};
use std::path::{Path, PathBuf};

use halfrow::files::text::{MAX_BYTES, read as read_text};
use halfrow::files::written_aside::{Claim, folder_of, sync_folder};
use nix::unistd::{getegid, geteuid};
use serde::Serialize;
use serde::de::DeserializeOwned;
use tempfile::{Builder, NamedTempFile, PersistError};

/// A file of secrets that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum SecretError {
    /// A file with a secret of the station's cannot be read or written.
    #[error("{} cannot be read or written; check its name, and who may read it", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The file that should hold a secret is a folder.
    #[error("{} is a folder, and no file with a secret; name that file", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
    },
    /// Other users may read a file of secrets that the station itself wrote.
    #[error("others may read {0}, which has secrets; run: chmod 600 {0}", path.display())]
    Open {
        /// The file.
        path: PathBuf,
    },
    /// Other users may read a file of secrets that the station was given.
    #[error(
        "others may read {0}, which has a secret; run as the station's user: chmod 600 {0}, or as root, with the station's \
         group: chown root:GROUP {0} && chmod 640 {0}", path.display()
    )]
    GivenOpen {
        /// The file.
        path: PathBuf,
    },
    /// The file that should hold a secret is empty.
    #[error("{} is empty; write the token or the password into it", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// A file of secrets does not hold what it should.
    #[error("{}: {what}; restore it from a copy", path.display())]
    Wrong {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
    /// The system gave no random bytes for a key.
    #[error("the system has no randomness for a key; restart it")]
    NoRandomness(#[source] rand::rngs::SysError),
}

/// Writes a file that nobody else may read, completely or not at all; with `lasts` it survives a power cut. `persist` is what puts it
/// in its place.
fn put<'a>(
    path: &'a Path,
    text: &str,
    lasts: bool,
    persist: impl FnOnce(NamedTempFile, &'a Path) -> Result<File, PersistError>,
) -> io::Result<()> {
    let mut aside = Builder::new().permissions(Permissions::from_mode(0o600)).tempfile_in(folder_of(path))?;
    aside.write_all(text.as_bytes())?;
    if lasts {
        aside.as_file().sync_all()?;
    }
    persist(aside, path)?;
    if lasts { sync_folder(folder_of(path)) } else { Ok(()) }
}

/// Creates a new file of one line, like [`put`].
pub(crate) fn create(path: &Path, line: &str) -> io::Result<()> {
    put(path, &format!("{line}\n"), true, NamedTempFile::persist_noclobber)
}

/// The text of a file that the station writes itself, and that nobody else may read.
pub(crate) fn own(path: &Path) -> Result<String, SecretError> {
    if is_open(about(path)?.mode()) {
        return Err(SecretError::Open { path: path.to_owned() });
    }
    fs::read_to_string(path).map_err(unusable(path))
}

/// The error of a file of secrets, by the system's reason.
fn unusable(path: &Path) -> impl FnOnce(io::Error) -> SecretError {
    |source| SecretError::File { path: path.to_owned(), source }
}

/// What the system says of a file of secrets.
fn about(path: &Path) -> Result<Metadata, SecretError> {
    match fs::metadata(path) {
        Ok(about) if about.is_dir() => Err(SecretError::Folder { path: path.to_owned() }),
        about => about.map_err(unusable(path)),
    }
}

/// The text of a file that the station is given, such as a token. Only the station may read it, and root, who may own it.
pub(crate) fn text(path: &Path) -> Result<String, SecretError> {
    if !Rights::of(&about(path)?).is_closed(geteuid().as_raw(), getegid().as_raw()) {
        return Err(SecretError::GivenOpen { path: path.to_owned() });
    }
    let text = read_text(path, MAX_BYTES).map_err(unusable(path))?;
    if text.trim().is_empty() { Err(SecretError::Empty { path: path.to_owned() }) } else { Ok(text) }
}

/// Whether a file of this mode is open to its group or to all.
fn is_open(mode: u32) -> bool {
    mode & 0o077 != 0
}

/// Who may do what with a file.
struct Rights {
    mode: u32,
    owner: u32,
    group: u32,
}

impl Rights {
    fn of(about: &Metadata) -> Self {
        Self { mode: about.mode(), owner: about.uid(), group: about.gid() }
    }

    /// Whether nobody else may read it; `user` and `group` are those of this process. As is usual on Debian, a file of root may
    /// be readable by its group: by ours, or if we are root by any, because root chose it.
    fn is_closed(&self, user: u32, group: u32) -> bool {
        let is_for_group = self.mode & 0o037 == 0 && self.owner == 0 && (self.group == group || user == 0);
        !is_open(self.mode) || is_for_group
    }
}

/// The content of the TOML file `path` of secrets.
pub(crate) fn read<T: DeserializeOwned>(path: &Path) -> Result<T, SecretError> {
    let wrong = |error: toml::de::Error| SecretError::Wrong {
        path: path.to_owned(),
        what: error.message().to_owned(),
    };
    toml::from_str(&own(path)?).map_err(wrong)
}

/// Like [`read`]; the default if there is no file.
pub(crate) fn read_or_none<T: DeserializeOwned + Default>(path: &Path) -> Result<T, SecretError> {
    match read(path) {
        Err(SecretError::File { source, .. }) if source.kind() == io::ErrorKind::NotFound => Ok(T::default()),
        found => found,
    }
}

/// Changes the content of the TOML file `path` of secrets, which may not exist yet. Whoever changes it at the same time waits, so
/// that no change is lost.
pub(crate) fn change<T, R, E>(path: &Path, change: impl FnOnce(&mut T) -> Result<R, E>) -> Result<R, E>
where
    T: DeserializeOwned + Serialize + Default,
    E: From<SecretError>,
{
    let refused = |error| SecretError::File { path: path.to_owned(), source: io::Error::other(error) };
    let _turn = Claim::wait(path).map_err(refused)?;
    let mut content: T = read_or_none(path)?;
    let changed = change(&mut content)?;
    write(path, &content, true)?;
    Ok(changed)
}

/// Writes secrets to the TOML file `path`, like [`put`].
pub(crate) fn write(path: &Path, secrets: &impl Serialize, lasts: bool) -> Result<(), SecretError> {
    let text = toml::to_string(secrets).map_err(io::Error::other);
    text.and_then(|text| put(path, &text, lasts, NamedTempFile::persist)).map_err(unusable(path))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_given_is_for_the_station_alone_or_by_its_group_where_it_is_roots() {
        let cases = [
            (0o100_600, 998, 998, true),
            (0o100_400, 0, 0, true),
            (0o100_640, 0, 998, true),
            (0o100_440, 0, 998, true),
            // Not owned by root; writable by the group; readable by all; of another group.
            (0o100_640, 998, 998, false),
            (0o100_660, 0, 998, false),
            (0o100_644, 0, 998, false),
            (0o100_640, 0, 100, false),
        ];
        for (mode, owner, group, expected) in cases {
            let rights = Rights { mode, owner, group };
            assert_eq!(rights.is_closed(998, 998), expected, "{mode:o} {owner}:{group}");
        }
        // As root, who prepares a plant for a station.
        let rights = |mode| Rights { mode, owner: 0, group: 998 };
        assert_eq!([0o640, 0o644].map(|mode| rights(mode).is_closed(0, 0)), [true, false]);
    }

    #[test]
    fn an_empty_file_is_no_secret() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mes.token");
        create(&path, "").unwrap();
        assert!(matches!(text(&path), Err(SecretError::Empty { .. })));
        fs::write(&path, "A17\n").unwrap();
        assert_eq!(text(&path).unwrap(), "A17\n");
        fs::set_permissions(&path, Permissions::from_mode(0o644)).unwrap();
        assert!(matches!(text(&path), Err(SecretError::GivenOpen { .. })));
    }
}
