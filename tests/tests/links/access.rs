//! Ports that a user may not open, or not now. Root may open every port, so where the tests run as root these run as nobody.

use std::fs::{self, Permissions};
use std::os::unix::fs::{PermissionsExt as _, chown};
use std::path::{Path, PathBuf};
use std::process::Command;

use halfrow::link;
use halfrow_cli::serve::Pty;
use halfrow_tests::program::{self, Ended, Folder};
use halfrow_tests::served::Served;

use crate::ends;

const NOBODY: u32 = 65534;

fn is_root() -> bool {
    nix::unistd::geteuid().is_root()
}

/// The program where anybody can start it.
fn for_anybody(folder: &Folder) -> PathBuf {
    let copy = folder.path().join("halfrow");
    fs::copy(program::command([]).get_program(), &copy).unwrap();
    fs::set_permissions(folder.path(), Permissions::from_mode(0o755)).unwrap();
    copy
}

fn info_as_nobody(program: &Path, target: &str) -> Ended {
    as_nobody(program, &["info", "--json", "--board", target])
}

fn as_nobody(program: &Path, arguments: &[&str]) -> Ended {
    let mut command = Command::new("setpriv");
    command.args(["--reuid=65534", "--regid=65534", "--clear-groups"]).arg(program);
    if !is_root() {
        command = Command::new(program);
    }
    command.env_clear().env("PATH", "/usr/bin:/bin").current_dir("/");
    program::finish(command.args(arguments))
}

#[test]
fn a_port_that_one_may_not_open_is_told_from_one_that_is_not_there() {
    let folder = Folder::new();
    let pty = Pty::open().unwrap();
    fs::set_permissions(pty.path(), Permissions::from_mode(0o000)).unwrap();
    let program = for_anybody(&folder);
    let target = format!("serial:{}", pty.path().display());
    ends(&info_as_nobody(&program, &target), 3, "you may not open /dev/pts/");
    ends(&info_as_nobody(&program, &target), 3, "install scripts/70-halfrow.rules");
    let looked = as_nobody(&program, &["boards", "--json", "--ask", &target]).json();
    assert_eq!(looked["boards"][0]["access"]["state"], "denied", "{looked}");
    fs::set_permissions(pty.path(), Permissions::from_mode(0o660)).unwrap();
    if is_root() {
        chown(pty.path(), None, Some(20)).unwrap();
        ends(&info_as_nobody(&program, &target), 3, "join its group with `sudo usermod -aG dialout $USER`");
    }
}

#[test]
fn a_port_in_use_is_busy_for_a_user_without_rights_too() {
    let folder = Folder::new();
    let served = Served::on_a_serial_port("mock");
    if is_root() {
        chown(served.address(), Some(NOBODY), None).unwrap();
    }
    let program = for_anybody(&folder);
    let held = link::open(&served.target().parse().unwrap()).unwrap();
    ends(&info_as_nobody(&program, &served.target()), 4, "is in use");
    drop(held);
    let ended = info_as_nobody(&program, &served.target());
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
}

/// A user of whom no other program is, with room for so many threads.
fn with_threads(most: u32, program: &Path, arguments: &[&str]) -> Ended {
    let mut command = Command::new("prlimit");
    command.arg(format!("--nproc={most}"));
    command
        .args(["setpriv", "--reuid=54321", "--regid=54321", "--clear-groups"])
        .arg(program)
        .args(arguments);
    // More than there is room for share the work otherwise.
    command.env_clear().env("PATH", "/usr/bin:/bin").env("RAYON_NUM_THREADS", "64");
    program::finish(command.current_dir("/"))
}

/// One thread is the program's own, one waits for signals, one makes frames and one predicts signatures. Root alone may become another
/// user, and has always room.
#[test]
fn a_run_that_gets_no_thread_ends_with_its_result() {
    if !is_root() {
        return;
    }
    let folder = Folder::new();
    let program = for_anybody(&folder);
    let run = ["verify", "--json", "--width", "128", "--height", "32", "--radius", "80"];
    let without = with_threads(2, &program, &run).json();
    assert_eq!(without["cause"], "station", "{without}");
    assert_eq!(without["finding"]["code"], "run-thread-missing", "{without}");
    assert_eq!(with_threads(4, &program, &run).json()["verdict"], "PASS");
}
