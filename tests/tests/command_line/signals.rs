//! Ctrl-C and SIGTERM: the run ends soon, says so, and leaves nothing half done.

#![cfg(unix)]

use std::io::{BufRead as _, BufReader, Read as _};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use halfrow_tests::program::{Ended, Folder};

/// At 20,000 bytes a second the built-in frames would take an hour.
const SLOW: &str = "mock,pace=real,speed=20000";

/// How long a run may go on after a signal. It looks for one between any two exchanges with the board.
const SOON: Duration = Duration::from_secs(3);

/// Starts a slow run, sends it `signal` while it streams, and waits for its end.
fn interrupted(folder: &Folder, signal: &str, arguments: &[&str]) -> Ended {
    let mut command = folder
        .command(["verify", "-vv", "--json", "--board", SLOW].into_iter().chain(arguments.iter().copied()));
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // When it has got its session it already listens for signals.
    let mut log = BufReader::new(child.stderr.take().unwrap());
    let mut stderr = String::new();
    while !stderr.contains("session ") {
        assert!(log.read_line(&mut stderr).unwrap() > 0, "it ended by itself: {stderr}");
    }
    let sent = Instant::now();
    let kill = Command::new("sh").args(["-c", &format!("kill -{signal} {}", child.id())]).status();
    assert!(kill.unwrap().success());
    while child.try_wait().unwrap().is_none() {
        assert!(sent.elapsed() < SOON, "still running {SOON:?} after {signal}");
        sleep(Duration::from_millis(10));
    }
    log.read_to_string(&mut stderr).unwrap();
    let output = child.wait_with_output().unwrap();
    Ended { code: output.status.code(), stdout: String::from_utf8(output.stdout).unwrap(), stderr }
}

#[test]
fn ctrl_c_ends_a_run_with_130() {
    let ended = interrupted(&Folder::new(), "INT", &[]);
    assert_eq!(ended.code, Some(130), "{}", ended.stderr);
    let said = ended.json();
    assert_eq!((&said["verdict"], &said["exit_code"]), (&"ERROR".into(), &130.into()));
    assert!(said["headline"].as_str().unwrap().starts_with("stopped by hand"), "{}", said["headline"]);
}

#[test]
fn sigterm_ends_a_run_with_143() {
    let ended = interrupted(&Folder::new(), "TERM", &[]);
    assert_eq!((ended.code, &ended.json()["exit_code"]), (Some(143), &143.into()), "{}", ended.stderr);
}

#[test]
fn an_interrupted_run_leaves_a_whole_report_that_says_so_and_a_recording() {
    let folder = Folder::new();
    let ended = interrupted(&folder, "INT", &["--report", "out", "--record", "run.rec"]);
    assert_eq!(ended.code, Some(130));
    assert_eq!(folder.names("."), ["out", "run.rec"]);
    assert_eq!(folder.names("out"), ["report.html", "report.json", "report.xml"]);
    let report: serde_json::Value = serde_json::from_slice(&folder.read("out/report.json")).unwrap();
    assert_eq!(report, ended.json());
    assert!(folder.text("out/report.html").trim_end().ends_with("</html>"));
}
