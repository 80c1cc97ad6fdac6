//! Requests and bytes that no host would send: the board stays up, keeps its promises and answers the next HELLO.

use halfrow_protocol::message::{
    Bank, Burst, BurstMode, Commit, Configuration, Entries, Expect, Hello, Reply, Request, Reset, ResetLevel,
    RowIn, RowPlace, Shape, Span, Status, Table,
};
use halfrow_protocol::{Kind, MAX_PAYLOAD, samples};
use proptest::prelude::*;

use crate::at_speed::ENDLESS;
use crate::bench::{Bench, HELLO, ReceivedPacket, rows_of, wire};
use crate::frames::{lean, make_ready, ready, row, samples_of};
use crate::{Boards, Build, cases, offered};

const HEIGHT: u16 = 2;

/// Something that the host sends.
#[derive(Clone, Debug)]
enum Event {
    /// The row this many after the one that the board waits for.
    Row(u32),
    /// A packet of the open session, or of another one.
    Packet { kind: u8, payload: Vec<u8>, foreign: bool },
    /// Bytes that are no packet.
    Bytes(Vec<u8>),
    /// The host acknowledges this many more rows.
    Acknowledge(u32),
    /// The host acknowledges all rows, and requests a burst of this many frames.
    Burst(u32),
}

fn event() -> impl Strategy<Value = Event> {
    let fields = [field(), field(), field(), field()];
    let request = (prop::sample::select(Kind::ALL.to_vec()), fields)
        .prop_map(|(kind, fields)| (kind.code(), payload(kind, fields)));
    let packet = (any::<u8>(), prop::collection::vec(any::<u8>(), 0..60));
    let foreign = prop::bool::weighted(0.1);
    prop_oneof![
        4 => (0_u32..4).prop_map(Event::Row),
        3 => (0_u32..4).prop_map(Event::Acknowledge),
        1 => prop_oneof![0_u32..5, Just(Burst::ENDLESS)].prop_map(Event::Burst),
        3 => (prop_oneof![4 => request, 1 => packet], foreign)
            .prop_map(|((kind, payload), foreign)| Event::Packet { kind, payload, foreign }),
        1 => prop::collection::vec(any::<u8>(), 0..60).prop_map(Event::Bytes),
    ]
}

/// A number near a limit of some field, or any.
fn field() -> impl Strategy<Value = u32> + Clone {
    prop_oneof![0_u32..5, 60_u32..70, 1010_u32..1030, 2040_u32..2060, Just(u32::MAX), any::<u32>()]
}

fn build(on: &dyn Boards) -> impl Strategy<Value = Build> + use<> {
    let mut builds = vec![lean()];
    for banks in 0..16 {
        for (taps, latency) in [(5, 11), (7, 12)] {
            for table_banks in [1, 2] {
                let (row_banks_in, row_banks_out) = (2 + banks % 4, 2 + banks / 4);
                let build =
                    Build { row_banks_in, row_banks_out, table_banks, taps, latency, ..Build::default() };
                builds.extend([build.clone(), Build { depths: &[8, 12], ..build }]);
            }
        }
    }
    prop::sample::select(offered(on, builds))
}

/// The payload of a request of this kind, made from four numbers.
fn payload(kind: Kind, [a, b, c, d]: [u32; 4]) -> Vec<u8> {
    let mut payload = Vec::new();
    match kind {
        Kind::Hello => {
            Request::Hello(Hello { nonce: a, host: b, take_over: c > 9, ..HELLO }).write(&mut payload);
        }
        Kind::Status => payload.push(a as u8),
        Kind::Reset => {
            let level = [ResetLevel::Rows, ResetLevel::Session, ResetLevel::Tables][a as usize % 3];
            Request::Reset(Reset { level, next_row: b }).write(&mut payload);
        }
        Kind::Echo => payload.resize(a as usize % (MAX_PAYLOAD + 1), b as u8),
        Kind::TableWrite => {
            let span = span([a, b, c, d % 400]);
            let bytes = vec![d as u8; usize::from(span.count) * span.table.entry_bytes()];
            Request::TableWrite(Entries { span, bytes: &bytes }).write(&mut payload);
        }
        Kind::TableRead | Kind::TableCrc => Request::TableCrc(span([a, b, c, d])).write(&mut payload),
        Kind::Commit => {
            let (first_frame, generation) = (c as u16, d as u8);
            let shape = (a % 2 == 1).then_some(Shape { v: a as u8 % 9, k: b as u8 % 8 });
            Request::Commit(Commit { steps_crc: a, kernel_crc: b, first_frame, generation, shape })
                .write(&mut payload);
        }
        Kind::Configure => Request::Configure(configuration([a, b, c, d])).write(&mut payload),
        Kind::RowIn => {
            let (frame, row, width) = (b as u16, c as u16, d as u16 % 2600);
            let place = RowPlace { row_sequence: a, frame, row, width, last: c > d };
            let packed = vec![d as u8; samples::packed_length(width.into())];
            Request::RowIn(RowIn { place, packed: &packed }).write(&mut payload);
        }
        Kind::Burst | Kind::Records | Kind::Expect => at_speed(kind, [a, b, c, d], &mut payload),
        Kind::Capabilities | Kind::RowOut | Kind::RowAck | Kind::Trap | Kind::Refusal => {}
    }
    payload
}

/// The payload of BURST, RECORDS or EXPECT.
fn at_speed(kind: Kind, [a, b, c, d]: [u32; 4], payload: &mut Vec<u8>) {
    let bytes = vec![c.to_le_bytes(); b as usize % (Expect::MOST + 1)];
    let modes = [BurstMode::Fresh, BurstMode::Alternating, BurstMode::Repeating, BurstMode::Trapped];
    let request = match kind {
        Kind::Records => Request::Records { from: a },
        Kind::Expect => Request::Expect(Expect { first: a as u16, bytes: &bytes }),
        _ => Request::Burst(Burst {
            burst: a,
            frames: b,
            seed: c,
            first_frame: c as u16,
            frame_blanking: d as u16 % 1000,
            mode: modes[d as usize % modes.len()],
        }),
    };
    request.write(payload);
}

fn span([a, b, c, d]: [u32; 4]) -> Span {
    let table = [Table::RowFactors, Table::Kernel, Table::Grid][a as usize % 3];
    let bank = if b.is_multiple_of(3) { Bank::Active } else { Bank::Shadow };
    Span { table, bank, port: a as u8 % 4, first: c as u16, count: d as u16 }
}

fn configuration([a, b, c, d]: [u32; 4]) -> Configuration {
    let bits = [8, 10, 12, 0][d as usize % 4];
    Configuration {
        width: a as u16,
        height: b as u16,
        centre2: c as u16,
        blanking: d as u16 % 1000,
        gap_seed: d,
        bits,
    }
}

/// A host that checks what must hold for every packet from a board, whatever caused it.
struct Observer {
    bench: Bench,
    /// The greatest window since the session began or since the last RESET.
    credit: u32,
    /// The count that the next ROW_OUT carries.
    next_count: u16,
}

impl Observer {
    fn receive(&mut self, bytes: &[u8]) -> Vec<ReceivedPacket> {
        let heard = self.bench.receive(bytes);
        for packet in &heard {
            let window = packet.header.window;
            match packet.reply() {
                Reply::Hello(welcome) => self.enter(welcome.session, window),
                Reply::Reset => self.credit = window,
                Reply::RowOut(out) => {
                    assert_eq!(packet.header.sequence, self.next_count);
                    assert_eq!(packet.header.session, self.bench.session);
                    assert_eq!(out.packed.len(), samples::packed_length(out.place.width.into()));
                    assert_ne!(out.generation, 0, "a row without tables");
                    self.next_count = packet.header.sequence.wrapping_add(1);
                }
                _ => {}
            }
            assert!(window >= self.credit, "the window went from {} to {window}", self.credit);
            self.credit = window;
        }
        heard
    }

    /// A session was opened, or its HELLO was repeated.
    fn enter(&mut self, session: u8, window: u32) {
        if session != self.bench.session {
            (self.bench.session, self.bench.window) = (session, 0);
            (self.credit, self.next_count) = (window, 0);
        }
    }

    /// The board's counters; all 0 when no session is open.
    fn status(&mut self) -> Status {
        let packet = self.bench.packet(&Request::Status { clear: false });
        let status = self.receive(&packet).iter().find_map(|packet| match packet.reply() {
            Reply::Status(status) => Some(status),
            _ => None,
        });
        status.unwrap_or_default()
    }

    fn meet(&mut self, event: Event) {
        let bytes = match event {
            Event::Row(behind) => {
                let number = self.status().next_row_in.saturating_add(behind);
                self.bench.row_packet(&row(HEIGHT, number))
            }
            Event::Packet { kind, payload, foreign } => {
                let mut header = self.bench.header(kind);
                header.session = header.session.wrapping_add(foreign.into());
                wire(&header, |to| to.extend(payload))
            }
            Event::Bytes(bytes) => bytes,
            Event::Acknowledge(more) => {
                self.bench.window = self.status().next_row_out.saturating_add(more);
                self.bench.packet(&Request::RowAck)
            }
            Event::Burst(frames) => {
                self.bench.window = self.status().next_row_in;
                self.bench.packet(&Request::Burst(Burst { frames, ..ENDLESS }))
            }
        };
        self.receive(&bytes);
    }
}

/// A HELLO after two zeros must be answered, and a frame must come out unchanged.
fn recover(mut bench: Bench) {
    bench.receive(&[0, 0]);
    bench.greet(&Hello { nonce: 0xffff_0000, host: 1, take_over: true, ..HELLO });
    bench.done(&Request::Reset(Reset { level: ResetLevel::Tables, next_row: 0 }));
    make_ready(&mut bench, HEIGHT);
    let heard = bench.send_all(HEIGHT, 0..2);
    assert_eq!(rows_of(&heard), [0, 1]);
    for (number, packet) in (0..).zip(&heard) {
        assert_eq!(samples_of(&packet.row()), row(HEIGHT, number).samples);
    }
}

pub(crate) fn whatever_comes_the_board_keeps_its_promises_and_answers_the_next_hello(on: &dyn Boards) {
    proptest!(cases(on, 1, concat!(env!("CARGO_MANIFEST_DIR"), "/proptest-regressions/random.txt")), |(build in build(on),
        events in prop::collection::vec(event(), 0..40),)| {
        let bench = ready(on, &build, HEIGHT);
        let mut observer = Observer { bench, credit: 0, next_count: 0 };
        for event in events {
            observer.meet(event);
        }
        recover(observer.bench);
    });
}

pub(crate) fn any_bytes_in_any_pieces_are_survived(on: &dyn Boards) {
    proptest!(cases(on, 1, concat!(env!("CARGO_MANIFEST_DIR"), "/proptest-regressions/bytes.txt")), |(bytes in prop::collection::vec(prop_oneof![2 => Just(0_u8), 1 => any::<u8>()], 0..9000),
        size in 1_usize..300,)| {
        let mut bench = ready(on, &Build::default(), HEIGHT);
        for piece in bytes.chunks(size) {
            bench.receive(piece);
        }
        recover(bench);
    });
}
