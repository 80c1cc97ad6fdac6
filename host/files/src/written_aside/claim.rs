//! The right to make a file or folder of a given name, which one run has at a time.

use std::fs::{self, File, OpenOptions};
use std::os::unix::fs::OpenOptionsExt as _;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::Duration;

use nix::fcntl::OFlag;

use super::WriteAsideError;
use super::lock::{self, Tried};
use super::under_way::{self, Noted};

/// How long a run that cleans up may hold the lock.
const MOMENT: Duration = Duration::from_millis(10);
/// How often to wait for that long.
const MOMENTS: u32 = 10;

/// The right of this run to make a name, until this is dropped.
#[derive(Debug)]
pub struct Claim {
    /// Holds the lock.
    _file: File,
    noted: Noted,
}

impl Claim {
    /// Claims `target`.
    ///
    /// # Errors
    /// [`WriteAsideError::Claimed`] when another run has, or the system's reason.
    pub fn take(target: &Path) -> Result<Self, WriteAsideError> {
        let path = under_way::claim_on(target);
        let mut moments = 0;
        while moments < MOMENTS {
            let file = open(&path, target)?;
            match lock::try_lock(&file) {
                Tried::Theirs => {
                    moments += 1;
                    thread::sleep(MOMENT);
                }
                Tried::Ours | Tried::Unknown if lock::is_named(&file, &path) => {
                    return Ok(Self::of(file, path));
                }
                Tried::Ours | Tried::Unknown => {}
            }
        }
        Err(WriteAsideError::Claimed { path: target.to_owned() })
    }

    /// Claims `target` as soon as no other run does. For work that takes next to no time.
    ///
    /// # Errors
    /// The system's reason.
    pub fn wait(target: &Path) -> Result<Self, WriteAsideError> {
        let path = under_way::claim_on(target);
        loop {
            let file = open(&path, target)?;
            // If the file system has no locks, there is none to wait for.
            let _ = file.lock();
            if lock::is_named(&file, &path) {
                return Ok(Self::of(file, path));
            }
        }
    }

    fn of(file: File, path: PathBuf) -> Self {
        Self { _file: file, noted: Noted::new(path) }
    }
}

fn open(path: &Path, target: &Path) -> Result<File, WriteAsideError> {
    let mut options = OpenOptions::new();
    options.write(true).create(true).custom_flags(OFlag::O_NOFOLLOW.bits());
    options.open(path).map_err(|source| WriteAsideError::Io { path: target.to_owned(), source })
}

impl Drop for Claim {
    fn drop(&mut self) {
        // The name is removed before the lock is freed, so that nobody locks a file that is about to be removed.
        let _ = fs::remove_file(self.noted.path());
    }
}
