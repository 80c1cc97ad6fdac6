//! Processes that the station starts: without its secrets, and each as the leader of its own process group, so that
//! whatever it has started is killed with it.

use std::ffi::OsStr;
use std::os::unix::process::CommandExt as _;
use std::process::{Child, Command, ExitStatus};
use std::thread;
use std::time::{Duration, Instant};

use nix::sys::signal::{Signal, killpg};
use nix::unistd::Pid;

use crate::settings::PASSWORD_OF_PLANT;

/// The first pause between two checks whether a process has ended, and the longest one.
const FIRST: Duration = Duration::from_millis(1);
const LONGEST: Duration = Duration::from_millis(10);

/// How long a killed process is waited for.
const KILLED: Duration = Duration::from_secs(10);

/// A command that starts `program` as such a process: it need not know how the station reaches its plant, [`kill`] can
/// kill its group, and Ctrl-C at the station does not reach it.
pub(crate) fn command(program: impl AsRef<OsStr>) -> Command {
    let mut command = Command::new(program);
    command.env_remove(PASSWORD_OF_PLANT).process_group(0);
    command
}

/// How a process ended, if it does so within `limit`.
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

/// Kills the group of `child`, and returns how `child` ended, if it did. A process in uninterruptible sleep does not
/// end, and is waited for no longer.
pub(crate) fn killed(child: &mut Child) -> Option<ExitStatus> {
    kill(child.id());
    waited(child, KILLED)
}

/// Kills the process group of `leader`, which may be empty already.
pub(crate) fn kill(leader: u32) {
    if let Ok(group) = i32::try_from(leader)
        && let Err(error) = killpg(Pid::from_raw(group), Signal::SIGKILL)
    {
        tracing::debug!("the processes {group} were not killed: {error}");
    }
}
