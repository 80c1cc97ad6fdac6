//! The body of a fuzzer: takes any bytes, and panics if the wire breaks a promise.
//!
//! Any engine can drive [`decode`]; `fuzz.rs` does so with the frozen vectors and [`mutate`].

use halfrow_protocol::{
    Damage, Decoder, Encoder, Header, MAX_PACKET, MAX_PAYLOAD, Packet, Reply, Request, VERSION,
};

/// Bytes of a header and of a CRC, as section 1 of WIRE.md has them.
const HEADER: usize = 12;
const CRC: usize = 4;

/// What a decoder delivers, with its bytes copied.
type Event = Result<(Header, Vec<u8>), Damage>;

/// Treats `bytes` in turn as three things: what a link delivers; a packet without its CRC, which is added; and the code of a
/// kind with its payload.
///
/// Panics if a promise of the wire is broken: packets depend on how the bytes are cut into reads, a payload is over its limit,
/// a packet with a wrong length or version is accepted, or a message changes when it is written and read again.
pub(crate) fn decode(bytes: &[u8]) {
    check_stream(bytes);
    check_sealed(bytes);
    if let Some((&kind, payload)) = bytes.split_first() {
        let payload = &payload[..payload.len().min(MAX_PAYLOAD)];
        check_packet(&Packet { header: Header { kind, ..Header::default() }, payload });
    }
}

/// Damages `bytes` in one place, as a link would, or sets a byte to a limit value. `below(n)` draws a number below `n`; `n` is
/// never 0.
pub(crate) fn mutate(bytes: &mut Vec<u8>, below: &mut impl FnMut(usize) -> usize) {
    const LIMITS: [u8; 7] = [0, 1, 2, 0x7f, 0x80, 0xfe, 0xff];
    let place = below(bytes.len() + 1);
    let end = (place + below(16)).min(bytes.len());
    match below(6) {
        0 => bytes.truncate(place),
        1 => drop(bytes.drain(place..end)),
        2 => drop(bytes.splice(place..place, bytes[place..end].to_vec())),
        3 => drop(bytes.splice(place..place, (0..below(300)).map(|_| LIMITS[below(LIMITS.len())]))),
        4 => bytes.get_mut(place).into_iter().for_each(|byte| *byte ^= 1 << below(8)),
        _ => bytes.get_mut(place).into_iter().for_each(|byte| *byte = LIMITS[below(LIMITS.len())]),
    }
}

fn check_stream(bytes: &[u8]) {
    let events = events(bytes, bytes.len());
    for (header, payload) in events.iter().flatten() {
        check_packet(&Packet { header: *header, payload });
    }
    let read = bytes.first().map_or(1, |&byte| usize::from(byte) + 1);
    assert_eq!(self::events(bytes, read), events, "the packets depend on how the bytes were cut");
}

/// `body` is sent with the right CRC, so that only its size, version and length decide.
fn check_sealed(body: &[u8]) {
    let packet = [body, &crc32fast::hash(body).to_le_bytes()].concat();
    let wire = [&[0][..], &stuffed(&packet), &[0]].concat();
    let event = events(&wire, wire.len()).pop();
    match (damage_of(body), event) {
        (None, Some(Ok((header, payload)))) => {
            assert_eq!(Some(payload.as_slice()), body.get(HEADER..), "not the payload that was sent");
            check_packet(&Packet { header, payload: &payload });
        }
        (damage, event) => assert_eq!(event.map(Result::err), Some(damage)),
    }
}

/// A packet as section 1 of WIRE.md stuffs it: cut at its zeros and after every 254th byte, with a zero imagined at its end.
fn stuffed(packet: &[u8]) -> Vec<u8> {
    let mut wire = Vec::new();
    for between_zeros in packet.split(|&byte| byte == 0) {
        let pieces: Vec<_> = between_zeros.chunks(254).collect();
        let (last, full) = pieces.split_last().map_or((&[][..], &[][..]), |(last, full)| (*last, full));
        for piece in full {
            wire.push(255);
            wire.extend_from_slice(piece);
        }
        wire.push(last.len() as u8 + 1);
        wire.extend_from_slice(last);
        // A piece of 254 implies no zero; the zero after it is a piece of its own.
        if last.len() == 254 {
            wire.push(1);
        }
    }
    wire
}

/// The first check, in the order of section 1 of WIRE.md, that a packet with the right CRC fails.
fn damage_of(body: &[u8]) -> Option<Damage> {
    let Some((&[version, _, _, _, low, high, ..], payload)) = body.split_first_chunk::<HEADER>() else {
        return Some(Damage::Size);
    };
    if body.len() > MAX_PACKET - CRC {
        Some(Damage::Size)
    } else if version != VERSION {
        Some(Damage::Version(version))
    } else {
        (usize::from(u16::from_le_bytes([low, high])) != payload.len()).then_some(Damage::Length)
    }
}

fn check_packet(packet: &Packet<'_>) {
    assert!(packet.payload.len() <= MAX_PAYLOAD, "a payload of {} bytes", packet.payload.len());
    assert_eq!(again(&packet.header, |payload| payload.extend_from_slice(packet.payload)), packet.payload);
    if let Ok(request) = Request::read(packet) {
        let payload = again(&packet.header, |payload| request.write(payload));
        assert_eq!(Request::read(&Packet { header: packet.header, payload: &payload }), Ok(request));
        assert_eq!(request.kind().code(), packet.header.kind);
    }
    if let Ok(reply) = Reply::read(packet) {
        let payload = again(&packet.header, |payload| reply.write(payload));
        assert_eq!(Reply::read(&Packet { header: packet.header, payload: &payload }).as_ref(), Ok(&reply));
        assert_eq!(reply.kind().code(), packet.header.kind);
    }
}

/// The payload, encoded and decoded again.
fn again(header: &Header, write_payload: impl FnOnce(&mut Vec<u8>)) -> Vec<u8> {
    let mut wire = Vec::new();
    assert_eq!(Encoder::new().encode(header, write_payload, &mut wire), Ok(()));
    let event = events(&wire, wire.len()).pop();
    let found = event.and_then(Result::ok);
    assert_eq!(found.as_ref().map(|(header, _)| header), Some(header), "a packet that was sent is not read");
    found.map(|(_, payload)| payload).unwrap_or_default()
}

/// What a decoder delivers when `bytes` come in reads of `read` bytes.
fn events(bytes: &[u8], read: usize) -> Vec<Event> {
    let mut decoder = Decoder::new();
    let mut events = Vec::new();
    for mut input in bytes.chunks(read.max(1)) {
        while let Some(event) = decoder.next(&mut input) {
            events.push(event.map(|packet| (packet.header, packet.payload.to_vec())));
        }
    }
    events
}
