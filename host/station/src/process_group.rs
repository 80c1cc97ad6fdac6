//! Processes that the station starts: without its secrets, and as leaders of groups of their own, so that what they have started is
//! killed with them.

use std::ffi::OsStr;
use std::process::{Child, Command, ExitStatus};
use std::thread;
use std::time::{Duration, Instant};

use nix::sys::signal::{Signal, killpg};
use nix::unistd::Pid;

use crate::settings::PASSWORD_OF_PLANT;

/// How soon it is looked at first whether a process has ended, and how long no look waits longer.
const FIRST: Duration = Duration::from_millis(1);
const LONGEST: Duration = Duration::from_millis(10);

/// How long what was killed is waited for.
const KILLED: Duration = Duration::from_secs(10);

/// A call of `program`, which has no need to know how the station reaches its plant.
pub(crate) fn without_secrets(program: impl AsRef<OsStr>) -> Command {
    let mut command = Command::new(program);
    command.env_remove(PASSWORD_OF_PLANT);
    command
}

/// How a process ended, if it does within `limit`.
pub(crate) fn waited(child: &mut Child, limit: Duration) -> Option<ExitStatus> {
    let (begun, mut look) = (Instant::now(), FIRST);
    loop {
        match child.try_wait() {
            Ok(Some(status)) => return Some(status),
            _ if begun.elapsed() > limit => return None,
            _ => thread::sleep(look),
        }
        look = LONGEST.min(2 * look);
    }
}

/// Kills the group of `child`; how that ended, if it did. What sleeps uninterruptibly does not, and is waited for no longer.
pub(crate) fn killed(child: &mut Child) -> Option<ExitStatus> {
    kill(child.id());
    waited(child, KILLED)
}

/// Kills the group of the process `leader`, of which none need be left.
pub(crate) fn kill(leader: u32) {
    if let Ok(group) = i32::try_from(leader)
        && let Err(error) = killpg(Pid::from_raw(group), Signal::SIGKILL)
    {
        tracing::debug!("the processes {group} were not killed: {error}");
    }
}
