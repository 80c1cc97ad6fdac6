//! Where a command writes, checked before anything is done.

use std::path::Path;

use crate::call_error::CallError;
use crate::console;
use halfrow::call::{Files, FilesError};

/// Checks that `files` can be read and written as intended, and clears what killed runs left there. Says on stderr what is kept
/// of it.
pub(crate) fn prepare_files(files: &Files) -> Result<(), FilesError> {
    files.check()?;
    for kept in files.clear_leftovers() {
        console::diagnose(&format_args!(
            "note: what a run that was killed had recorded is kept in {}",
            kept.display()
        ));
    }
    Ok(())
}

/// Makes a folder and its parents.
pub(crate) fn make_folder(folder: &Path) -> Result<(), CallError> {
    std::fs::create_dir_all(folder)
        .map_err(|source| CallError::FolderNotMade { path: folder.to_owned(), source })
}
