//! Strategies for every message of the wire. Messages that borrow bytes are kept together with their bytes.

use halfrow_protocol::message::{
    Bank, BoardNature, Burst, BurstMode, BurstState, Bursts, Capabilities, Commit, Configuration, Entries,
    Expect, FrameRecord, Grids, Hello, Records, Refusal, RefusalCode, Reset, ResetLevel, RowIn, RowOut,
    RowPlace, Shape, Span, Status, Table, TrappedRow, Welcome,
};
use halfrow_protocol::samples::packed_length;
use halfrow_protocol::{MAX_PAYLOAD, Reply, Request};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;

/// A request that owns its bytes.
#[derive(Clone, Debug)]
pub(crate) enum OwnedRequest {
    Plain(Request<'static>),
    Echo(Vec<u8>),
    TableWrite(Span, Vec<u8>),
    RowIn(RowPlace, Vec<u8>),
    Expect(u16, Vec<[u8; Expect::BYTES]>),
}

impl OwnedRequest {
    pub(crate) fn get(&self) -> Request<'_> {
        match self {
            Self::Plain(request) => *request,
            Self::Echo(bytes) => Request::Echo(bytes),
            Self::TableWrite(span, bytes) => Request::TableWrite(Entries { span: *span, bytes }),
            Self::RowIn(place, packed) => Request::RowIn(RowIn { place: *place, packed }),
            Self::Expect(first, bytes) => Request::Expect(Expect { first: *first, bytes }),
        }
    }
}

/// A reply that owns its bytes. What would borrow them (rows, records) is empty in the message, and kept beside it.
#[derive(Clone, Debug)]
pub(crate) enum OwnedReply {
    Plain(Reply<'static>),
    Echo(Vec<u8>),
    TableRead(Span, Vec<u8>),
    RowOut(RowOut<'static>, Vec<u8>),
    Records(Records<'static>, Vec<[u8; FrameRecord::BYTES]>),
    Trap(TrappedRow<'static>, Vec<u8>),
}

impl OwnedReply {
    pub(crate) fn get(&self) -> Reply<'_> {
        match self {
            Self::Plain(reply) => reply.clone(),
            Self::Echo(bytes) => Reply::Echo(bytes),
            Self::TableRead(span, bytes) => Reply::TableRead(Entries { span: *span, bytes }),
            Self::RowOut(row, packed) => Reply::RowOut(RowOut { packed, ..*row }),
            Self::Records(records, bytes) => Reply::Records(Records { bytes, ..*records }),
            Self::Trap(row, packed) => Reply::Trap(Some(TrappedRow { packed, ..*row })),
        }
    }
}

/// Any request.
pub(crate) fn request() -> impl Strategy<Value = OwnedRequest> {
    let plain = prop_oneof![
        hello().prop_map(Request::Hello),
        select(vec![Request::Capabilities, Request::RowAck, Request::Trap]),
        any::<bool>().prop_map(|clear| Request::Status { clear }),
        reset().prop_map(Request::Reset),
        span().prop_map(Request::TableRead),
        span().prop_map(Request::TableCrc),
        commit().prop_map(Request::Commit),
        configuration().prop_map(Request::Configure),
        burst().prop_map(Request::Burst),
        any::<u32>().prop_map(|from| Request::Records { from }),
    ];
    prop_oneof![
        5 => plain.prop_map(OwnedRequest::Plain),
        1 => echo().prop_map(OwnedRequest::Echo),
        1 => entries().prop_map(|(span, bytes)| OwnedRequest::TableWrite(span, bytes)),
        1 => row().prop_map(|(place, packed)| OwnedRequest::RowIn(place, packed)),
        1 => expect(),
    ]
}

/// Any reply or row from a board.
pub(crate) fn reply() -> impl Strategy<Value = OwnedReply> {
    let plain = prop_oneof![
        welcome().prop_map(Reply::Hello),
        capabilities().prop_map(Reply::Capabilities),
        status().prop_map(Reply::Status),
        select(vec![Reply::Reset, Reply::TableWrite, Reply::Configure, Reply::Burst, Reply::Expect]),
        Just(Reply::Trap(None)),
        any::<u32>().prop_map(Reply::TableCrc),
        any::<u8>().prop_map(|generation| Reply::Commit { generation }),
        refusal().prop_map(Reply::Refusal),
    ];
    prop_oneof![
        5 => plain.prop_map(OwnedReply::Plain),
        1 => echo().prop_map(OwnedReply::Echo),
        1 => entries().prop_map(|(span, bytes)| OwnedReply::TableRead(span, bytes)),
        1 => row_out(),
        1 => records(),
        1 => trapped(),
    ]
}

/// Mostly few bytes, but up to as many as a packet holds.
fn echo() -> impl Strategy<Value = Vec<u8>> {
    prop_oneof![3 => vec(any::<u8>(), 0..40), 1 => vec(0..2_u8, 0..600), 1 => vec(1..=255_u8, 0..=MAX_PAYLOAD)]
}

fn hello() -> impl Strategy<Value = Hello> {
    any::<(u32, u32, u8, u8, bool)>().prop_map(|(nonce, host, version_min, version_max, take_over)| Hello {
        nonce,
        host,
        version_min,
        version_max,
        take_over,
    })
}

fn welcome() -> impl Strategy<Value = Welcome> {
    any::<(u32, u8, u8, u32, u64)>().prop_map(|(nonce, version, session, build, serial)| Welcome {
        nonce,
        version,
        session,
        build,
        serial,
    })
}

fn capabilities() -> impl Strategy<Value = Capabilities> {
    let nature = select(vec![BoardNature::Hardware, BoardNature::Simulation, BoardNature::Mock]);
    // The name: sixty characters are at most 240 bytes, and a name has at most 255.
    let further = (proptest::option::of(bursts()), proptest::option::of(grids()));
    (any::<([u16; 5], [u8; 9], u32, bool)>(), further, nature, "\\PC{0,60}").prop_map(
        |((words, bytes, clock_hz, entered), (bursts, grids), nature, name)| Capabilities {
            datapath: words[0],
            max_width: words[1],
            max_height: words[2],
            depths: bytes[0],
            taps: bytes[1],
            latency: bytes[2],
            ring: words[3],
            least_blanking: words[4],
            table_banks: bytes[3],
            row_banks_in: bytes[4],
            row_banks_out: bytes[5],
            step_ports: bytes[6],
            kernel_ports: bytes[7],
            clock_source: bytes[8],
            clock_hz,
            bursts,
            entered,
            grids,
            nature,
            name,
        },
    )
}

fn status() -> impl Strategy<Value = Status> {
    any::<[u32; 16]>().prop_map(|numbers| Status {
        packets: numbers[0],
        crc_errors: numbers[1],
        framing_errors: numbers[2],
        foreign_packets: numbers[3],
        refusals: numbers[4],
        rows_in: numbers[5],
        rows_out: numbers[6],
        rows_repeated: numbers[7],
        rows_unneeded: numbers[8],
        samples_over: numbers[9],
        next_row_in: numbers[10],
        next_row_out: numbers[11],
        core_busy: numbers[12],
        generation: numbers[13],
        least_latency: numbers[14],
        most_latency: numbers[15],
    })
}

fn reset() -> impl Strategy<Value = Reset> {
    let level = select(vec![ResetLevel::Rows, ResetLevel::Session, ResetLevel::Tables]);
    (level, any::<u32>()).prop_map(|(level, next_row)| Reset { level, next_row })
}

fn commit() -> impl Strategy<Value = Commit> {
    let shape = proptest::option::of(any::<(u8, u8)>().prop_map(|(v, k)| Shape { v, k }));
    (any::<(u32, u32, u16, u8)>(), shape).prop_map(
        |((steps_crc, kernel_crc, first_frame, generation), shape)| Commit {
            steps_crc,
            kernel_crc,
            first_frame,
            generation,
            shape,
        },
    )
}

fn configuration() -> impl Strategy<Value = Configuration> {
    any::<([u16; 4], u32, u8)>().prop_map(|([width, height, centre2, blanking], gap_seed, bits)| {
        Configuration { width, height, centre2, blanking, gap_seed, bits }
    })
}

fn span() -> impl Strategy<Value = Span> {
    let table = select(vec![Table::RowFactors, Table::Kernel, Table::Grid]);
    let bank = select(vec![Bank::Shadow, Bank::Active]);
    (table, bank, any::<(u8, u16, u16)>()).prop_map(|(table, bank, (port, first, count))| Span {
        table,
        bank,
        port,
        first,
        count,
    })
}

/// A packet holds at most 1018 row factors or 407 nodes.
fn entries() -> impl Strategy<Value = (Span, Vec<u8>)> {
    (span(), prop_oneof![3 => 0..9_u16, 1 => 0..=407_u16, 1 => Just(1018)]).prop_flat_map(|(span, most)| {
        let count = if span.table == Table::Kernel { most.min(407) } else { most };
        (Just(Span { count, ..span }), vec(any::<u8>(), usize::from(count) * span.table.entry_bytes()))
    })
}

/// A row and its packed samples, up to the datapath's limit of 2592.
fn row() -> impl Strategy<Value = (RowPlace, Vec<u8>)> {
    let half_width = prop_oneof![3 => 32..40_u16, 1 => 32..=1296_u16];
    (half_width, any::<(u32, u16, u16, bool)>()).prop_flat_map(|(half, (row_sequence, frame, row, last))| {
        let place = RowPlace { row_sequence, frame, row, width: 2 * half, last };
        (Just(place), vec(any::<u8>(), packed_length(usize::from(place.width))))
    })
}

fn row_out() -> impl Strategy<Value = OwnedReply> {
    (row(), any::<(u8, [u16; 4], Option<u32>)>()).prop_map(
        |((place, packed), (generation, latencies, entered))| {
            let [first_latency, last_latency, pauses, repeats] = latencies;
            let row = RowOut {
                place,
                generation,
                first_latency,
                last_latency,
                pauses,
                repeats,
                packed: &[],
                entered,
            };
            OwnedReply::RowOut(row, packed)
        },
    )
}

fn bursts() -> impl Strategy<Value = Bursts> {
    any::<([u16; 3], bool)>().prop_map(|([content, records, least_frame_blanking], trap)| Bursts {
        content,
        records,
        least_frame_blanking,
        trap,
    })
}

fn grids() -> impl Strategy<Value = Grids> {
    any::<([u16; 3], [u8; 2])>().prop_map(|([further_datapath, entries, grid_width], [ks, grid_blanking])| {
        Grids { further_datapath, entries, ks, grid_blanking, grid_width }
    })
}

fn burst() -> impl Strategy<Value = Burst> {
    let modes = [BurstMode::Fresh, BurstMode::Alternating, BurstMode::Repeating, BurstMode::Trapped];
    (any::<([u32; 3], [u16; 2])>(), select(modes.to_vec())).prop_map(
        |(([burst, frames, seed], [first_frame, frame_blanking]), mode)| Burst {
            burst,
            frames,
            seed,
            first_frame,
            frame_blanking,
            mode,
        },
    )
}

/// A packet holds at most 1019 signatures.
fn expect() -> impl Strategy<Value = OwnedRequest> {
    let bytes = prop_oneof![3 => vec(any::<[u8; 4]>(), 0..9), 1 => vec(any::<[u8; 4]>(), 1000..=1019)];
    (any::<u16>(), bytes).prop_map(|(first, bytes)| OwnedRequest::Expect(first, bytes))
}

/// A packet holds at most 226 records.
fn records() -> impl Strategy<Value = OwnedReply> {
    let states = [BurstState::None, BurstState::UnderWay, BurstState::Ended];
    let records = prop_oneof![3 => vec(any::<[u8; 18]>(), 0..9), 1 => vec(any::<[u8; 18]>(), 200..=226)];
    (any::<(u32, u32)>(), select(states.to_vec()), records).prop_map(|((burst, from), state, records)| {
        OwnedReply::Records(Records { burst, from, state, bytes: &[] }, records)
    })
}

fn trapped() -> impl Strategy<Value = OwnedReply> {
    (row(), any::<(u32, u32)>()).prop_map(|((RowPlace { row, width, .. }, packed), (frame, signature))| {
        OwnedReply::Trap(TrappedRow { frame, row, width, signature, packed: &[] }, packed)
    })
}

fn refusal() -> impl Strategy<Value = Refusal> {
    let code = (1..=12_u8).prop_filter_map("a refusal's code", RefusalCode::from_code);
    (code, any::<(u8, u16)>()).prop_map(|(code, (kind, detail))| Refusal { code, kind, detail })
}
