//! Files of secrets, which nobody else may read.

use std::fs::{self, File, Permissions};
use std::io::{self, Write as _};
use std::os::unix::fs::{OpenOptionsExt as _, PermissionsExt as _};
use std::path::{Path, PathBuf};

use halfrow::frames::written_aside::{folder_of, sync_folder};
use serde::Serialize;
use serde::de::DeserializeOwned;
use tempfile::Builder;

/// A file of secrets that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum SecretError {
    /// It cannot be read or written.
    #[error("{} cannot be read or written; check its name, and who may read it", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// Others may read it.
    #[error("others may read {0}, which has secrets; run: chmod 600 {0}", path.display())]
    Open {
        /// The file.
        path: PathBuf,
    },
    /// It is not what it should be.
    #[error("{}: {what}; restore it from a copy", path.display())]
    Wrong {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
    /// The system has no randomness.
    #[error("the system has no randomness for a key; restart it")]
    NoRandomness(#[source] rand::rngs::SysError),
}

/// Makes a file that was not there, of one line, which nobody else may read: whole, or not at all.
pub(crate) fn create(path: &Path, line: &str) -> io::Result<()> {
    let mut aside = Builder::new().permissions(Permissions::from_mode(0o600)).tempfile_in(folder_of(path))?;
    writeln!(aside, "{line}")?;
    aside.as_file().sync_all()?;
    aside.persist_noclobber(path)?;
    sync_folder(folder_of(path))
}

/// The text of a file that nobody else may read.
pub(crate) fn text(path: &Path) -> Result<String, SecretError> {
    let refused = |source| SecretError::File { path: path.to_owned(), source };
    if fs::metadata(path).map_err(refused)?.permissions().mode() & 0o077 != 0 {
        return Err(SecretError::Open { path: path.to_owned() });
    }
    fs::read_to_string(path).map_err(refused)
}

/// Writes `secrets` to the file `path`, which nobody else may read, all or nothing; with `lasts`, a power cut does not take it back.
fn keep(path: &Path, secrets: &str, lasts: bool) -> Result<(), SecretError> {
    let write = || {
        let mut aside = PathBuf::from(path).into_os_string();
        aside.push(".new");
        let mut file = File::options().write(true).create(true).truncate(true).mode(0o600).open(&aside)?;
        file.write_all(secrets.as_bytes())?;
        if lasts {
            file.sync_all()?;
        }
        fs::rename(&aside, path)?;
        if lasts { sync_folder(folder_of(path)) } else { Ok(()) }
    };
    write().map_err(|source| SecretError::File { path: path.to_owned(), source })
}

/// What the TOML file `path` of secrets says.
pub(crate) fn read<T: DeserializeOwned>(path: &Path) -> Result<T, SecretError> {
    let wrong = |error: toml::de::Error| SecretError::Wrong {
        path: path.to_owned(),
        what: error.message().to_owned(),
    };
    toml::from_str(&text(path)?).map_err(wrong)
}

/// As [`read`]; what there is by default, if there is no file.
pub(crate) fn read_or_none<T: DeserializeOwned + Default>(path: &Path) -> Result<T, SecretError> {
    if path.exists() { read(path) } else { Ok(T::default()) }
}

/// Writes secrets to the TOML file `path`, as [`keep`] does.
pub(crate) fn write(path: &Path, secrets: &impl Serialize, lasts: bool) -> Result<(), SecretError> {
    let secrets = toml::to_string(secrets).map_err(io::Error::other);
    let secrets = secrets.map_err(|source| SecretError::File { path: path.to_owned(), source })?;
    keep(path, &secrets, lasts)
}
