//! A board is not taken from a program that has it open, and what was borrowed is given back.

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::SystemTime;

use halfrow_tests::patience::wait_until;
use halfrow_tests::program::{Running, command, halfrow};
use halfrow_tests::usb::{plug, plug_and_watch, serial_port, verify};

/// A shell that has a serial port open.
struct Holding(Child);

impl Holding {
    fn new(port: &Path) -> Self {
        let script = format!("exec 3<>{}; read forever", port.display());
        let child = Command::new("/bin/sh").args(["-c", &script]).stdin(Stdio::piped()).spawn().unwrap();
        let file = format!("/proc/{}/fd/3", child.id());
        wait_until("the shell to open it", || fs::read_link(&file).is_ok_and(|target| target == port));
        Self(child)
    }
}

impl Drop for Holding {
    fn drop(&mut self) {
        // It may have ended by itself; then there is nothing to do.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// When the driver made this port: another time means another port.
fn made(port: &Path) -> SystemTime {
    let folder = Path::new("/sys/class/tty").join(port.file_name().unwrap());
    fs::metadata(folder).unwrap().modified().unwrap()
}

#[test]
#[ignore = "needs scripts/in-linux"]
fn a_program_keeps_the_serial_port_that_it_has_open() {
    let board = plug("");
    let port = serial_port(&board, 1);
    let holding = Holding::new(&port);
    let before = made(&port);
    let ended = verify("usb");
    assert_eq!(ended.code, Some(4), "{ended:?}");
    let by = format!("{} is in use by sh (process {})", port.display(), holding.0.id());
    assert!(ended.headline().contains(&by), "{ended:?}");
    assert_eq!(made(&port), before);
    drop(holding);
    verify("usb").succeeded();
}

#[test]
#[ignore = "needs scripts/in-linux"]
fn the_other_channel_stays_with_whoever_has_it_and_the_driver_comes_back() {
    let board = plug("");
    let (other, ours) = (serial_port(&board, 0), serial_port(&board, 1));
    let _holding = Holding::new(&other);
    let before = (made(&other), made(&ours));
    verify("usb").succeeded();
    assert_eq!(made(&other), before.0);
    assert_ne!(made(&serial_port(&board, 1)), before.1);
}

#[test]
#[ignore = "needs scripts/in-linux"]
fn two_programs_do_not_share_a_channel() {
    let _board = plug("");
    let link = halfrow::link::open(&"usb".parse().unwrap()).map(|candidate| candidate.link);
    assert!(link.is_ok(), "{:?}", link.err());
    let ended = verify("usb");
    assert_eq!(ended.code, Some(4), "{ended:?}");
    assert!(
        ended.headline().contains("channel B of usb:HR000001 is in use by program (process"),
        "{ended:?}"
    );
    let access = || {
        let listed = halfrow(["boards", "--json"]).json();
        let mut listed = listed["boards"].as_array().unwrap().iter();
        listed.find(|board| board["target"] == "usb:HR000001").unwrap()["access"].clone()
    };
    let held = access();
    assert_eq!(
        (&held["state"], &held["holders"][0]["process"]),
        (&"busy".into(), &std::process::id().into()),
        "{held}"
    );
    drop(link);
    assert_eq!(access()["state"], "free");
    verify("usb").succeeded();
}

#[test]
#[ignore = "needs scripts/in-linux"]
fn a_run_that_was_killed_leaves_a_board_for_the_next_one() {
    let (board, said) = plug_and_watch("");
    let port = serial_port(&board, 1);
    let run = Running::start(&mut command(["verify", "--board", "usb", "--repeat", "99"]));
    said.wait_for_rows();
    drop(run);
    // The kernel gives an interface back to its driver only if it is told to.
    let ended = verify(&format!("serial:{}", port.display()));
    assert_eq!(ended.json()["error"]["code"], "serial-port-missing", "{ended:?}");
    assert!(ended.headline().contains("unplug the board and plug it in"), "{ended:?}");
    verify("usb").succeeded();
    assert!(serial_port(&board, 1).exists());
}
