//! Ports that a user may not open, or not now. Root may open every port, so where the tests run as root, these run as nobody.

use std::fs::{self, Permissions};
use std::os::unix::fs::{PermissionsExt as _, chown};

use halfrow::link;
use halfrow_cli::serve::Pty;
use halfrow_tests::program::another_user::{NOBODY, is_root};
use halfrow_tests::program::{Ended, Folder, finish};
use halfrow_tests::served::Served;

use crate::{ends, once_free};

fn info_as_nobody(folder: &Folder, target: &str) -> Ended {
    finish(&mut folder.as_nobody(&["info", "--json", "--board", target]))
}

#[test]
fn a_port_that_one_may_not_open_is_told_from_one_that_is_not_there() {
    let folder = Folder::new();
    let pty = Pty::open().unwrap();
    fs::set_permissions(pty.path(), Permissions::from_mode(0o000)).unwrap();
    let target = format!("serial:{}", pty.path().display());
    ends(&info_as_nobody(&folder, &target), 3, "you may not open /dev/pts/");
    ends(&info_as_nobody(&folder, &target), 3, "ask root for read and write access to it");
    let looked = finish(&mut folder.as_nobody(&["boards", "--json", "--ask", &target])).json();
    assert_eq!(looked["boards"][0]["access"]["state"], "denied", "{looked}");
    fs::set_permissions(pty.path(), Permissions::from_mode(0o660)).unwrap();
    if is_root() {
        chown(pty.path(), None, Some(20)).unwrap();
        ends(&info_as_nobody(&folder, &target), 3, "join its group with `sudo usermod -aG dialout $USER`");
    }
}

#[test]
fn a_port_in_use_is_busy_for_a_user_without_rights_too() {
    let folder = Folder::new();
    let served = Served::on_a_serial_port("mock");
    if is_root() {
        chown(served.address(), Some(NOBODY), None).unwrap();
    }
    let held = link::open(&served.target().parse().unwrap()).unwrap();
    ends(&info_as_nobody(&folder, &served.target()), 4, "is in use");
    drop(held);
    once_free(|| info_as_nobody(&folder, &served.target()), |ended| ended.code == Some(4)).succeeded();
}

/// One thread is the main one, one waits for signals, one makes frames and one predicts signatures. One that has just ended may
/// still be counted.
#[test]
fn a_run_that_gets_no_thread_ends_with_its_result() {
    let folder = Folder::new();
    let run = ["verify", "--json", "--width", "128", "--height", "32", "--radius", "80"];
    let with_threads = |most: u32| {
        // Where there is no room for this many, the work is shared otherwise.
        let mut command = folder.within(&format!("--nproc={most}"), &run)?;
        Some(finish(command.env("RAYON_NUM_THREADS", "64")).json())
    };
    let (Some(without), Some(with)) = (with_threads(2), with_threads(8)) else { return };
    assert_eq!(without["cause"], "station", "{without}");
    assert_eq!(without["finding"]["code"], "run-thread-missing", "{without}");
    assert_eq!(with["verdict"], "PASS", "{with}");
}
