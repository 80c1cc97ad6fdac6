//! Where a command writes, looked at before anything is done.

use std::path::Path;

use super::CallError;
use crate::console;
use halfrow::call::{Files, FilesError};

/// Whether `files` can be read and written as they are to be; says what was found of runs that were killed.
pub(super) fn check_files(files: &Files) -> Result<(), FilesError> {
    for kept in files.check()? {
        console::diagnose(&format_args!(
            "note: what a run that was killed had recorded is kept in {}",
            kept.display()
        ));
    }
    Ok(())
}

/// Makes a folder, and those that it lies in.
pub(super) fn make_folder(folder: &Path) -> Result<(), CallError> {
    std::fs::create_dir_all(folder)
        .map_err(|source| CallError::FolderNotMade { path: folder.to_owned(), source })
}
