//! What a call is to write, refused as the command line refuses it: before anything is written, and as the call's fault.

use std::path::{Path, PathBuf};

use halfrow::call::Files;
use pyo3::prelude::*;

use crate::errors;

/// Checks that the files `paths`, which the argument `path` names, can be written beside those that `files` has.
pub(crate) fn check_files<P: Into<PathBuf>>(
    files: Files,
    paths: impl IntoIterator<Item = P>,
) -> PyResult<()> {
    files.writes("path", paths).check().map_err(errors::input)
}

/// Checks that a report can be written to the argument `folder`.
pub(crate) fn check_report(folder: &Path, overwrite: bool) -> PyResult<()> {
    Files::new(overwrite).writes_report("folder", Some(folder)).check().map_err(errors::input)
}
