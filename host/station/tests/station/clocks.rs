//! The clocks of a computer, for one program.

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
    /// Those that the computer has, with what sets them in `folder`.
    pub(crate) fn in_folder(folder: &Path) -> Self {
        let [library, set] = ["clocks.so", "clocks.set"].map(|name| folder.join(name));
        let source = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/station/clocks.c");
        let made =
            Command::new("cc").args(["-shared", "-fPIC", "-O2", "-o"]).arg(&library).arg(source).status();
        assert!(made.unwrap().success());
        fs::write(&set, [0; 16]).unwrap();
        Self { library, set }
    }

    /// Has the program go by them.
    pub(crate) fn of<'a>(&self, program: &'a mut Command) -> &'a mut Command {
        program.env("LD_PRELOAD", &self.library).env("SET_CLOCKS", &self.set)
    }

    /// The wall's clock, and that since the computer started, show so many seconds more than the computer's own.
    pub(crate) fn ahead(&self, wall: i64, since_start: i64) {
        let bytes = [wall, since_start].map(i64::to_ne_bytes).concat();
        File::options().write(true).open(&self.set).unwrap().write_all_at(&bytes, 0).unwrap();
    }
}
