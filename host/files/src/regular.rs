//! Inputs whose bytes can be looked at again.

use std::fs;
use std::path::{Path, PathBuf};

/// The input is a pipe or a device, whose bytes could not be looked at again later.
#[derive(Debug, thiserror::Error)]
#[error("{} is a pipe or a device, and its bytes could not be looked at again; write it to a file, and name that", path.display())]
pub struct NotRegular {
    /// The input.
    pub path: PathBuf,
}

/// Refuses a pipe, which may also never begin, and a device: nobody could compare the hash of what was read with the file
/// later. A missing file and a folder pass, since whoever reads them says what is wrong.
///
/// # Errors
/// [`NotRegular`].
pub fn check_regular(path: &Path) -> Result<(), NotRegular> {
    match fs::metadata(path) {
        Ok(about) if !about.is_file() && !about.is_dir() => Err(NotRegular { path: path.to_owned() }),
        _ => Ok(()),
    }
}
