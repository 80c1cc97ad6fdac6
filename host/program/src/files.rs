//! Where a command writes, checked before anything is done.

use halfrow::call::{Files, FilesError};

use crate::console;

/// Checks that `files` can be read and written as intended, and clears what killed runs left there. Says on stderr what is kept
/// of it.
///
/// # Errors
/// [`FilesError`]
pub fn prepare_files(files: &Files) -> Result<(), FilesError> {
    files.check()?;
    for kept in files.clear_leftovers() {
        console::diagnose(&format_args!(
            "note: what a run that was killed had recorded is kept in {}",
            kept.display()
        ));
    }
    Ok(())
}
