//! A computer's clocks, as one program sees them.

use std::fs::{self, File};
use std::os::unix::fs::FileExt as _;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Clocks that can be set.
pub(crate) struct Clocks {
    library: PathBuf,
    set: PathBuf,
}

impl Clocks {
    /// The computer's own clocks at first; what sets them is in `folder`.
    pub(crate) fn in_folder(folder: &Path) -> Self {
        let [library, set] = ["clocks.so", "clocks.set"].map(|name| folder.join(name));
        let source = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/station/clocks.c");
        let made =
            Command::new("cc").args(["-shared", "-fPIC", "-O2", "-o"]).arg(&library).arg(source).status();
        assert!(made.unwrap().success());
        fs::write(&set, [0; 16]).unwrap();
        Self { library, set }
    }

    /// Makes the program use these clocks.
    pub(crate) fn of<'a>(&self, program: &'a mut Command) -> &'a mut Command {
        program.env("LD_PRELOAD", &self.library).env("SET_CLOCKS", &self.set)
    }

    /// Sets the wall clock, and the clock since the computer started, this many seconds ahead of the computer's own.
    pub(crate) fn ahead(&self, wall: i64, since_start: i64) {
        let bytes = [wall, since_start].map(i64::to_ne_bytes).concat();
        File::options().write(true).open(&self.set).unwrap().write_all_at(&bytes, 0).unwrap();
    }
}
