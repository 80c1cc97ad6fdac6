//! The formats of tables on disk, which a file's name gives.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use halfrow_files::written_aside::WriteAsideError;
use thiserror::Error;

use super::{TableFile, mem};

/// The format of a table file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableFormat {
    /// NAME.json, for people and programs.
    Json,
    /// NAME.mem, which stands for two memory images, named by [`mem::paths`].
    Mem,
}

/// A file name that gives no format of tables.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{} names no format of tables; end it in .json, or in .mem for $readmemh", path.display())]
pub struct UnknownTableFormat {
    /// The name.
    pub path: PathBuf,
}

impl TableFormat {
    /// The format that the name's extension gives, in upper or lower case.
    ///
    /// # Errors
    /// [`UnknownTableFormat`] when it gives none.
    pub fn of(path: &Path) -> Result<Self, UnknownTableFormat> {
        let extension = path.extension().map(OsStr::to_ascii_lowercase).unwrap_or_default();
        match extension.to_str() {
            Some("json") => Ok(Self::Json),
            Some("mem") => Ok(Self::Mem),
            _ => Err(UnknownTableFormat { path: path.to_owned() }),
        }
    }

    /// The files that are written for `path`.
    #[must_use]
    pub fn places(self, path: &Path) -> Vec<PathBuf> {
        match self {
            Self::Json => vec![path.to_owned()],
            Self::Mem => mem::paths(path).into(),
        }
    }

    /// Writes `file` to [`Self::places`]. Memory images have no room for its notes.
    ///
    /// # Errors
    /// [`WriteAsideError`] when one of them exists and `overwrite` is false, or cannot be written.
    pub fn write(self, file: &TableFile, path: &Path, overwrite: bool) -> Result<(), WriteAsideError> {
        match self {
            Self::Json => file.write(path, overwrite),
            Self::Mem => mem::write(path, &file.tables, &file.kernel, overwrite).map(drop),
        }
    }
}
