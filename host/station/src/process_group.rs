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
    seen(limit, || child.try_wait().ok().flatten())
}

/// What `look` sees, if it sees anything within `limit`.
fn seen<T>(limit: Duration, mut look: impl FnMut() -> Option<T>) -> Option<T> {
    let (begun, mut pause) = (Instant::now(), FIRST);
    loop {
        match look() {
            Some(seen) => return Some(seen),
            None if begun.elapsed() > limit => return None,
            None => thread::sleep(pause),
        }
        pause = LONGEST.min(2 * pause);
    }
}

/// Kills the group of `child`, and returns how `child` ended, if it did. A process in uninterruptible sleep does not
/// end, and is waited for no longer.
pub(crate) fn killed(child: &mut Child) -> Option<ExitStatus> {
    kill(child.id());
    waited(child, KILLED)
}

/// Kills the group of a process that is no child of this one, and waits like [`killed`] until `is_gone` tells that it ended.
pub(crate) fn killed_until(leader: u32, is_gone: impl Fn() -> bool) {
    kill(leader);
    seen(KILLED, || is_gone().then_some(()));
}

/// Kills the process group of `leader`, which may be empty already.
pub(crate) fn kill(leader: u32) {
    if let Ok(group) = i32::try_from(leader)
        && let Err(error) = killpg(Pid::from_raw(group), Signal::SIGKILL)
    {
        tracing::debug!("the processes {group} were not killed: {error}");
    }
}
