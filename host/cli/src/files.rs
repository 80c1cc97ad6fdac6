//! Making the folder that a command writes into.

use std::path::Path;

use crate::call_error::CallError;

/// Makes a folder and its parents.
pub(crate) fn make_folder(folder: &Path) -> Result<(), CallError> {
    std::fs::create_dir_all(folder)
        .map_err(|source| CallError::FolderNotMade { path: folder.to_owned(), source })
}
