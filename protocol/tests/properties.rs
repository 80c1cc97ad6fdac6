//! What holds for every message and on every link: what was sent arrives unchanged or not at all, and damage ends at the next
//! zero.

// clippy.toml allows this in #[test] functions, but not in the functions that they call.
#![allow(clippy::expect_used)]

mod messages;

use halfrow_protocol::message::{Commit, FrameRecord, RowOut};
use halfrow_protocol::{
    Damage, Decoder, Encoder, Header, Kind, MAX_PAYLOAD, Malformed, Packet, Reply, Request, TooLong,
};
use messages::{OwnedReply, OwnedRequest, reply, request};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::Index;

fn header() -> impl Strategy<Value = Header> {
    any::<(u16, bool, u8, u32)>().prop_map(|(sequence, reply, session, window)| Header {
        kind: 0,
        sequence,
        reply,
        session,
        window,
    })
}

/// The sizes of the reads in which a link delivers its bytes, used in turn.
fn reads() -> impl Strategy<Value = Vec<usize>> {
    vec(prop_oneof![1..8_usize, 1..4000_usize], 1..12)
}

fn encode(header: &Header, write_payload: impl FnOnce(&mut Vec<u8>)) -> Vec<u8> {
    let mut wire = Vec::new();
    Encoder::new().encode(header, write_payload, &mut wire).expect("a payload that fits");
    wire
}

fn payload_of(write: impl FnOnce(&mut Vec<u8>)) -> Vec<u8> {
    let mut payload = Vec::new();
    write(&mut payload);
    payload
}

fn receive(mut wire: &[u8], reads: &[usize]) -> Vec<Result<(Header, Vec<u8>), Damage>> {
    let mut decoder = Decoder::new();
    let mut events = Vec::new();
    for &read in reads.iter().cycle() {
        let (mut now, later) = wire.split_at(read.min(wire.len()));
        while let Some(event) = decoder.next(&mut now) {
            events.push(event.map(|packet| (packet.header, packet.payload.to_vec())));
        }
        wire = later;
        if wire.is_empty() {
            break;
        }
    }
    events
}

/// Requests whose fields have fixed places; the bytes of ECHO end where the payload ends.
fn request_with_fields() -> impl Strategy<Value = OwnedRequest> {
    request().prop_filter("it has no fields", |request| {
        !matches!(request.get().kind(), Kind::Echo | Kind::Capabilities | Kind::RowAck | Kind::Trap)
    })
}

/// Requests whose fields may be followed by bytes without meaning. A COMMIT must have a shape, or such bytes would be read as
/// one.
fn request_that_may_be_longer() -> impl Strategy<Value = OwnedRequest> {
    request_with_fields().prop_filter("it would have a shape", |request| {
        !matches!(request.get(), Request::Commit(Commit { shape: None, .. }))
    })
}

/// Replies whose fields have fixed places; ECHO and the list of CAPABILITIES end where the payload ends.
fn reply_with_fields() -> impl Strategy<Value = OwnedReply> {
    reply().prop_filter("it has no fields", |reply| match reply.get() {
        Reply::Reset | Reply::TableWrite | Reply::Configure | Reply::Burst | Reply::Expect => false,
        reply => !matches!(reply.kind(), Kind::Echo | Kind::Capabilities),
    })
}

/// Replies whose fields may be followed by bytes without meaning. A row must have `entered`, or such bytes would be read as
/// that.
fn reply_that_may_be_longer() -> impl Strategy<Value = OwnedReply> {
    reply_with_fields().prop_filter("it would say what entered", |reply| {
        !matches!(reply.get(), Reply::RowOut(RowOut { entered: None, .. }))
    })
}

fn packet(kind: Kind, payload: &[u8]) -> Packet<'_> {
    Packet { header: Header { kind: kind.code(), ..Header::default() }, payload }
}

proptest! {
    #[test]
    fn requests_arrive_as_they_were_sent(sent in vec((header(), request()), 1..6), reads in reads()) {
        let (mut encoder, mut wire) = (Encoder::new(), Vec::new());
        for (header, request) in &sent {
            let request = request.get();
            let header = Header { kind: request.kind().code(), ..*header };
            prop_assert_eq!(encoder.encode(&header, |payload| request.write(payload), &mut wire), Ok(()));
        }
        let events = receive(&wire, &reads);
        prop_assert_eq!(events.len(), sent.len());
        for (event, (header, request)) in events.into_iter().zip(&sent) {
            let (found, payload) = event.expect("a packet");
            prop_assert_eq!(found, Header { kind: request.get().kind().code(), ..*header });
            prop_assert_eq!(Request::read(&Packet { header: found, payload: &payload }), Ok(request.get()));
        }
    }

    #[test]
    fn replies_arrive_as_they_were_sent(sent in vec((header(), reply()), 1..6), reads in reads()) {
        let (mut encoder, mut wire) = (Encoder::new(), Vec::new());
        for (header, reply) in &sent {
            let reply = reply.get();
            let header = Header { kind: reply.kind().code(), ..*header };
            prop_assert_eq!(encoder.encode(&header, |payload| reply.write(payload), &mut wire), Ok(()));
        }
        let events = receive(&wire, &reads);
        prop_assert_eq!(events.len(), sent.len());
        for (event, (header, reply)) in events.into_iter().zip(&sent) {
            let (found, payload) = event.expect("a packet");
            prop_assert_eq!(found, Header { kind: reply.get().kind().code(), ..*header });
            prop_assert_eq!(Reply::read(&Packet { header: found, payload: &payload }), Ok(reply.get()));
        }
    }

    #[test]
    fn a_request_that_lost_bytes_is_too_short(request in request_with_fields(), cut in any::<Index>()) {
        let request = request.get();
        let payload = payload_of(|payload| request.write(payload));
        let rest = &payload[..cut.index(payload.len())];
        let expected = match request {
            // A COMMIT's payload may end before the shape.
            Request::Commit(commit @ Commit { shape: Some(_), .. }) if rest.len() + 2 >= payload.len() => {
                Ok(Request::Commit(Commit { shape: None, ..commit }))
            }
            _ => Err(Malformed::Length),
        };
        prop_assert_eq!(Request::read(&packet(request.kind(), rest)), expected);
    }

    #[test]
    fn a_reply_that_lost_bytes_is_too_short(reply in reply_with_fields(), cut in any::<Index>()) {
        let reply = reply.get();
        let payload = payload_of(|payload| reply.write(payload));
        let rest = &payload[..cut.index(payload.len())];
        let expected = match &reply {
            // A row's payload may end with its samples.
            Reply::RowOut(row @ RowOut { entered: Some(_), .. }) if rest.len() + 4 >= payload.len() => {
                Ok(Reply::RowOut(RowOut { entered: None, ..*row }))
            }
            _ => Err(Malformed::Length),
        };
        prop_assert_eq!(Reply::read(&packet(reply.kind(), rest)), expected);
    }

    #[test]
    fn bytes_behind_the_fields_change_nothing(
        request in request_that_may_be_longer(), reply in reply_that_may_be_longer(), more in vec(any::<u8>(), 0..20)
    ) {
        let (request, reply) = (request.get(), reply.get());
        let longer = [payload_of(|payload| request.write(payload)), more.clone()].concat();
        prop_assert_eq!(Request::read(&packet(request.kind(), &longer)), Ok(request));
        let longer = [payload_of(|payload| reply.write(payload)), more].concat();
        prop_assert_eq!(Reply::read(&packet(reply.kind(), &longer)), Ok(reply));
    }

    #[test]
    fn a_record_has_the_bytes_that_it_came_in(bytes in any::<[u8; FrameRecord::BYTES]>()) {
        let mut expected = bytes;
        expected[FrameRecord::BYTES - 1] &= 1;
        prop_assert_eq!(FrameRecord::from(bytes).to_bytes(), expected);
    }

    #[test]
    fn a_payload_over_its_limit_is_not_sent(over in prop_oneof![Just(1), 1..3000_usize], before in vec(any::<u8>(), 0..9)) {
        let (mut encoder, mut wire) = (Encoder::new(), before.clone());
        let length = MAX_PAYLOAD + over;
        let result = encoder.encode(&Header::default(), |payload| payload.resize(payload.len() + length, 7), &mut wire);
        prop_assert_eq!((result, &wire), (Err(TooLong(length)), &before));
    }

}

#[test]
fn the_longest_packet_may_end_in_a_piece_of_its_own() {
    let window = 0x0101_0101;
    let header = Header { kind: Kind::Echo.code(), sequence: 0x0101, reply: true, session: 1, window };
    let wire = encode(&header, |payload| payload.extend([7; MAX_PAYLOAD]));
    // 4096 bytes without a zero are sixteen runs of 254 and one of 32, each after its code byte.
    assert_eq!(wire.len(), 1 + 4096 + 17 + 1);
    assert_eq!(receive(&wire, &[wire.len() - 1, 1]), [Ok((header, vec![7; MAX_PAYLOAD]))]);
}

#[test]
fn no_flipped_bit_of_a_packet_goes_unnoticed() {
    let header = Header { sequence: 0x1234, session: 7, window: 0x89ab_cdef, ..Header::default() };
    let wire = encode(&header, |payload| payload.extend(0..40));
    for bit in 8..8 * (wire.len() - 1) {
        let mut damaged = wire.clone();
        damaged[bit / 8] ^= 1 << (bit % 8);
        assert!(receive(&damaged, &[damaged.len()]).iter().all(Result::is_err), "bit {bit}");
    }
}

/// What a link does to the bytes of one packet and its two zeros.
#[derive(Clone, Debug)]
enum Blow {
    Flip(Index, u8),
    Drop(Index, usize),
    Repeat(Index, usize),
    Truncate(Index),
    Insert(Index, Vec<u8>),
}

impl Blow {
    /// Repeats are shorter than any packet: if a link repeats whole packets, only their sequence numbers can show it.
    fn any() -> impl Strategy<Value = Self> {
        let place = any::<Index>;
        prop_oneof![
            (place(), 0..8_u8).prop_map(|(place, bit)| Self::Flip(place, bit)),
            (place(), 1..40_usize).prop_map(|(place, count)| Self::Drop(place, count)),
            (place(), 1..16_usize).prop_map(|(place, count)| Self::Repeat(place, count)),
            place().prop_map(Self::Truncate),
            (place(), vec(any::<u8>(), 1..40)).prop_map(|(place, bytes)| Self::Insert(place, bytes)),
        ]
    }

    fn strike(&self, frame: &mut Vec<u8>) {
        let place = |index: &Index| index.index(frame.len() + 1);
        match self {
            Self::Flip(index, bit) => {
                let place = place(index);
                frame.get_mut(place).into_iter().for_each(|byte| *byte ^= 1 << bit);
            }
            Self::Drop(index, count) => {
                let place = place(index);
                frame.drain(place..(place + count).min(frame.len()));
            }
            Self::Repeat(index, count) => {
                let place = place(index);
                let bytes = frame[place..(place + count).min(frame.len())].to_vec();
                frame.splice(place..place, bytes);
            }
            Self::Truncate(index) => frame.truncate(place(index)),
            Self::Insert(index, bytes) => {
                let place = place(index);
                frame.splice(place..place, bytes.iter().copied());
            }
        }
    }
}

/// A payload, what the link does to its packet (often nothing), and the noise before it.
fn passage() -> impl Strategy<Value = (Vec<u8>, Vec<Blow>, Vec<u8>)> {
    let payload =
        prop_oneof![4 => vec(any::<u8>(), 0..60), 1 => vec(prop_oneof![Just(0), any::<u8>()], 0..1500)];
    let noise = prop_oneof![2 => Just(vec![]), 1 => vec(any::<u8>(), 0..60), 1 => vec(0..4_u8, 0..20), 1 => vec(1..=255_u8, 4000..9000)];
    (payload, prop_oneof![2 => Just(vec![]), 3 => vec(Blow::any(), 1..4)], noise)
}

/// The bytes that come out of the link. With `share`, a packet omits its first zero if the bytes before it end in one.
fn disturb(passages: &[(Vec<u8>, Vec<Blow>, Vec<u8>)], share: bool) -> Vec<u8> {
    let mut wire = Vec::new();
    for (sequence, (payload, blows, noise)) in (0..).zip(passages) {
        wire.extend_from_slice(noise);
        let header = Header { kind: Kind::Echo.code(), sequence, ..Header::default() };
        let mut frame = encode(&header, |out| out.extend_from_slice(payload));
        blows.iter().for_each(|blow| blow.strike(&mut frame));
        if share && blows.is_empty() && wire.last() == Some(&0) {
            frame.remove(0);
        }
        wire.extend(frame);
    }
    wire
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn a_damaged_link_loses_packets_but_never_alters_reorders_or_invents_one(
        passages in vec(passage(), 1..12), share in any::<bool>(), reads in reads()
    ) {
        let delivered: Vec<_> = receive(&disturb(&passages, share), &reads).into_iter().flatten().collect();
        for (header, payload) in &delivered {
            let sent = passages.get(usize::from(header.sequence)).map(|(payload, ..)| payload);
            let expected = Header { kind: Kind::Echo.code(), sequence: header.sequence, ..Header::default() };
            prop_assert_eq!((header, Some(payload)), (&expected, sent));
        }
        prop_assert!(delivered.is_sorted_by(|(one, _), (next, _)| one.sequence < next.sequence));
    }

    #[test]
    fn every_whole_packet_arrives_whatever_is_in_front_of_it(
        passages in vec(passage(), 1..12), share in any::<bool>(), reads in reads()
    ) {
        let delivered: Vec<_> = receive(&disturb(&passages, share), &reads).into_iter().flatten().collect();
        for (sequence, (payload, ..)) in (0..).zip(&passages).filter(|(_, (_, blows, _))| blows.is_empty()) {
            let arrived = |(header, found): &(Header, Vec<u8>)| header.sequence == sequence && found == payload;
            prop_assert!(delivered.iter().any(arrived), "packet {} is lost", sequence);
        }
    }
}
