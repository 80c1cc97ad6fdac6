//! A pseudo-terminal, with a chosen name if wanted.

use std::os::fd::{AsRawFd, RawFd};
use std::os::unix::ffi::OsStrExt as _;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::time::Duration;
use std::{fs, io};

use nix::fcntl::OFlag;
use nix::pty::{PtyMaster, grantpt, posix_openpt, ptsname_r, unlockpt};
use nix::sys::termios::{SetArg, cfmakeraw, tcgetattr, tcsetattr};

use super::{Hosted, Left, ServeError, Traffic};
use halfrow::link::descriptor::never_block;

/// How often to check whether a host has come.
const TICK: Duration = Duration::from_millis(5);
/// Where the system keeps pseudo-terminals.
const TERMINALS: &str = "/dev/pts";

/// A pseudo-terminal. Dropping it is like pulling the cable of a serial port.
#[derive(Debug)]
pub struct Pty {
    master: PtyMaster,
    path: PathBuf,
}

impl Pty {
    /// A new pseudo-terminal in raw mode, which passes every byte on unchanged.
    ///
    /// # Errors
    /// [`ServeError::Door`] when the system has none left.
    pub fn open() -> Result<Self, ServeError> {
        Self::try_open().map_err(|source| ServeError::Door { what: "a pseudo-terminal".to_owned(), source })
    }

    fn try_open() -> io::Result<Self> {
        let master = posix_openpt(OFlag::O_RDWR | OFlag::O_NOCTTY | OFlag::O_CLOEXEC)?;
        grantpt(&master)?;
        unlockpt(&master)?;
        let path = PathBuf::from(ptsname_r(&master)?);
        let mut settings = tcgetattr(master.as_raw_fd())?;
        cfmakeraw(&mut settings);
        tcsetattr(master.as_raw_fd(), SetArg::TCSANOW, &settings)?;
        never_block(master.as_raw_fd())?;
        Ok(Self { master, path })
    }

    /// The file to open.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Serves `board` to one host after the other, until `ended` says so.
    ///
    /// # Errors
    /// [`ServeError::Board`] when the board is gone.
    pub fn serve(
        &self,
        board: &mut Hosted,
        ended: &mut dyn FnMut(Traffic) -> bool,
    ) -> Result<(), ServeError> {
        while board.attend(self, ended)? == Left::Host {
            std::thread::sleep(TICK);
        }
        Ok(())
    }
}

impl AsRawFd for Pty {
    fn as_raw_fd(&self) -> RawFd {
        self.master.as_raw_fd()
    }
}

/// A symbolic link, which is removed when this is dropped, unless another server has replaced it.
#[derive(Debug)]
pub struct Name {
    path: PathBuf,
    target: PathBuf,
}

impl Name {
    /// Links `path` to `target`, which is the caller's. Replaces a link that a killed server left behind: it leads to a terminal
    /// that is gone, or to `target`, since the system gives the number of such a terminal to the next one.
    ///
    /// # Errors
    /// [`ServeError`] when anything else has that name, no target can have it, or the link cannot be made.
    pub fn link(path: &Path, target: &Path) -> Result<Self, ServeError> {
        if path.as_os_str().as_bytes().contains(&b',') {
            return Err(ServeError::Unnameable(path.to_owned()));
        }
        let door = |source| ServeError::Door { what: format!("the link {}", path.display()), source };
        // What is away for a moment, as on a disk that is not mounted, is somebody's.
        let is_gone = |led: &Path| led.starts_with(TERMINALS) && !path.exists();
        let is_left = || fs::read_link(path).is_ok_and(|led| led == target || is_gone(&led));
        match fs::symlink_metadata(path) {
            Ok(found) if found.is_symlink() && is_left() => fs::remove_file(path).map_err(door)?,
            Ok(_) => return Err(ServeError::Exists(path.to_owned())),
            Err(_) => {}
        }
        symlink(target, path).map_err(door)?;
        Ok(Self { path: path.to_owned(), target: target.to_owned() })
    }
}

impl Drop for Name {
    fn drop(&mut self) {
        if fs::read_link(&self.path).is_ok_and(|target| target == self.target) {
            let _ = fs::remove_file(&self.path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_that_another_server_has_by_now_stays() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("board");
        let [first, second] = ["first", "second"].map(|name| folder.path().join(name));
        let earlier = Name::link(&path, &first).unwrap();
        fs::remove_file(&path).unwrap();
        let later = Name::link(&path, &second).unwrap();
        drop(earlier);
        assert_eq!(fs::read_link(&path).unwrap(), second);
        drop(later);
        assert!(fs::symlink_metadata(&path).is_err());
    }

    #[test]
    fn a_name_that_a_killed_server_left_is_taken_and_any_other_kept() {
        let folder = tempfile::tempdir().unwrap();
        let [path, own, other] = ["board", "own", "other"].map(|name| folder.path().join(name));
        for terminal in [&own, &other] {
            fs::write(terminal, "").unwrap();
        }
        symlink(&own, &path).unwrap();
        drop(Name::link(&path, &own).unwrap());
        symlink("/dev/pts/not-there", &path).unwrap();
        drop(Name::link(&path, &own).unwrap());
        for kept in [&other, &folder.path().join("away")] {
            symlink(kept, &path).unwrap();
            assert!(matches!(Name::link(&path, &own), Err(ServeError::Exists(_))));
            assert_eq!(fs::read_link(&path).unwrap(), *kept);
            fs::remove_file(&path).unwrap();
        }
    }
}
