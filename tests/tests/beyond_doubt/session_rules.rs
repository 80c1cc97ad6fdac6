//! Boards that are sound except in what opens a session, what ends one, and what they count.

use std::convert::Infallible;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use halfrow::link::{Candidate, WireLink};
use halfrow::result::{Answer, CheckName, Counter, Finding, Report, Rule};
use halfrow::target::BoardKind;
use halfrow::verdict::Verdict;
use halfrow_mock::{Board, Options};
use halfrow_pipe::{Endpoint, Pipe, PipeOptions};
use halfrow_protocol::message::{Refusal, RefusalCode, Reset, ResetLevel, Status};
use halfrow_protocol::{Decoder, Header, Kind, Packet, Reply, Request, VERSION};
use halfrow_tests::altered::{Passing, Toward};
use halfrow_tests::system::{failed_check, judge_by_plan, open};

use super::by_the_rules::{altering, altering_each, broken, counting, miscounted, plan};

/// The report on a board that receives the host's packets as `alter` changes them.
fn hearing(mut alter: impl FnMut(&mut Passing) + Send + 'static) -> Report {
    altering_each(move |toward, packet| {
        if toward == Toward::Board {
            alter(packet);
        }
    })
}

/// A greeting's nonce and host (WIRE.md, 00).
fn greeting(packet: &Passing) -> Option<(u32, u32)> {
    let fields = packet.payload.as_chunks::<4>().0;
    packet.is(Kind::Hello).then(|| (u32::from_le_bytes(fields[0]), u32::from_le_bytes(fields[1])))
}

/// The report on a board that hears of other hosts than the first that they take over, or that they do not.
fn hearing_take_over(take_over: bool) -> Report {
    let mut own = None;
    hearing(move |packet| {
        if let Some((_, host)) = greeting(packet)
            && *own.get_or_insert(host) != host
        {
            packet.payload[10] = take_over.into();
        }
    })
}

#[test]
fn another_host_must_not_get_a_board_that_is_held() {
    assert_eq!(broken(&hearing_take_over(true)).0, Rule::Held);
}

/// It takes any greeting with the open session's nonce for the one that opened it.
#[test]
fn the_nonce_of_the_open_session_lets_no_other_host_in() {
    let mut open = None;
    let report = hearing(move |packet| {
        let Some((nonce, host)) = greeting(packet) else { return };
        let (own_nonce, own) = *open.get_or_insert((nonce, host));
        if host == own {
            open = Some((nonce, host));
        } else if nonce == own_nonce {
            packet.payload[4..8].copy_from_slice(&own.to_le_bytes());
        }
    });
    assert_eq!(broken(&report).0, Rule::Held, "{}", report.headline());
}

#[test]
fn a_held_board_must_let_itself_be_taken_over() {
    let report = hearing_take_over(false);
    assert_eq!(broken(&report).0, Rule::Held, "{}", report.headline());
}

/// The board answers with the nonce that it received.
#[test]
fn a_greeting_that_is_repeated_must_open_no_session() {
    let (mut greetings, mut again) = (Vec::new(), 0);
    let report = altering_each(move |toward, packet| {
        if toward == Toward::Board && packet.is(Kind::Hello) {
            let own = greeting(packet);
            again = greetings.iter().filter(|&&earlier| earlier == own).count();
            greetings.push(own);
        }
        if packet.is(Kind::Hello) {
            packet.payload[3] ^= (again as u8) << 4;
        }
    });
    let (rule, right, found) = broken(&report);
    assert_eq!(rule, Rule::NewSession);
    assert!(
        matches!((right, found), (Answer::Session { .. }, Answer::Session { .. })),
        "{}",
        report.headline()
    );
}

/// Where a board's answer to HELLO has its build and its serial number (WIRE.md, 00).
const BUILD: usize = 10;
const SERIAL: usize = 14;

/// The report on a board that changes the byte `at` of its answers to greetings that are `meant`: to those with the first nonce
/// after the first answer, or to those with another nonce.
fn naming_itself(at: usize, meant: [bool; 2]) -> Report {
    let mut first = None;
    altering_each(move |toward, packet| {
        if toward == Toward::Host && packet.is(Kind::Hello) {
            let nonce = packet.payload[..4].to_vec();
            let is_first = first.is_none();
            let is_another = *first.get_or_insert_with(|| nonce.clone()) != nonce;
            packet.payload[at] ^= u8::from(!is_first && meant[usize::from(is_another)]);
        }
    })
}

#[test]
fn a_board_must_say_each_time_who_it_is() {
    for (at, meant) in [(SERIAL, [true, false]), (SERIAL, [false, true]), (BUILD, [true, true])] {
        let report = naming_itself(at, meant);
        let (rule, right, found) = broken(&report);
        assert_eq!(rule, Rule::NewSession, "{}", report.headline());
        assert!(right != found && matches!(found, Answer::Replied { .. }), "{}", report.headline());
    }
}

/// The report on a board that answers where the one before was, without the tables of that. Its answers to greetings are what `other`
/// makes of that one's.
fn in_the_place_of_another(other: fn(&mut Passing)) -> Report {
    const NOBODYS: u16 = 0x4242;
    let (mut first, mut session) = (None, 0);
    altering(move |toward, mut packet| {
        let Some((nonce, host)) = greeting(&packet).filter(|_| toward == Toward::Board) else {
            if toward == Toward::Host && packet.is(Kind::Hello) {
                session = packet.payload[9];
                if first.is_some_and(|(own, _)| packet.payload[..4] != u32::to_le_bytes(own)) {
                    other(&mut packet);
                }
            }
            return Vec::from_iter((packet.header.sequence != NOBODYS).then_some(packet));
        };
        let (own, holder) = *first.get_or_insert((nonce, host));
        let reset = Request::Reset(Reset { level: ResetLevel::Tables, next_row: 0 });
        let header = Header { kind: reset.kind().code(), sequence: NOBODYS, session, ..Header::default() };
        let reset = Passing { header, payload: payload(&reset) };
        let opens = nonce != own && host == holder && packet.payload[8..10] == [VERSION; 2];
        let resets = opens.then_some(reset);
        resets.into_iter().chain([packet]).collect()
    })
}

/// Two builds of one commit may have different banks, and a board that was given no serial number has that of all others.
#[test]
fn a_board_in_the_place_of_another_makes_none_fail() {
    let others: [fn(&mut Passing); 2] =
        [|packet| packet.payload[SERIAL] ^= 1, |packet| packet.header.window += 4];
    for other in others {
        let report = in_the_place_of_another(other);
        assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
        assert_eq!(report.finding, Finding::BoardExchanged {});
    }
}

/// The report on a board that carries out a RESET with level `given` as one with level `done`.
fn resetting(given: u8, done: u8) -> Report {
    hearing(move |packet| {
        if packet.is(Kind::Reset) && packet.payload[0] == given {
            packet.payload[0] = done;
        }
    })
}

#[test]
fn each_level_of_reset_must_drop_what_it_names_and_no_more() {
    for (given, done) in [(1, 0), (2, 1), (0, 2)] {
        assert_eq!(broken(&resetting(given, done)).0, Rule::Closed, "{given} as {done}");
    }
}

#[test]
fn what_another_session_says_that_it_has_must_free_no_bank() {
    let mut own = 0;
    let report = hearing(move |packet| {
        if packet.is(Kind::RowIn) {
            own = packet.header.session;
        }
        if packet.is(Kind::RowAck) {
            packet.header.session = own;
        }
    });
    assert_eq!(miscounted(&report), Counter::NextRowOut);
}

/// Only in the sessions that the rules open.
#[test]
fn tables_must_stay_after_a_greeting() {
    let mut greetings = 0;
    let report = altering(move |toward, packet| {
        greetings += usize::from(toward == Toward::Host && packet.is(Kind::Hello));
        match packet.reply() {
            Some(Reply::Status(status)) if toward == Toward::Host && greetings > 1 && status.rows_in == 0 => {
                vec![packet.saying(&Reply::Status(Status { generation: 0, ..status }))]
            }
            _ => vec![packet],
        }
    });
    assert_eq!(miscounted(&report), Counter::Generation);
}

#[test]
fn rows_that_are_not_needed_must_be_counted() {
    let report = counting(|status| status.rows_unneeded = 0);
    assert_eq!(miscounted(&report), Counter::RowsUnneeded);
}

#[test]
fn any_number_but_0_must_clear_the_counters() {
    let report = hearing(|packet| {
        if packet.is(Kind::Status) && packet.payload.first() > Some(&1) {
            packet.payload[0] = 0;
        }
    });
    assert_eq!(miscounted(&report), Counter::RowsIn);
}

/// No link has a copy of a clearing request ready each time.
#[test]
fn a_board_that_clears_its_counters_whenever_it_is_asked_fails() {
    let report = hearing(|packet| {
        if packet.is(Kind::Status) {
            packet.payload[0] = 1;
        }
    });
    assert_eq!(failed_check(&report), Some(CheckName::Counters), "{}", report.headline());
}

#[test]
fn a_row_that_is_taken_where_it_must_be_refused_is_told_of_though_nothing_is_said() {
    let report = judge_by_plan(&plan(), open("mock,fault=rows-anywhere"));
    let (rule, _, found) = broken(&report);
    assert_eq!((rule, found), (Rule::RowPlace, &Answer::Taken {}));
}

/// Behind the RESET by which the host closes its session the board is whose it may be.
#[test]
fn another_host_may_take_a_board_whose_session_is_closed() {
    let (mut opened, mut is_closed, refused) = (0, false, Arc::new(AtomicUsize::new(0)));
    let seen = Arc::clone(&refused);
    let report = altering(move |toward, packet| {
        match (toward, packet.request()) {
            (Toward::Board, Some(Request::Reset(Reset { level: ResetLevel::Session, .. }))) => {
                is_closed = true;
            }
            (Toward::Board, Some(Request::Hello(_))) => opened += usize::from(is_closed),
            (Toward::Host, _) if packet.is(Kind::Hello) && opened > 0 => {
                let held = Refusal { code: RefusalCode::Held, kind: Kind::Hello.code(), detail: 90 };
                let mut refusal = packet.saying(&Reply::Refusal(held));
                refusal.header.kind = Kind::Refusal.code();
                seen.fetch_add(1, Ordering::Relaxed);
                return vec![refusal];
            }
            _ => {}
        }
        vec![packet]
    });
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    assert!(refused.load(Ordering::Relaxed) > 0);
}

/// The bytes of a request's payload.
fn payload(request: &Request<'_>) -> Vec<u8> {
    let mut payload = Vec::new();
    request.write(&mut payload);
    payload
}

/// It has neither session nor tables any more, and is the other host's at once.
#[test]
fn a_board_that_loses_its_power_while_another_host_asks_for_it_is_asked_again() {
    const NOBODYS: u16 = 0x4242;
    let (mut own, mut session, mut is_lost) = (None, 0, false);
    let report = altering(move |toward, packet| {
        if toward == Toward::Host {
            return Vec::from_iter((packet.header.sequence != NOBODYS).then_some(packet));
        }
        let Some((_, host)) = greeting(&packet) else {
            session = packet.header.session;
            return vec![packet];
        };
        if *own.get_or_insert(host) == host || std::mem::replace(&mut is_lost, true) {
            return vec![packet];
        }
        let resets = [ResetLevel::Tables, ResetLevel::Session].map(|level| {
            let reset = Request::Reset(Reset { level, next_row: 0 });
            let header =
                Header { kind: reset.kind().code(), sequence: NOBODYS, session, ..Header::default() };
            Passing { header, payload: payload(&reset) }
        });
        resets.into_iter().chain([packet]).collect()
    });
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
}

/// A board of a station that is frozen for a while, together with its clock, just before another host asks for the board the first
/// time.
struct Frozen {
    board: Board,
    decoder: Decoder,
    own: Option<u32>,
    /// For how long it was frozen.
    time: Duration,
}

impl Endpoint for Frozen {
    type Failure = Infallible;

    fn receive(&mut self, bytes: &[u8], now: Duration) -> Result<(), Infallible> {
        let mut rest = bytes;
        while let Some(packet) = self.decoder.next(&mut rest) {
            let Ok(Packet { header, payload }) = packet else { continue };
            if let Some((_, host)) = greeting(&Passing { header, payload: payload.to_vec() })
                && *self.own.get_or_insert(host) != host
            {
                self.time = Duration::from_secs(11);
            }
        }
        self.board.receive(bytes, now + self.time);
        Ok(())
    }

    fn outgoing(&mut self) -> &mut Vec<u8> {
        self.board.outgoing()
    }
}

#[test]
fn a_station_that_is_frozen_while_another_host_asks_for_the_board_makes_no_board_fail() {
    let board = Board::new(&Options::default(), None).unwrap();
    let frozen = Frozen { board, decoder: Decoder::new(), own: None, time: Duration::ZERO };
    let pipe = Pipe::new(frozen, PipeOptions::default(), None);
    let link = WireLink::new(pipe, "a frozen station", false);
    let report = judge_by_plan(&plan(), Candidate::new("frozen", BoardKind::Mock, link));
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
}

/// The link loses the first copy of each greeting that is repeated.
#[test]
fn a_repeated_greeting_must_be_answered_in_its_session_over_a_link_that_loses_packets_too() {
    let (mut own, mut copies) = (None, 0);
    let report = altering(move |toward, mut packet| {
        if toward == Toward::Host && packet.is(Kind::Hello) {
            let nonce = packet.payload[..4].to_vec();
            let is_first = own.is_none();
            if *own.get_or_insert_with(|| nonce.clone()) == nonce && !is_first {
                copies += 1;
                packet.header.session ^= 2;
                return Vec::from_iter((copies % 2 == 0).then_some(packet));
            }
        }
        vec![packet]
    });
    assert_eq!(broken(&report).0, Rule::NewSession, "{}", report.headline());
}
