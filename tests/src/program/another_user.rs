//! `halfrow` as a user who is not root, or with limits of its own.

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::process::Command;
use std::sync::atomic::{AtomicU32, Ordering};

use nix::unistd::geteuid;

use super::Folder;
use crate::not_tested::not_tested;

/// The number of the user nobody, and of its group.
pub const NOBODY: u32 = 65_534;

/// Whether this program may become another user.
#[must_use]
pub fn is_root() -> bool {
    geteuid().is_root()
}

impl Folder {
    /// A command that will start `halfrow` in this folder as a user who may read nobody else's files: this one, or if
    /// it is root, the user nobody.
    ///
    /// # Panics
    /// If the program cannot be built or put where that user may start it.
    #[must_use]
    pub fn as_nobody(&self, arguments: &[&str]) -> Command {
        if is_root() { self.as_user(NOBODY, &[], arguments) } else { self.command(arguments.iter().copied()) }
    }

    /// A command that will start `halfrow` in this folder, within `limit`, an option of `prlimit`, as a user who runs no other
    /// program. None unless this user is root, who alone may become another: that is reported as not tested.
    ///
    /// # Panics
    /// Like [`Self::as_nobody`].
    #[must_use]
    pub fn within(&self, limit: &str, arguments: &[&str]) -> Option<Command> {
        if !is_root() {
            not_tested(
                &format!("halfrow within prlimit {limit}"),
                "only root may become a user who runs nothing else",
            );
            return None;
        }
        Some(self.as_user(nobody_else(), &["prlimit", limit], arguments))
    }

    /// The command, started by `by` as the user of the number `user`, without any of root's groups.
    fn as_user(&self, user: u32, by: &[&str], arguments: &[&str]) -> Command {
        let command = self.command(arguments.iter().copied());
        let program = self.path().join("halfrow-of-another-user");
        if !program.exists() {
            // Copied by another program: while this one has the file open for writing, processes that other tests start inherit
            // that, and nobody can run it.
            let copied = Command::new("cp").arg(command.get_program()).arg(&program).status().unwrap();
            assert!(copied.success(), "the program cannot be copied to {}", program.display());
        }
        for path in [self.path(), &program] {
            fs::set_permissions(path, fs::Permissions::from_mode(0o755)).unwrap();
        }
        let mut other = Command::new("setpriv");
        other.args([format!("--reuid={user}"), format!("--regid={NOBODY}"), "--clear-groups".to_owned()]);
        other.args(by).arg(program).args(arguments);
        self.as_started_by(other, &command)
    }
}

/// The number of a user who runs nothing: the limit counts all processes of a user, also those of other tests.
fn nobody_else() -> u32 {
    static CALLS: AtomicU32 = AtomicU32::new(0);
    let call = CALLS.fetch_add(1, Ordering::Relaxed);
    20_000 + std::process::id().wrapping_mul(16).wrapping_add(call) % 40_000
}
