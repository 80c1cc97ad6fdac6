//! `halfrow serve`, and the state in which a host that vanishes leaves a board.

use std::net::TcpStream;
use std::process::Command;

use halfrow_tests::patience::wait_until;
use halfrow_tests::program::{self, Folder, Running};
use halfrow_tests::served::Served;

use crate::{ends, verify};

/// A running `halfrow serve`.
struct Server {
    running: Running,
    target: String,
}

impl Server {
    fn start(arguments: &[&str]) -> Self {
        let call = ["serve"].into_iter().chain(arguments.iter().copied());
        let mut running = Running::start(&mut program::command(call));
        let target = running.line();
        Self { running, target }
    }

    /// Sends it a signal, and returns its exit code.
    fn end(self, signal: &str) -> Option<i32> {
        self.running.send(signal);
        self.running.end().code
    }
}

/// A run that has opened its session with the board, and moves bytes both ways.
fn streaming(served: &Served) -> Running {
    let slow = ["verify", "-vv", "--quiet", "--board", &served.target()];
    let mut run = Running::start(&mut program::command(slow));
    run.wait_for("session ");
    let before = served.traffic();
    wait_until("bytes to flow both ways", || {
        let now = served.traffic();
        now.to_board > before.to_board && now.to_host > before.to_host
    });
    run
}

#[test]
fn a_served_board_passes_and_its_server_ends_when_it_is_told_to() {
    let folder = Folder::new();
    let path = folder.path().join("board");
    let name = path.to_str().unwrap();
    for (arguments, signal) in [(vec!["--link", name], "INT"), (vec!["--tcp", "0"], "TERM"), (vec![], "TERM")]
    {
        let server = Server::start(&[&["--board", "mock,taps=five"], arguments.as_slice()].concat());
        for _ in 0..2 {
            let ended = verify(&server.target, &[]);
            assert_eq!(ended.code, Some(0), "{}: {}{}", server.target, ended.stdout, ended.stderr);
            assert_eq!(ended.json()["board"]["identity"]["taps"], 5);
        }
        assert_eq!(server.end(signal), Some(0));
        assert!(path.symlink_metadata().is_err());
    }
}

#[test]
fn a_name_that_is_taken_stays_what_it_is() {
    let folder = Folder::new();
    folder.write("mine", "precious");
    let ended = folder.halfrow(["serve", "--link", "mine"]);
    assert_eq!(ended.code, Some(2), "{}", ended.stderr);
    assert!(ended.stderr.contains("mine is there already"), "{}", ended.stderr);
    assert_eq!(folder.text("mine"), "precious");
    // A link that a killed server left behind leads to a terminal that is gone.
    std::os::unix::fs::symlink("/dev/pts/not-there", folder.path().join("old")).unwrap();
    let server = Server::start(&["--link", folder.path().join("old").to_str().unwrap()]);
    assert_eq!(server.end("TERM"), Some(0));
}

#[test]
fn a_host_that_vanishes_leaves_a_board_that_the_next_can_use() {
    let served = Served::on_a_serial_port("mock,speed=20000");
    for signal in ["KILL", "INT", "TERM"] {
        let run = streaming(&served);
        run.send(signal);
        let _ = run.end();
        let info = program::halfrow(["info", "--board", &served.target()]);
        assert_eq!(info.code, Some(0), "after {signal}: {}", info.stderr);
    }
}

#[test]
fn a_board_held_by_another_host_is_busy_over_the_network() {
    let served = Served::on_a_tcp_port("127.0.0.1", "mock,speed=20000");
    // A run that is killed does not close its session.
    drop(streaming(&served));
    ends(&verify(&served.target(), &[]), 4, "another host holds the board");
    program::halfrow(["info", "--take-over", "--board", &served.target()]).succeeded();
}

/// It may open no more files than it has open when it waits.
#[test]
fn a_host_that_cannot_be_let_in_is_told_of_and_served_when_it_can() {
    let mut server = Server::start(&["--tcp", "0"]);
    let id = server.running.id().to_string();
    let limit = |files: &str| {
        let mut command = Command::new("prlimit");
        program::finish(command.args(["--pid", &id, &format!("--nofile={files}:")])).succeeded();
    };
    limit("3");
    let host = TcpStream::connect(server.target.strip_prefix("tcp:").unwrap()).unwrap();
    server.running.wait_for("no host can be let in");
    drop(host);
    limit("256");
    verify(&server.target, &[]).succeeded();
    assert_eq!(server.end("TERM"), Some(0));
}

/// A board keeps its tables from one session to the next, under a generation that the next may use as well.
#[test]
fn what_an_earlier_session_left_on_a_board_misleads_nobody() {
    const LENS: [&str; 6] = ["--width", "128", "--height", "72", "--radius", "73.78"];
    let (server, folder) = (Server::start(&["--board", "mock"]), Folder::new());
    let on_board = ["--board", &server.target];
    let done = |call: &[&str], more: &[&str]| {
        let ended = folder.halfrow(call.iter().chain(more).copied());
        assert_eq!(ended.code, Some(0), "{call:?}: {}{}", ended.stdout, ended.stderr);
    };
    done(&["link", "--seconds", "0.3"], &on_board);
    done(&[&["verify", "--frame", "builtin:noise"], &LENS[..]].concat(), &on_board);
    done(&["frames", "-o", "frames"], &LENS[..4]);
    for kernel in ["nearest", "hermite"] {
        let call = [&["correct", "frames/noise.pgm", "--kernel", kernel], &LENS[..]].concat();
        done(&call, &[&["-o", "board.pgm", "--overwrite"], &on_board[..]].concat());
        done(&call, &["-o", "model.pgm", "--overwrite", "--model"]);
        assert!(folder.read("board.pgm") == folder.read("model.pgm"), "{kernel}");
    }
    assert_eq!(server.end("TERM"), Some(0));
}
