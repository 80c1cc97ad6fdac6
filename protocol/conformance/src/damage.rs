//! Section 1 of WIRE.md: bytes that are not a packet are counted and never answered.

use halfrow_protocol::message::Request;
use halfrow_protocol::{Header, Kind, MAX_PACKET};

use crate::Boards;
use crate::bench::{Bench, wire};

/// Whole packets without the STATUS itself, CRC errors, and framing errors since the session began.
fn counted(bench: &mut Bench) -> (u32, u32, u32) {
    let status = bench.status();
    (status.packets - 1, status.crc_errors, status.framing_errors)
}

/// A packet between zeros, stuffed by hand: `body` holds no zero and is short.
fn stuffed(body: &[u8]) -> Vec<u8> {
    [&[0, body.len() as u8 + 1], body, &[0]].concat()
}

/// A packet with its CRC, stuffed by hand.
fn sealed(body: &[u8]) -> Vec<u8> {
    let packet = [body, &crc32fast::hash(body).to_le_bytes()].concat();
    let mut wire = vec![0];
    for piece in packet.split(|&byte| byte == 0) {
        wire.push(piece.len() as u8 + 1);
        wire.extend_from_slice(piece);
    }
    wire.push(0);
    wire
}

/// The body of an ECHO of three bytes, with these fields.
fn echo_body(session: u8, version: u8, length: u8) -> [u8; 15] {
    [version, Kind::Echo.code(), 7, 0, length, 0, 0, session, 0, 0, 0, 0, b'a', b'b', b'c']
}

pub(crate) fn a_flipped_bit_anywhere_is_a_crc_error_or_broken_framing(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    let whole = bench.packet(&Request::Echo(b"some bytes, none of them zero"));
    for place in 1..whole.len() - 1 {
        let mut damaged = whole.clone();
        damaged[place] ^= 0x40;
        assert_eq!(bench.receive(&damaged), [], "byte {place}");
    }
    let (packets, crc_errors, framing_errors) = counted(&mut bench);
    assert_eq!(packets, 0);
    assert!(crc_errors > 0 && framing_errors > 0);
    assert_eq!(bench.receive(&whole).len(), 1);
}

pub(crate) fn a_wrong_crc_is_a_crc_error(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    let mut damaged = sealed(&echo_body(bench.session, 1, 3));
    let last = damaged.len() - 2;
    damaged[last] = damaged[last].wrapping_add(1).max(1);
    assert_eq!(bench.receive(&damaged), []);
    assert_eq!(counted(&mut bench), (0, 1, 0));
}

pub(crate) fn broken_stuffing_is_a_framing_error(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    assert_eq!(bench.receive(&[0, 9, 1, 2, 0]), []);
    assert_eq!(counted(&mut bench), (0, 0, 1));
}

pub(crate) fn a_packet_that_is_too_short_is_a_framing_error(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    assert_eq!(bench.receive(&stuffed(&[1])), []);
    assert_eq!(bench.receive(&stuffed(&[1; 15])), []);
    assert_eq!(counted(&mut bench), (0, 0, 2));
}

pub(crate) fn a_packet_that_is_too_long_is_one_framing_error(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    let run = [vec![0], vec![1; MAX_PACKET + 100], vec![0]].concat();
    assert_eq!(bench.receive(&run), []);
    for chunk in vec![0xff; 100_000].chunks(77) {
        bench.receive(chunk);
    }
    assert_eq!(bench.receive(&[0]), []);
    assert_eq!(counted(&mut bench), (0, 0, 2));
}

pub(crate) fn another_version_or_length_is_a_framing_error(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    let session = bench.session;
    for (version, length) in [(0, 3), (2, 3), (1, 2), (1, 4)] {
        assert_eq!(bench.receive(&sealed(&echo_body(session, version, length))), []);
    }
    assert_eq!(bench.receive(&sealed(&echo_body(session, 1, 3))).len(), 1);
    assert_eq!(counted(&mut bench), (1, 0, 4));
}

pub(crate) fn zeros_are_no_packets(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    assert_eq!(bench.receive(&[0; 1000]), []);
    assert_eq!(counted(&mut bench), (0, 0, 0));
}

pub(crate) fn garbage_before_the_first_zero_is_counted(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    assert_eq!(bench.receive(&[7, 7, 7, 0]), []);
    assert_eq!(counted(&mut bench), (0, 0, 1));
}

pub(crate) fn damage_takes_one_packet_and_not_its_neighbours(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    let header = bench.header(Kind::Echo.code());
    let packet = |sequence| wire(&Header { sequence, ..header }, |payload| payload.extend(b"abc"));
    let mut middle = packet(2);
    middle.truncate(10);
    let heard = bench.receive(&[packet(1), middle, packet(3)].concat());
    let sequences: Vec<_> = heard.iter().map(|packet| packet.header.sequence).collect();
    assert_eq!(sequences, [1, 3]);
}

pub(crate) fn packets_may_come_in_pieces_of_any_size(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    for size in [1, 2, 3, 7, 100] {
        let bytes = [bench.packet(&Request::Echo(b"one")), bench.packet(&Request::Echo(b"two"))].concat();
        let heard: Vec<_> = bytes.chunks(size).flat_map(|chunk| bench.receive(chunk)).collect();
        let payloads: Vec<_> = heard.into_iter().map(|packet| packet.payload).collect();
        assert_eq!(payloads, [b"one", b"two"]);
    }
}
