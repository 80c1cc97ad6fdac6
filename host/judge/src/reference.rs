//! The reference model as this process runs it: by one path for all frames, which the golden values hold to account.

use std::sync::OnceLock;

use halfrow_model::{CorrectError, Corrector, Frame, Kernel, ModelPath, TableSet, UnavailablePath};

static CHOSEN: OnceLock<ModelPath> = OnceLock::new();

/// Makes the process take `path`, unless it has taken one already; without a wish, the fastest of this processor.
///
/// # Errors
/// [`UnavailablePath`] when this processor cannot take it.
pub fn choose(path: Option<ModelPath>) -> Result<ModelPath, UnavailablePath> {
    match path {
        Some(path) if !path.is_available() => Err(UnavailablePath(path)),
        path => Ok(*CHOSEN.get_or_init(|| path.unwrap_or_else(ModelPath::best))),
    }
}

/// The path that the process takes: what was chosen, or else the fastest of this processor.
#[must_use]
pub fn path() -> ModelPath {
    *CHOSEN.get_or_init(ModelPath::best)
}

/// A corrector of the process's path.
#[must_use]
pub fn corrector(kernel: &Kernel) -> Corrector {
    Corrector::new(path(), kernel).unwrap_or_else(|_| Corrector::oracle(kernel))
}

/// The corrected frame: what a board must return.
///
/// # Errors
/// [`CorrectError`] when the frame has another size or depth than the tables are for.
pub fn correct(tables: &TableSet, kernel: &Kernel, frame: &Frame) -> Result<Frame, CorrectError> {
    corrector(kernel).correct(tables, frame)
}
