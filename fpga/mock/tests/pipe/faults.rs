//! Faults between a host and a board.

use std::time::Duration;

use halfrow_pipe::{Broken, FAULTS, Parameters};

use crate::support::{answer, echo, echo_reply, hello, sequences, status, talk, wire};

/// HELLO, which is packet 0 either way, and ten requests with the sequence numbers 1 to 10.
fn conversation() -> Vec<u8> {
    let requests = (1..=10).flat_map(|number| echo(number, &[number as u8; 50]));
    hello().into_iter().chain(requests).collect()
}

/// What the host hears in reply on a sound wire, after the answer to HELLO.
fn replies() -> Vec<Vec<u8>> {
    (1..=10).map(|number| echo_reply(number, &[number as u8; 50])).collect()
}

fn heard(options: &[(&str, &str)]) -> Vec<u16> {
    sequences(&answer(&mut wire(options), &conversation()))
}

#[test]
fn a_fault_towards_the_host_spoils_just_the_bytes_that_it_names() {
    let sound = answer(&mut wire(&[]), &conversation());
    assert!(sound.ends_with(&replies().concat()), "the answers are those that the protocol says");
    for byte in [0, 57, sound.len() - 1] {
        let number = byte.to_string();
        let spoilt = |name| {
            let options = [("fault", name), ("byte", number.as_str()), ("toward", "host")];
            answer(&mut wire(&options), &conversation())
        };
        let (before, after) = sound.split_at(byte);
        assert_eq!(spoilt("drop"), [before, &after[1..]].concat());
        assert_eq!(spoilt("duplicate"), [before, &after[..1], after].concat());
        let flipped = spoilt("flip");
        let bits: u32 = flipped.iter().zip(&sound).map(|(one, other)| (one ^ other).count_ones()).sum();
        assert_eq!((flipped.len(), bits), (sound.len(), 1));
        assert_ne!(flipped[byte], sound[byte]);
    }
}

#[test]
fn packets_towards_the_board_suffer_before_it_answers() {
    let toward = |name| heard(&[("fault", name), ("packet", "3"), ("toward", "board")]);
    assert_eq!(toward("drop"), [0, 1, 2, 4, 5, 6, 7, 8, 9, 10]);
    assert_eq!(toward("flip"), [0, 1, 2, 4, 5, 6, 7, 8, 9, 10]);
    assert_eq!(toward("truncate"), [0, 1, 2, 4, 5, 6, 7, 8, 9, 10]);
    assert_eq!(toward("duplicate"), [0, 1, 2, 3, 3, 4, 5, 6, 7, 8, 9, 10]);
    assert_eq!(toward("reorder"), [0, 1, 2, 4, 3, 5, 6, 7, 8, 9, 10]);
}

#[test]
fn both_directions_suffer_by_default() {
    // The request of packet 3 is lost, and so is the fourth answer from the board, which is the one to packet 4.
    assert_eq!(heard(&[("fault", "drop"), ("packet", "3")]), [0, 1, 2, 5, 6, 7, 8, 9, 10]);
}

#[test]
fn the_board_counts_what_reached_it_damaged() {
    let mut wire = wire(&[("fault", "flip"), ("packet", "3"), ("toward", "board")]);
    answer(&mut wire, &conversation());
    let status = status(&mut wire);
    // A new session clears the counters, so HELLO itself is not counted: nine requests and STATUS are.
    assert_eq!((status.packets, status.damaged()), (10, 1));
}

#[test]
fn a_stall_ends_and_spoils_nothing() {
    let options = [("fault", "stall"), ("packet", "3"), ("seconds", "2.5"), ("toward", "host")];
    let mut wire = wire(&options);
    let (sent, mut incoming) = (conversation(), Vec::new());
    assert_eq!(wire.exchange(&sent, &mut incoming, Duration::ZERO), Ok(sent.len()));
    assert_eq!(sequences(&incoming), [0, 1, 2]);
    assert_eq!(wire.exchange(&[], &mut incoming, Duration::from_millis(2499)), Ok(0));
    assert_eq!(sequences(&incoming), [0, 1, 2]);
    assert_eq!(wire.exchange(&[], &mut incoming, Duration::from_secs(9)), Ok(0));
    assert_eq!(wire.now(), Duration::from_millis(2500));
    assert_eq!(sequences(&incoming), [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10]);
}

#[test]
fn a_broken_wire_stays_broken() {
    let options = [("fault", "disconnect"), ("packet", "3"), ("toward", "board"), ("speed", "1000")];
    let mut wire = wire(&options);
    let (incoming, done) = talk(&mut wire, &conversation());
    // HELLO has 30 bytes and an ECHO of 50 bytes has 69. Two requests arrive earlier in the slice that breaks the wire, at 512
    // ms; their answers are under way when it breaks.
    let broken = done.unwrap_err();
    let at = Duration::from_millis(512);
    assert_eq!((sequences(&incoming), &broken), (vec![], &Broken::Disconnected { at }));
    for wait in [0, 1000] {
        let mut incoming = Vec::new();
        let again = wire.exchange(&hello(), &mut incoming, Duration::from_secs(wait));
        assert_eq!((again, incoming), (Err(broken.clone()), vec![]));
    }
    assert_eq!(wire.now(), at, "the clock of a broken wire stands still");
}

#[test]
fn what_moved_when_the_wire_broke_is_not_lost() {
    let mut wire = wire(&[("fault", "disconnect"), ("packet", "3"), ("toward", "host")]);
    let (sent, mut incoming) = (conversation(), Vec::new());
    assert_eq!(wire.exchange(&sent, &mut incoming, Duration::from_secs(1)), Ok(sent.len()));
    assert_eq!(sequences(&incoming), [0, 1, 2]);
    assert!(wire.exchange(&[], &mut incoming, Duration::from_secs(1)).is_err());
}

#[test]
fn a_run_comes_out_the_same_again_and_with_another_seed_otherwise() {
    for name in ["flip", "drop", "duplicate", "reorder", "truncate"] {
        let rate = if ["reorder", "truncate"].contains(&name) { "0.3" } else { "0.01" };
        let run = |seed| {
            let options = [("fault", name), ("rate", rate), ("seed", seed), ("speed", "10000")];
            let mut wire = wire(&options);
            (talk(&mut wire, &conversation()).0, wire.now())
        };
        assert_eq!(run("1"), run("1"), "{name}");
        assert_ne!(run("1").0, run("2").0, "{name}");
    }
}

#[test]
fn what_the_summary_says_is_what_holds_without_parameters() {
    for fault in FAULTS {
        let summary = fault.info.summary();
        let words = summary.split(|letter| " ,()".contains(letter));
        let mut said: Parameters = words
            .filter_map(|word| word.split_once('='))
            .filter(|(_, value)| *value != "N")
            .map(|(key, value)| (key.to_owned(), value.to_owned()))
            .collect();
        assert!(said.len() >= 3, "{summary}");
        assert_eq!(fault.make(&mut said), fault.make(&mut Parameters::new()), "{summary}");
        assert!(said.is_empty(), "{} has no {said:?}", fault.info.name);
    }
}

#[test]
fn every_place_that_a_fault_lists_makes_another_fault() {
    for fault in FAULTS {
        let default = fault.make(&mut Parameters::new()).unwrap();
        let mut made = vec![default];
        for key in ["byte", "packet", "rate"].into_iter().filter(|key| fault.info.takes(key)) {
            let other = fault.make(&mut Parameters::from([(key.to_owned(), "1".to_owned())])).unwrap();
            assert!(!made.contains(&other), "{key} of {}", fault.info.name);
            made.push(other);
        }
        assert!(made.len() > 2, "{} strikes at one place alone", fault.info.name);
    }
}
