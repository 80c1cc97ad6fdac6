//! Bytes both ways, with and without a buffer.

use std::time::Duration;

use halfrow_mock::catalogue;
use halfrow_pipe::Place;
use proptest::prelude::*;

use crate::support::{answer, echo, echo_reply, hello, wire};

/// Twenty requests whose answers are as long as they are, and those answers.
fn requests() -> (Vec<u8>, Vec<u8>) {
    let texts: Vec<Vec<u8>> =
        (1..=20_u16).map(|number| (0..100 * number).map(|byte| byte as u8).collect()).collect();
    let numbered = || (1..).zip(&texts);
    let sent = numbered().flat_map(|(number, text)| echo(number, text)).collect();
    let expected = numbered().flat_map(|(number, text)| echo_reply(number, text)).collect();
    (sent, expected)
}

#[test]
fn a_sound_wire_changes_nothing() {
    let (sent, expected) = requests();
    let wires = [
        vec![],
        vec![("speed", "1000000")],
        vec![("speed", "1000000"), ("delay", "0.001"), ("buffer", "100")],
        vec![("buffer", "1")],
        vec![("buffer", "0")],
        vec![("buffer", "0"), ("speed", "1000000"), ("delay", "0.001")],
    ];
    for options in wires {
        let mut wire = wire(&options);
        answer(&mut wire, &hello());
        assert_eq!(answer(&mut wire, &sent), expected, "{options:?}");
    }
}

#[test]
fn a_buffer_takes_in_no_more_than_it_holds() {
    let mut wire = wire(&[("buffer", "100"), ("speed", "1000")]);
    let mut incoming = Vec::new();
    let sent = echo(1, &[1; 300]);
    assert_eq!(wire.exchange(&sent, &mut incoming, Duration::from_secs(1)), Ok(100));
    assert_eq!(wire.exchange(&sent[100..], &mut incoming, Duration::from_millis(99)), Ok(0));
    assert_eq!(wire.exchange(&sent[100..], &mut incoming, Duration::from_millis(1)), Ok(100));
    assert_eq!(wire.now(), Duration::from_millis(100), "when the first hundred have reached the board");
}

#[test]
fn without_a_buffer_nothing_is_taken_while_the_board_has_something_to_say() {
    let mut wire = wire(&[("buffer", "0"), ("speed", "1000")]);
    let (mut incoming, second) = (Vec::new(), [1; 20]);
    assert_eq!(wire.exchange(&hello(), &mut incoming, Duration::ZERO), Ok(30));
    // The board has it at 30 ms, and the host has its 41 bytes at 71 ms.
    assert_eq!(wire.exchange(&second, &mut incoming, Duration::from_millis(70)), Ok(0));
    assert_eq!(incoming.len(), 0);
    assert_eq!(wire.exchange(&second, &mut incoming, Duration::from_millis(1)), Ok(0));
    assert_eq!(incoming.len(), 41);
    assert_eq!(wire.exchange(&second, &mut incoming, Duration::ZERO), Ok(20));
}

#[test]
fn without_a_buffer_a_wire_without_limit_takes_bytes_only_up_to_an_answer() {
    let mut wire = wire(&[("buffer", "0")]);
    answer(&mut wire, &hello());
    // Two requests of 516 bytes, which COBS makes 518; with a zero on either side, 520. The board answers during the second
    // slice of 512, and then the host has to listen.
    let sent = [echo(1, &[1; 500]), echo(2, &[2; 500])].concat();
    assert_eq!(sent.len(), 2 * 520);
    let (mut incoming, before) = (Vec::new(), wire.now());
    assert_eq!(wire.exchange(&sent, &mut incoming, Duration::ZERO), Ok(1024));
    assert_eq!(incoming, echo_reply(1, &[1; 500]));
    assert_eq!(wire.exchange(&sent[1024..], &mut incoming, Duration::ZERO), Ok(16));
    assert_eq!(incoming, [echo_reply(1, &[1; 500]), echo_reply(2, &[2; 500])].concat());
    assert_eq!(wire.now(), before);
}

#[test]
fn without_a_buffer_the_board_is_listened_to_even_if_its_words_get_lost() {
    let options =
        [("buffer", "0"), ("speed", "1000"), ("fault", "drop"), ("packet", "1"), ("toward", "host")];
    let mut wire = wire(&options);
    answer(&mut wire, &hello());
    // Request and answer have 1000 + 16 bytes, 4 of COBS and two zeros.
    let (sent, before) = (echo(1, &[1; 1000]), wire.now());
    assert_eq!((sent.len(), echo_reply(1, &[1; 1000]).len()), (1022, 1022));
    let mut incoming = Vec::new();
    assert_eq!(wire.exchange(&sent, &mut incoming, Duration::ZERO), Ok(512));
    assert_eq!(wire.exchange(&sent[512..], &mut incoming, Duration::from_secs(1)), Ok(510));
    // The request reaches the board at 1.022 s. The zero before the answer comes in its first slice, the one after it in the
    // second.
    assert_eq!(wire.exchange(&[2], &mut incoming, Duration::from_secs(9)), Ok(0));
    assert_eq!((wire.now() - before, incoming.len()), (Duration::from_millis(1534), 1));
    assert_eq!(wire.exchange(&[2], &mut incoming, Duration::from_secs(9)), Ok(0));
    assert_eq!((wire.now() - before, incoming.len()), (Duration::from_millis(2044), 2));
    assert_eq!(wire.exchange(&[2], &mut incoming, Duration::ZERO), Ok(1));
}

proptest! {
    #[test]
    fn whatever_is_sent_over_whatever_wire_the_clock_goes_on_and_all_is_taken(
        fault in prop::sample::select(catalogue().collect::<Vec<_>>()),
        place in prop::sample::select(vec![("packet", "1"), ("rate", "0.2"), ("rate", "1")]),
        (buffer, speed) in (prop::sample::select(vec!["0", "1", "700"]), prop::sample::select(vec!["7", "1000000000000"])),
        // Many zeros, so that there are packets.
        sent in prop::collection::vec(prop_oneof![Just(0), any::<u8>()], 0..2000),
    ) {
        let mut options = vec![("fault", fault.name), ("buffer", buffer), ("speed", speed)];
        options.extend((fault.place == Place::Pipe).then_some(place));
        let mut wire = wire(&options);
        let (mut rest, mut incoming) = (sent.as_slice(), Vec::new());
        while !rest.is_empty() {
            let before = (wire.now(), rest.len(), incoming.len());
            let Ok(taken) = wire.exchange(rest, &mut incoming, Duration::from_secs(10)) else {
                prop_assert_eq!(fault.name, "disconnect");
                break;
            };
            rest = &rest[taken..];
            prop_assert!(wire.now() >= before.0);
            prop_assert_ne!((wire.now(), rest.len(), incoming.len()), before, "neither bytes nor time move");
        }
    }
}
