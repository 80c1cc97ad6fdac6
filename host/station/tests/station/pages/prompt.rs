//! A terminal at which a badge is asked for.

use std::fs::File;
use std::io::Write as _;
use std::os::fd::AsRawFd as _;
use std::process::{Command, Stdio};

use nix::fcntl::OFlag;
use nix::pty::{grantpt, posix_openpt, ptsname_r, unlockpt};
use nix::sys::signal::Signal;
use nix::sys::termios::{LocalFlags, tcgetattr};

use crate::common::{program, signal, until};
use crate::pages::station::Station;

/// Otherwise whoever types next at that terminal does so blind.
#[test]
fn a_terminal_shows_what_is_typed_again_whatever_ends_the_program_at_the_prompt() {
    let station = Station::with(1, "[access]\nusers = \"users.toml\"");
    for by_key in [true, false] {
        let mut terminal = posix_openpt(OFlag::O_RDWR | OFlag::O_NOCTTY).unwrap();
        grantpt(&terminal).unwrap();
        unlockpt(&terminal).unwrap();
        let path = ptsname_r(&terminal).unwrap();
        let host = File::options().read(true).write(true).open(path).unwrap();
        let shows = || tcgetattr(host.as_raw_fd()).unwrap().local_flags.contains(LocalFlags::ECHO);
        assert!(shows());
        // The program has the terminal, whose keys then signal it.
        let mut child = Command::new("env")
            // Whoever runs the tests in the background may ignore them.
            .args(["--default-signal=INT,TERM", "setsid", "--ctty"])
            .arg(program())
            .args(["user", "add", "Weber", "--settings"])
            .arg(station.path("station.toml"))
            .stdin(host.try_clone().unwrap())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        until("a prompt that hides what is typed", || !shows());
        if by_key {
            terminal.write_all(b"A-00\x03").unwrap();
        } else {
            signal(child.id(), Signal::SIGTERM);
        }
        until("the end of the program", || child.try_wait().unwrap().is_some());
        assert!(shows(), "by key: {by_key}");
    }
}
