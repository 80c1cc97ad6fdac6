//! A board that keeps the session of a lane that was killed.

use std::fs;
use std::io::{Read as _, Write as _};
use std::net::TcpListener;
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread;
use std::time::Duration;

use halfrow::link;
use nix::sys::signal::Signal;
use serde_json::Value;

use super::ends::lane_of;
use super::floor::{HANG, Running, SERIALS, Station, plan};
use crate::common::signal;
use crate::runs::identity::answers;

/// A board behind a port, whose own time passes only while it is talked to, or as it is told.
pub(super) struct Board {
    pub(super) target: String,
    /// Told once the board has said enough, and takes its time over this connection, so that its run does not end by
    /// itself.
    pub(super) slowed: Receiver<()>,
    /// Lets time pass before the next connection.
    pass: Sender<Duration>,
}

impl Board {
    pub(super) fn new() -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let target = format!("tcp:{}", listener.local_addr().unwrap());
        let ((slows, slowed), (pass, passes)) = (mpsc::channel(), mpsc::channel());
        thread::spawn(move || {
            let mut board = link::open(&"mock".parse().unwrap()).unwrap().link;
            let (mut said, mut is_first) = (0, true);
            for host in listener.incoming() {
                let (mut host, mut bytes) = (host.unwrap(), [0; 4096]);
                for time in passes.try_iter() {
                    board.exchange(&[], &mut Vec::new(), time).unwrap();
                }
                let mut is_slow = false;
                while let Ok(read @ 1..) = host.read(&mut bytes) {
                    let answer = answers(&mut *board, &bytes[..read]);
                    said += answer.len();
                    if is_first && said > 20_000 {
                        (is_first, is_slow) = (false, true);
                        slows.send(()).unwrap();
                    }
                    if is_slow {
                        thread::sleep(Duration::from_millis(300));
                    }
                    // What a host that is gone still had to say keeps the next one waiting.
                    if host.write_all(&answer).is_err() {
                        break;
                    }
                }
            }
        });
        Self { target, slowed, pass }
    }
}

/// A plan by which a board that is slow would be judged for minutes.
pub(super) fn long_plan() -> String {
    plan().replace("timeout = 60", "timeout = 3600\nrepeat = 200")
}

/// A station with this board, whose runs are long enough to be slowed down.
fn station(board: &Board) -> Station {
    let station = Station::with(&[&board.target], "");
    fs::write(station.path("plan.toml"), long_plan()).unwrap();
    station
}

/// Waits for a verdict on this serial number.
fn ended(running: &mut Running, serial: &str) -> Value {
    running.wait("a verdict", |news| news["shown"]["serial"] == serial)["shown"].clone()
}

/// Begins a run, and returns its id once the board is held by it.
fn held(running: &mut Running, board: &Board) -> Value {
    running.test("1", SERIALS[0]);
    let run = running.wait("a step", |news| news["news"] == "doing")["run"].clone();
    board.slowed.recv_timeout(HANG).unwrap();
    run
}

/// A scan says when to scan again, and a scan at that time is judged.
fn says_when_to_scan_again(running: &mut Running, board: &Board) {
    running.test("1", SERIALS[1]);
    let told = ended(running, SERIALS[1]);
    let headline = told["headline"].as_str().unwrap();
    let (_, when) = headline.split_once("scan the label again in ").unwrap_or_else(|| panic!("{told}"));
    assert!(headline.contains("the board is held by another session"), "{told}");
    let seconds: u64 = when.strip_suffix(" s").unwrap().parse().unwrap();
    assert!((1..=10).contains(&seconds), "{told}");
    assert_eq!(
        (&told["verdict"], &told["remedy"]),
        (&"ERROR".into(), &format!("Scan the label again in {seconds} s.").into())
    );
    board.pass.send(Duration::from_secs(seconds)).unwrap();
    running.test("1", SERIALS[2]);
    assert_eq!(ended(running, SERIALS[2])["verdict"], "PASS");
}

#[test]
fn a_board_whose_lane_was_killed_is_said_to_be_held_until_it_is_not() {
    let board = Board::new();
    let station = station(&board);
    let mut running = station.start();
    let run = held(&mut running, &board);
    signal(lane_of(&station, &run), Signal::SIGKILL);
    assert_eq!(ended(&mut running, SERIALS[0])["verdict"], "ERROR");
    says_when_to_scan_again(&mut running, &board);
    assert_eq!(running.end().0, Some(0));
    assert_eq!(
        station.query("SELECT verdict || ' ' || cause FROM run ORDER BY id"),
        ["ERROR crash", "ERROR station", "PASS none"]
    );
    station.assert_well();
}

#[test]
fn a_board_whose_station_was_killed_is_said_to_be_held_at_the_next_start() {
    let board = Board::new();
    let station = station(&board);
    let mut running = station.start();
    held(&mut running, &board);
    signal(running.id(), Signal::SIGKILL);
    assert_eq!(running.end().0, None);
    let mut running = station.start();
    says_when_to_scan_again(&mut running, &board);
    assert_eq!(running.end().0, Some(0));
    station.assert_well();
}
