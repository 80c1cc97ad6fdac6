//! `halfrow boards` on ports that the test makes: what is free, busy, missing, and what answers.

use std::io::{Read as _, Write as _};
use std::net::TcpListener;

use halfrow::board::{Board, BoardError, OpenOptions};
use halfrow::link;
use halfrow_cli::serve::Pty;
use halfrow_tests::program::halfrow;
use halfrow_tests::served::Served;
use serde_json::{Value, json};

use crate::once_free;

/// What `halfrow boards` says about `target` alone.
fn look_at(target: &str, more: &[&str]) -> Value {
    let ended = halfrow(["boards", "--json", target].into_iter().chain(more.iter().copied())).succeeded();
    ended.json()["boards"][0].clone()
}

/// What a board says whose port has just been closed.
fn free_and_asked(served: &Served) -> Value {
    once_free(|| look_at(&served.target(), &["--ask"]), |looked| looked["access"]["state"] == "busy")
}

#[test]
fn a_search_lists_devices_and_the_boards_that_need_none() {
    let listed = halfrow(["boards", "--json"]).json();
    let entries = listed["boards"].as_array().unwrap();
    let mock = entries.iter().find(|entry| entry["target"] == "mock").unwrap();
    assert_eq!(mock["kind"], "mock");
    // A pseudo-terminal is no device behind which a board could be.
    assert!(!listed.to_string().contains("/dev/pts"), "{listed}");
}

#[test]
fn a_board_that_answers_is_named_and_left_free() {
    for served in [Served::on_a_serial_port("mock"), Served::on_a_tcp_port("127.0.0.1", "mock")] {
        let looked = look_at(&served.target(), &[]);
        assert_eq!((&looked["kind"], &looked["answer"]), (&json!("hardware"), &Value::Null));
        let asked = look_at(&served.target(), &["--ask"]);
        assert_eq!(asked["answer"], json!({ "state": "board", "name": "halfrow mock board", "datapath": 1 }));
        crate::passes(&served);
    }
}

#[test]
fn what_is_no_board_is_told_from_what_is_not_there() {
    let silent = Pty::open().unwrap();
    let target = format!("serial:{}", silent.path().display());
    assert_eq!(look_at(&target, &[])["access"], json!({ "state": "free" }));
    assert_eq!(look_at(&target, &["--ask"])["answer"], json!({ "state": "silent" }));
    let judged = halfrow(["info", "--board", &target]);
    assert!(judged.stderr.contains("needs flow=none"), "{}", judged.stderr);
    let judged = halfrow(["info", "--board", &format!("{target},flow=none")]);
    assert!(
        judged.stderr.contains("powered and loaded") && !judged.stderr.contains("flow=none"),
        "{}",
        judged.stderr
    );
    let missing = look_at("serial:/dev/ttyUSB99", &["--ask"]);
    assert_eq!((&missing["access"], &missing["answer"]), (&json!({ "state": "missing" }), &Value::Null));
    let refused = look_at("tcp:127.0.0.1:1", &["--ask"]);
    assert_eq!(refused["answer"]["state"], "failed");
    // It was not checked whether the port is free.
    let asked = halfrow(["boards", "--ask", "tcp:127.0.0.1:1"]).stdout;
    assert!(asked.contains("    cannot be asked: "), "{asked}");
    let text = halfrow(["boards", "serial:/dev/ttyUSB99"]).stdout;
    assert!(text.contains("is not there; check that the board is plugged in"), "{text}");
}

#[test]
fn a_port_in_use_is_busy_and_its_holder_is_named() {
    let served = Served::on_a_serial_port("mock");
    let held = link::open(&served.target().parse().unwrap()).unwrap();
    let looked = look_at(&served.target(), &["--ask"]);
    assert_eq!((&looked["access"]["state"], &looked["answer"]), (&json!("busy"), &Value::Null));
    assert_eq!(looked["access"]["holders"][0]["process"], std::process::id());
    drop(held);
    assert_eq!(free_and_asked(&served)["answer"]["state"], "board");
}

#[test]
fn a_board_that_another_host_holds_is_left_to_it() {
    for served in [Served::on_a_serial_port("mock"), Served::on_a_tcp_port("127.0.0.1", "mock")] {
        let link = link::open(&served.target().parse().unwrap()).unwrap().link;
        let options = OpenOptions::default();
        drop(Board::open(link, &options).unwrap());
        assert_eq!(free_and_asked(&served)["answer"], json!({ "state": "held" }));
    }
}

/// Two programs with default options draw their own numbers, so they are two hosts.
#[test]
fn a_session_that_is_dropped_holds_the_board_and_one_that_was_closed_does_not() {
    let served = Served::on_a_tcp_port("127.0.0.1", "mock");
    let link = || link::open(&served.target().parse().unwrap()).unwrap().link;
    let options = OpenOptions::default;
    let ended_early = Board::with(link(), &options(), |_| Err::<(), _>("early"));
    assert_eq!(ended_early.unwrap(), Err("early"));
    drop(Board::open(link(), &options()).unwrap());
    let refused = Board::open(link(), &options()).map(drop).map_err(|failed| failed.error);
    assert!(matches!(refused, Err(BoardError::Held { .. })), "{refused:?}");
}

/// A GPS receiver, a console, or a board at another rate.
#[test]
fn what_talks_and_is_no_board_is_told_from_silence() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let target = format!("tcp:{}", listener.local_addr().unwrap());
    let receiver = std::thread::spawn(move || {
        for _ in 0..2 {
            let (mut host, _) = listener.accept().unwrap();
            let mut heard = [0; 256];
            while host.read(&mut heard).is_ok_and(|read| read > 0) {
                // The host may be gone by now.
                let _ = host.write_all(b"$GPGGA,,,,,,0,,,,,,,,*66\r\n");
            }
        }
    });
    let answer = look_at(&target, &["--ask"])["answer"].clone();
    assert_eq!(answer["state"], "babble", "{answer}");
    let bytes = answer["bytes"].as_u64().unwrap();
    assert!(bytes > 0 && bytes.is_multiple_of(26), "{answer}");
    let text = halfrow(["boards", "--ask", &target]).stdout;
    assert!(text.contains("something talks that is no halfrow board, or is one at another rate: "), "{text}");
    assert!(text.contains(" bytes came, no answer among them"), "{text}");
    receiver.join().unwrap();
}

/// A loopback plug returns what is sent; a modem or the console of a system says something of its own as well.
#[test]
fn what_echoes_is_another_device_and_no_port_that_cannot_be_asked() {
    for (own, said) in [("", "the line returns what is sent to it"), ("\r\nERROR\r\n", "has a console")] {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let target = format!("tcp:{}", listener.local_addr().unwrap());
        let echo = std::thread::spawn(move || {
            let (mut host, _) = listener.accept().unwrap();
            let mut heard = [0; 256];
            while let Ok(read @ 1..) = host.read(&mut heard) {
                // The host may be gone by now.
                let _ = host.write_all(&[&heard[..read], own.as_bytes()].concat());
            }
        });
        let answer = look_at(&target, &["--ask"])["answer"].clone();
        assert_eq!(answer["state"], "foreign", "{answer}");
        assert!(answer["reason"].as_str().unwrap().contains(said), "{answer}");
        echo.join().unwrap();
    }
}
