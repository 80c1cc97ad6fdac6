//! Streams before and after each fault, written by hand.

use std::time::Duration;

use super::*;
use crate::{FAULTS, Fault, Parameters};

/// Packets at bytes 1 to 3, 6 to 9, and 11 to 12.
const STREAM: &[u8] = b"\0abc\0\0defg\0hi\0";

fn damage(name: &str, parameters: &[(&str, &str)]) -> Damage {
    let mut parameters: Parameters =
        parameters.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    let fault = Fault::find(FAULTS, name).unwrap().make(&mut parameters).unwrap();
    assert_eq!(parameters, Parameters::new(), "what was given is of use");
    Damage::new(Some(fault), Side::Host)
}

fn spoilt(name: &str, parameters: &[(&str, &str)], stream: &[u8]) -> Vec<u8> {
    let mut out = Vec::new();
    let passage = damage(name, parameters).pass(stream, &mut out);
    assert_eq!(passage, Passage { bytes: stream.len(), interruption: None });
    out
}

/// Where two streams of the same length differ, bit by bit.
fn flipped_bits(one: &[u8], other: &[u8]) -> Vec<usize> {
    assert_eq!(one.len(), other.len());
    (0..8 * one.len()).filter(|bit| (one[bit / 8] ^ other[bit / 8]) >> (bit % 8) & 1 == 1).collect()
}

#[test]
fn one_byte_gets_lost_or_comes_twice() {
    assert_eq!(spoilt("drop", &[("byte", "2")], STREAM), b"\0ac\0\0defg\0hi\0");
    assert_eq!(spoilt("drop", &[("byte", "4")], STREAM), b"\0abc\0defg\0hi\0");
    assert_eq!(spoilt("duplicate", &[("byte", "2")], STREAM), b"\0abbc\0\0defg\0hi\0");
    assert_eq!(spoilt("drop", &[("byte", "14")], STREAM), STREAM);
}

#[test]
fn one_packet_gets_lost_or_comes_twice() {
    assert_eq!(spoilt("drop", &[("packet", "1")], STREAM), b"\0abc\0\0\0hi\0");
    assert_eq!(spoilt("duplicate", &[("packet", "1")], STREAM), b"\0abc\0\0defg\0defg\0hi\0");
    assert_eq!(spoilt("drop", &[("packet", "3")], STREAM), STREAM);
}

#[test]
fn packets_that_are_not_short_get_lost_whole() {
    assert_eq!(spoilt("lose", &[("size", "3"), ("rate", "1")], STREAM), b"\0\0\0\0hi\0");
    assert_eq!(spoilt("lose", &[("size", "3"), ("packet", "1")], STREAM), b"\0abc\0\0\0hi\0");
    assert_eq!(spoilt("lose", &[("size", "5"), ("rate", "1")], STREAM), STREAM);
    assert_eq!(spoilt("lose", &[("size", "3"), ("rate", "0")], STREAM), STREAM);
}

#[test]
fn a_stream_stands_still_behind_every_so_many_bytes() {
    let mut damage = damage("stall", &[("every", "5"), ("seconds", "2")]);
    let (mut out, mut rest) = (Vec::new(), STREAM);
    let mut passed = Vec::new();
    while !rest.is_empty() {
        let passage = damage.pass(rest, &mut out);
        let stall = Interruption::Stall(Duration::from_secs(2));
        assert_eq!(passage.interruption, (passage.bytes < rest.len()).then_some(stall));
        passed.push(passage.bytes);
        rest = &rest[passage.bytes..];
    }
    assert_eq!((out.as_slice(), passed), (STREAM, vec![5, 5, 4]));
}

#[test]
fn one_bit_flips_of_a_byte() {
    let mut bits: Vec<_> = (0..100)
        .map(|seed| {
            let seed = seed.to_string();
            flipped_bits(&spoilt("flip", &[("byte", "7"), ("seed", &seed)], STREAM), STREAM)
        })
        .collect();
    bits.sort_unstable();
    bits.dedup();
    assert_eq!(bits, (56..64).map(|bit| vec![bit]).collect::<Vec<_>>(), "every bit of it, always one");
}

#[test]
fn one_bit_flips_of_a_packet() {
    let mut bits: Vec<_> = (0..1000)
        .map(|seed| {
            let seed = seed.to_string();
            flipped_bits(&spoilt("flip", &[("packet", "1"), ("seed", &seed)], STREAM), STREAM)
        })
        .collect();
    bits.sort_unstable();
    bits.dedup();
    assert_eq!(bits, (48..80).map(|bit| vec![bit]).collect::<Vec<_>>(), "every bit of it, always one");
}

#[test]
fn a_packet_ends_at_a_byte() {
    assert_eq!(spoilt("truncate", &[("byte", "7")], STREAM), b"\0abc\0\0d\0hi\0");
    assert_eq!(spoilt("truncate", &[("byte", "6")], STREAM), b"\0abc\0\0\0hi\0");
    assert_eq!(spoilt("truncate", &[("byte", "5")], STREAM), STREAM, "a zero is no part of a packet");
}

#[test]
fn a_packet_ends_anywhere() {
    let mut kept: Vec<_> = (0..100)
        .map(|seed| spoilt("truncate", &[("packet", "1"), ("seed", &seed.to_string())], STREAM))
        .collect();
    kept.sort_unstable();
    kept.dedup();
    let expected =
        [b"\0abc\0\0\0hi\0".as_slice(), b"\0abc\0\0d\0hi\0", b"\0abc\0\0de\0hi\0", b"\0abc\0\0def\0hi\0"];
    assert_eq!(kept, expected);
}

#[test]
fn a_packet_is_overtaken_by_the_next() {
    assert_eq!(spoilt("reorder", &[("packet", "0")], STREAM), b"\0\0\0defg\0abc\0hi\0");
    assert_eq!(spoilt("reorder", &[("packet", "1")], STREAM), b"\0abc\0\0\0hi\0defg\0");
    assert_eq!(spoilt("reorder", &[("rate", "1")], b"a\0b\0c\0d\0"), b"\0b\0a\0\0d\0c\0");
}

#[test]
fn an_overtaken_packet_waits_for_the_next() {
    let mut damage = damage("reorder", &[("packet", "2")]);
    let mut out = Vec::new();
    damage.pass(STREAM, &mut out);
    assert_eq!(out, b"\0abc\0\0defg\0\0");
    out.clear();
    damage.pass(b"\0jk\0", &mut out);
    assert_eq!(out, b"\0jk\0hi\0");
}

#[test]
fn rate_1_strikes_everything() {
    assert_eq!(spoilt("drop", &[("rate", "1")], STREAM), b"");
    assert_eq!(spoilt("duplicate", &[("rate", "1")], b"\0ab\0"), b"\0\0aabb\0\0");
    assert_eq!(flipped_bits(&spoilt("flip", &[("rate", "1")], STREAM), STREAM).len(), STREAM.len());
    let truncated = spoilt("truncate", &[("rate", "1")], STREAM);
    assert_eq!(truncated.iter().filter(|&&byte| byte == 0).count(), 5);
    assert!(truncated.len() <= STREAM.len() - 3);
}

#[test]
fn bytes_are_struck_at_the_given_rate() {
    // 10^6 bytes at 10^-3: 1000 strikes, standard deviation 31.6; five of them either way.
    let clean = vec![0x55; 1_000_000];
    let struck = |name| spoilt(name, &[("rate", "1e-3"), ("seed", "9")], &clean);
    for count in [
        clean.len() - struck("drop").len(),
        struck("duplicate").len() - clean.len(),
        flipped_bits(&struck("flip"), &clean).len(),
    ] {
        assert!((842..=1158).contains(&count), "{count} strikes");
    }
}

#[test]
fn packets_are_struck_at_the_given_rate() {
    // 10^5 packets of two bytes at 10^-2: 1000 strikes, standard deviation 31.5; five of them either way.
    let clean: Vec<u8> = (0..100_000).flat_map(|packet| [1 + (packet % 250) as u8, 7, 0]).collect();
    let truncated = spoilt("truncate", &[("rate", "0.01")], &clean);
    let damaged = truncated.split(|&byte| byte == 0).filter(|packet| packet.len() < 2).count() - 1;
    assert!((842..=1158).contains(&damaged), "{damaged} packets end early");
    let reordered = spoilt("reorder", &[("rate", "0.01")], &clean);
    let names: Vec<_> = reordered
        .split(|&byte| byte == 0)
        .filter_map(|packet| packet.first().copied().map(i32::from))
        .collect();
    let overtaken = names.windows(2).filter(|pair| (pair[0] - pair[1]).rem_euclid(250) == 1).count();
    assert!((842..=1158).contains(&overtaken), "{overtaken} packets are late");
}

#[test]
fn a_stream_stands_still_before_its_place() {
    let places = [("byte", "7", 7), ("byte", "0", 0), ("packet", "0", 1), ("packet", "1", 6)];
    for (key, number, place) in places {
        let mut damage = damage("stall", &[(key, number), ("seconds", "0.25")]);
        let mut out = Vec::new();
        let stall = Some(Interruption::Stall(Duration::from_millis(250)));
        assert_eq!(damage.pass(STREAM, &mut out), Passage { bytes: place, interruption: stall });
        assert_eq!(out, &STREAM[..place]);
        let rest = Passage { bytes: STREAM.len() - place, interruption: None };
        assert_eq!(damage.pass(&STREAM[place..], &mut out), rest);
        assert_eq!(out, STREAM, "a stall spoils nothing");
    }
}

#[test]
fn a_stall_does_not_see_how_the_stream_is_cut() {
    for (key, number, place) in [("byte", "7", 7), ("packet", "1", 6)] {
        let mut damage = damage("stall", &[(key, number)]);
        let mut out = Vec::new();
        let stops = |byte| damage.pass(&[byte], &mut out).interruption.is_some();
        assert_eq!(STREAM.iter().copied().position(stops), Some(place));
    }
}

#[test]
fn a_rate_of_stalls_is_one_of_packets() {
    let mut damage = damage("stall", &[("rate", "1")]);
    let (mut rest, mut places, mut out) = (STREAM, Vec::new(), Vec::new());
    loop {
        let passage = damage.pass(rest, &mut out);
        rest = &rest[passage.bytes..];
        if passage.interruption.is_none() {
            break;
        }
        places.push(STREAM.len() - rest.len());
    }
    assert_eq!(places, [1, 6, 11]);
}

#[test]
fn a_wire_breaks_before_its_place() {
    for (key, number, place) in [("byte", "12", 12), ("packet", "2", 11)] {
        let mut out = Vec::new();
        let passage = damage("disconnect", &[(key, number)]).pass(STREAM, &mut out);
        assert_eq!(passage, Passage { bytes: place, interruption: Some(Interruption::Disconnect) });
        assert_eq!(out, &STREAM[..place]);
    }
}

#[test]
fn a_fault_does_not_see_how_the_stream_is_cut() {
    let names = ["flip", "drop", "duplicate", "reorder", "truncate"];
    let places = [("packet", "1"), ("rate", "0.4")];
    for (name, place) in names.into_iter().flat_map(|name| places.map(|place| (name, place))) {
        let mut bytewise = damage(name, &[place]);
        let mut out = Vec::new();
        STREAM.iter().for_each(|byte| _ = bytewise.pass(&[*byte], &mut out));
        assert_eq!(out, spoilt(name, &[place], STREAM), "{name} {place:?}");
    }
    for name in ["flip", "drop", "duplicate", "truncate"] {
        let mut bytewise = damage(name, &[("byte", "7")]);
        let mut out = Vec::new();
        STREAM.iter().for_each(|byte| _ = bytewise.pass(&[*byte], &mut out));
        assert_eq!(out, spoilt(name, &[("byte", "7")], STREAM), "{name}");
    }
}

#[test]
fn a_direction_can_be_spared() {
    let mut parameters = Parameters::from([("toward".to_owned(), "board".to_owned())]);
    let fault = Fault::find(FAULTS, "drop").unwrap().make(&mut parameters).unwrap();
    assert!(matches!(Damage::new(Some(fault), Side::Host), Damage::None));
    assert!(matches!(Damage::new(Some(fault), Side::Board), Damage::Bytes(_)));
}

#[test]
fn the_directions_throw_their_own_dice() {
    let mut parameters = Parameters::from([("rate".to_owned(), "0.5".to_owned())]);
    let fault = Fault::find(FAULTS, "drop").unwrap().make(&mut parameters).unwrap();
    let left = |side| {
        let mut out = Vec::new();
        Damage::new(Some(fault), side).pass(&(1..=100).collect::<Vec<u8>>(), &mut out);
        out
    };
    assert_eq!(left(Side::Host), left(Side::Host));
    assert_ne!(left(Side::Host), left(Side::Board));
}
