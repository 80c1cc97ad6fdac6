//! Ctrl-C, SIGTERM and SIGHUP: a command ends soon, says so, and leaves nothing half done.

use std::fs::{OpenOptions, read_to_string};
use std::io::{PipeReader, PipeWriter, Write as _};
use std::net::{TcpListener, TcpStream};
use std::os::fd::AsRawFd as _;
use std::process::{Child, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use halfrow_tests::patience::wait_until;
use halfrow_tests::program::{Ended, Folder, Running};
use nix::fcntl::{FcntlArg, OFlag, fcntl};
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;

use crate::running::{SLOW, opened_to_write, started, stopped_amid, streaming, until_there_is};
use crate::small;

/// Starts a slow run, sends it `signal` while it streams, and waits for its end.
fn interrupted(folder: &Folder, signal: &str, arguments: &[&str]) -> Ended {
    let running = streaming(folder, arguments.iter().copied());
    running.send(signal);
    running.end()
}

/// Signals, and the exit codes of commands that they end.
const SIGNALS: [(&str, i32); 3] = [("HUP", 129), ("INT", 130), ("TERM", 143)];
/// What is said to have stopped them, in the order of [`SIGNALS`].
const STOPPED: [&str; 3] =
    ["stopped because the terminal or connection is gone", "stopped by hand", "stopped by the system"];

#[test]
fn a_signal_ends_a_run_with_its_code() {
    for ((signal, code), said_of) in SIGNALS.into_iter().zip(STOPPED) {
        let ended = interrupted(&Folder::new(), signal, &[]);
        assert_eq!(ended.code, Some(code), "{signal}: {}", ended.stderr);
        let said = ended.json();
        assert_eq!((&said["verdict"], &said["exit_code"]), (&"ERROR".into(), &code.into()));
        assert!(said["headline"].as_str().unwrap().starts_with(said_of), "{}", said["headline"]);
    }
}

#[test]
fn an_interrupted_run_leaves_a_whole_report_that_says_so_and_a_recording() {
    for (signal, code) in SIGNALS {
        let folder = Folder::new();
        let ended = interrupted(&folder, signal, &["--report", "out", "--record", "run.rec"]);
        assert_eq!(ended.code, Some(code));
        assert_eq!(folder.names("."), ["out", "run.rec"], "{signal}");
        assert_eq!(folder.names("out"), ["report.html", "report.json", "report.xml"]);
        let report = folder.json("out/report.json");
        assert_eq!(report, ended.json());
        assert!(folder.text("out/report.html").trim_end().ends_with("</html>"));
        let again = folder.halfrow(["verify", "--board", "replay:run.rec"]);
        assert_eq!(again.code, Some(3), "{}", again.stdout);
        assert!(again.stdout.contains("where the run that made it was interrupted"), "{}", again.stdout);
    }
}

/// Its minutes are on the mock's clock, which stands still while the mock computes.
#[test]
fn an_interrupted_soak_has_told_its_minutes_and_leaves_what_was_judged() {
    let folder = Folder::new();
    let board = ["--board", "mock,pixel-clock=1000"];
    let call = ["soak", "--json", "--hours", "8000", "--report", "out"].into_iter().chain(board);
    let quiet =
        started(&folder, small("soak", &["--quiet", "--hours", "0.1"]).into_iter().chain(board)).end();
    assert_eq!((quiet.code, quiet.stderr.as_str()), (Some(0), ""), "{}", quiet.stdout);
    let told = started(&folder, small("soak", &["--hours", "0.1"]).into_iter().chain(board)).end();
    assert_eq!(told.stderr.lines().filter(|line| line.contains(" frames, all equal, ")).count(), 6);
    let running = started(&folder, call.chain(["--width", "64", "--height", "8"]));
    until_there_is(folder.path(), |name| name.contains("out"));
    running.send("INT");
    let ended = running.end();
    assert_eq!(ended.code, Some(130), "{}", ended.stderr);
    let report = folder.json("out/report.json");
    assert_eq!(report, ended.json());
    assert_eq!((&report["command"], &report["verdict"]), (&"soak".into(), &"ERROR".into()));
}

#[test]
fn a_run_that_is_to_outlive_its_terminal_does() {
    let folder = Folder::new();
    let call = ["verify", "-vv", "--json", "--board", SLOW];
    let line = "trap '' HUP; exec env --default-signal=INT,TERM \"$@\"";
    let mut running = Running::start(&mut folder.by_shell(line, call));
    running.wait_for("session ");
    running.send("HUP");
    running.send("INT");
    assert_eq!(running.end().code, Some(130));
}

#[test]
fn a_command_that_judges_nothing_says_so_when_it_is_stopped() {
    let folder = Folder::new();
    let running = started(&folder, ["correct", "builtin:noise", "--board", SLOW, "-o", "out"]);
    // It makes the folder once it has opened its board.
    until_there_is(folder.path(), |name| name == "out");
    running.send("INT");
    let ended = running.end();
    assert_eq!(ended.code, Some(130), "{}", ended.stderr);
    let said = "error: stopped by hand before it was done; run again\n";
    assert!(ended.stderr.contains(said), "{}", ended.stderr);
}

/// Frames of the paper's size, which take a while to write.
pub(crate) const LARGE: [&str; 9] = [
    "correct",
    "builtin:street",
    "builtin:noise",
    "builtin:bars",
    "builtin:grey",
    "--quiet",
    "--model",
    "-o",
    "out",
];

#[test]
fn frames_that_are_half_written_go_with_the_program() {
    for (signal, code) in SIGNALS {
        let folder = Folder::new();
        let running = stopped_amid(&folder, &LARGE);
        running.send(signal);
        running.send("CONT");
        let ended = running.end();
        assert_eq!(ended.code, Some(code), "{signal}: {}", ended.stderr);
        let written = folder.names("out");
        assert!(written.iter().all(|name| !name.starts_with('.')), "{signal}: {written:?}");
        // Those that exist are whole.
        let header = "P5\n1920 1080\n4095\n".len();
        assert!(
            written.iter().all(|name| folder.read(&format!("out/{name}")).len() == header + 2 * 1920 * 1080)
        );
    }
}

/// The command waits for a frame that does not come, and has not begun to write.
#[test]
fn who_writes_nothing_is_not_told_of_what_is_gone() {
    let folder = Folder::new();
    let pipe = folder.path().join("in.pgm");
    nix::unistd::mkfifo(&pipe, nix::sys::stat::Mode::from_bits_truncate(0o600)).unwrap();
    let running = started(&folder, small("correct", &["in.pgm", "--model", "-o", "out.pgm"]));
    let _pipe = opened_to_write(&pipe);
    running.send("TERM");
    let ended = running.end();
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(143), "error: stopped by a signal\n"));
}

#[test]
fn a_signal_ends_a_command_whose_board_waits_for_a_frame() {
    let folder = Folder::new();
    let pipe = folder.path().join("in.pgm");
    nix::unistd::mkfifo(&pipe, nix::sys::stat::Mode::from_bits_truncate(0o600)).unwrap();
    let _pipe = OpenOptions::new().read(true).write(true).open(pipe).unwrap();
    let call = small("correct", &["in.pgm", "-o", "out", "--board", "mock"]);
    let running = started(&folder, call);
    // It makes the folder once it has opened its board, and then waits for a frame that does not come.
    until_there_is(folder.path(), |name| name == "out");
    running.send("INT");
    let ended = running.end();
    assert_eq!(ended.code, Some(130), "{}", ended.stderr);
    assert_eq!(folder.names("out"), [""; 0]);
    let late =
        folder.halfrow(small("correct", &["in.pgm", "-o", "out", "--board", "mock", "--timeout", "0.1"]));
    assert_eq!(late.code, Some(3), "{}", late.stderr);
    assert!(late.stderr.contains("within its time limit"), "{}", late.stderr);
}

/// Nobody answers at the far end, as where the computer is off.
#[test]
fn a_signal_ends_a_run_that_waits_for_a_connection() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    // Once nobody else is let in, the system no longer answers either.
    let connect = || TcpStream::connect_timeout(&address, Duration::from_millis(200)).ok();
    let let_in: Vec<_> = std::iter::from_fn(connect).collect();
    let board = format!("tcp:{address}");
    let commands: [&[&str]; 2] = [&["verify"], &["soak", "--frames", "10"]];
    for ((signal, code), command) in SIGNALS.into_iter().zip(commands.into_iter().cycle()) {
        let folder = Folder::new();
        let call = command.iter().copied().chain(["--report", "out", "--board", &board]);
        let running = started(&folder, call);
        // It takes the report's place right before it connects.
        until_there_is(folder.path(), |name| name.contains("out"));
        running.send(signal);
        let ended = running.end();
        assert_eq!(ended.code, Some(code), "{signal}: {}", ended.stderr);
        assert!(ended.stderr.starts_with("error: stopped by a signal"), "{}", ended.stderr);
        assert_eq!(folder.names("."), [""; 0]);
    }
    drop(let_in);
}

/// `timeout` signals a program, and then its whole group. On a busy computer the second signal may come too late for that.
#[test]
fn the_same_signal_twice_in_a_moment_is_one() {
    wait_until("two signals in a moment", || {
        let folder = Folder::new();
        let running = streaming(&folder, ["--report", "out"]);
        let begun = Instant::now();
        running.send("TERM");
        thread::sleep(Duration::from_millis(2));
        running.send("TERM");
        let is_a_moment = begun.elapsed() < Duration::from_millis(400);
        let ended = running.end();
        let names = folder.names(".");
        assert!(
            !is_a_moment || (ended.code, &*names) == (Some(143), &["out".to_owned()]),
            "{names:?} {ended:?}"
        );
        is_a_moment
    });
}

/// The run sees both at once, unless it checks for the first one before the second comes: then it is started again.
#[test]
fn what_was_recorded_stays_when_a_second_signal_ends_the_run() {
    let folder = Folder::new();
    let mut said = String::new();
    wait_until("a run to end at a second signal", || {
        let running = streaming(&folder, ["--record", "run.rec", "--overwrite"]);
        running.stop();
        for signal in ["INT", "TERM", "CONT"] {
            running.send(signal);
        }
        said = running.end().stderr;
        said.contains("stopped by a signal")
    });
    let place = folder.path().join("run.rec.partial");
    assert!(said.contains(&format!("of the recording is kept in {}", place.display())), "{said}");
    assert!(folder.read("run.rec.partial").starts_with(b"halfrow recording 1\n"));
}

/// Its log waits for a reader.
#[test]
fn a_second_signal_ends_what_waits_to_say_something() {
    let folder = Folder::new();
    let (_unread, full) = full_pipe();
    let mut command =
        folder.by_shell("exec env --default-signal=INT,TERM,HUP \"$@\"", ["verify", "-vv", "--board", SLOW]);
    let mut waiting = Waiting(command.stderr(full).stdout(Stdio::null()).spawn().unwrap());
    let status = format!("/proc/{}/status", waiting.0.id());
    wait_until("the program to hear signals", || {
        let status = read_to_string(&status).unwrap();
        let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:")).unwrap().trim();
        u64::from_str_radix(caught, 16).unwrap() >> (Signal::SIGTERM as i32 - 1) & 1 == 1
    });
    wait_until("the program to end", || {
        kill(Pid::from_raw(waiting.0.id().cast_signed()), Signal::SIGTERM).unwrap();
        waiting.0.try_wait().unwrap().is_some()
    });
    assert_eq!(waiting.0.wait().unwrap().code(), Some(143));
}

/// A program that may wait for ever. It is killed when dropped.
struct Waiting(Child);

impl Drop for Waiting {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A pipe that accepts nothing more, since nobody reads it: its two ends.
fn full_pipe() -> (PipeReader, PipeWriter) {
    let (unread, mut full) = std::io::pipe().unwrap();
    let descriptor = full.as_raw_fd();
    let set = |flags| fcntl(descriptor, FcntlArg::F_SETFL(flags)).unwrap();
    set(OFlag::O_NONBLOCK);
    while full.write(&[b'.'; 1000]).is_ok() {}
    while full.write(b".").is_ok() {}
    set(OFlag::empty());
    (unread, full)
}
