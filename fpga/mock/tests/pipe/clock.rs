//! The virtual clock.

use std::time::{Duration, Instant};

use halfrow_mock::{Board, Options};
use halfrow_pipe::{Pipe, PipeOptions};

use crate::support::{SILENCE, answer, echo, hello, wire};

/// The time at which the answer to `bytes` is complete.
fn answered_at(wire: &mut Pipe<Board>, bytes: &[u8]) -> Duration {
    let (mut rest, mut incoming, mut last) = (bytes, Vec::new(), Duration::ZERO);
    loop {
        let heard = incoming.len();
        let taken = wire.exchange(rest, &mut incoming, SILENCE).unwrap();
        rest = &rest[taken..];
        if incoming.len() > heard {
            last = wire.now();
        } else if taken == 0 {
            return last;
        }
    }
}

#[test]
fn an_answer_takes_the_time_of_its_bytes_and_the_delay_both_ways() {
    // HELLO has 12 + 11 + 4 bytes; COBS adds 1 and there is a zero on either side: 30. Its reply has 22 bytes of payload: 41.
    // At 100 bytes/s the board has the request after 0.3 + 0.5 s, and the host the reply after 0.8 + 0.41 + 0.5 s.
    let mut wire = wire(&[("speed", "100"), ("delay", "0.5")]);
    assert_eq!(hello().len(), 30);
    assert_eq!(answered_at(&mut wire, &hello()), Duration::from_millis(1710));
}

#[test]
fn time_stands_still_while_bytes_move_without_limit() {
    let mut wire = wire(&[]);
    let (mut incoming, mut sent) = (Vec::new(), hello());
    sent.extend(echo(1, &[3; 4000]));
    assert_eq!(wire.exchange(&sent, &mut incoming, Duration::from_secs(1)), Ok(sent.len()));
    assert!(incoming.len() > 4000, "the answer comes at the same instant");
    assert_eq!(wire.now(), Duration::ZERO);
}

#[test]
fn waiting_for_nothing_takes_just_the_time_that_was_asked_for() {
    let mut wire = wire(&[("speed", "1000"), ("delay", "1")]);
    let mut incoming = Vec::new();
    assert_eq!(wire.exchange(&[], &mut incoming, Duration::from_millis(70)), Ok(0));
    assert_eq!(wire.now(), Duration::from_millis(70));
}

#[test]
fn a_wait_ends_before_an_arrival_that_is_later() {
    let mut wire = wire(&[("speed", "100"), ("delay", "0.5")]);
    let mut incoming = Vec::new();
    assert_eq!(wire.exchange(&hello(), &mut incoming, Duration::from_secs(9)), Ok(30));
    assert_eq!(wire.now(), Duration::ZERO, "taken at once");
    assert_eq!(wire.exchange(&[], &mut incoming, Duration::from_millis(1709)), Ok(0));
    assert_eq!((wire.now(), incoming.len()), (Duration::from_millis(1709), 0));
    assert_eq!(wire.exchange(&[], &mut incoming, Duration::from_millis(1)), Ok(0));
    assert_eq!((wire.now(), incoming.len()), (Duration::from_millis(1710), 41));
}

#[test]
fn no_wait_moves_no_time() {
    let mut wire = wire(&[("speed", "100")]);
    let mut incoming = Vec::new();
    assert_eq!(wire.exchange(&hello(), &mut incoming, Duration::ZERO), Ok(30));
    for _ in 0..10 {
        assert_eq!(wire.exchange(&[], &mut incoming, Duration::ZERO), Ok(0));
    }
    assert_eq!((wire.now(), incoming.len()), (Duration::ZERO, 0));
}

#[test]
fn the_longest_wait_ends_at_the_end_of_time() {
    let mut wire = wire(&[]);
    assert_eq!(wire.exchange(&[], &mut Vec::new(), Duration::MAX), Ok(0));
    assert_eq!(wire.exchange(&[], &mut Vec::new(), Duration::MAX), Ok(0));
    assert_eq!(wire.now(), Duration::MAX);
}

#[test]
fn two_hours_on_the_wire_pass_in_no_time() {
    let begun = Instant::now();
    let mut wire = wire(&[("speed", "1")]);
    answer(&mut wire, &hello());
    // 4016 bytes. The run of 4004 bytes without a zero needs 15 codes besides the first; with a zero on either side that makes
    // 4034 s there and 4034 s back.
    let (sent, before) = (echo(1, &[3; 4000]), wire.now());
    assert_eq!(sent.len(), 4034);
    assert_eq!(answered_at(&mut wire, &sent) - before, Duration::from_secs(8068));
    assert!(begun.elapsed() < Duration::from_secs(4000));
}

#[test]
fn the_rate_is_the_one_that_was_asked_for() {
    assert_eq!(wire(&[]).bytes_per_second(), None);
    assert_eq!(wire(&[("speed", "1200000")]).bytes_per_second(), Some(1.2e6));
    let board = Board::new(&Options::default(), None).unwrap();
    assert_eq!(Pipe::new(board, PipeOptions::default(), None).bytes_per_second(), None);
}
