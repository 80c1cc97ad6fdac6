//! The station's program, which is in the same folder as this one if it was built.

use std::io;
use std::path::PathBuf;

/// Its name.
pub(crate) const STATION: &str = "halfrow-station";

/// Its path, whether it exists or not.
///
/// # Errors
/// When the system does not say where this program is.
pub(crate) fn station() -> io::Result<PathBuf> {
    Ok(std::env::current_exe()?.with_file_name(STATION))
}
