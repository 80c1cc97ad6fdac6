//! Section 2 of WIRE.md: how a session opens, and what happens to packets of another session.

use halfrow_protocol::message::{Hello, RefusalCode, Reply, Request, Reset, ResetLevel};
use halfrow_protocol::{Header, Kind};

use crate::bench::{Bench, HELLO, following, rows_of, wire};
use crate::frames::{ready, row};
use crate::{Boards, Build, offered};

const OTHER: Hello = Hello { nonce: 0x0bad_cafe, host: 0x0000_0b0b, take_over: false, ..HELLO };

fn new_board(on: &dyn Boards) -> Bench {
    Bench::switched_on(on, &Build::default())
}

pub(crate) fn hello_is_answered_with_nonce_magic_version_and_session(on: &dyn Boards) {
    let mut bench = new_board(on);
    let answer = bench.done(&Request::Hello(HELLO));
    let (start, rest) = answer.payload.split_at(10);
    assert_eq!(start, [0x0d, 0xf0, 0x0d, 0x60, 0x48, 0x52, 0x57, 0x31, 1, answer.header.session]);
    assert_eq!(rest.len(), 12, "build and serial");
    assert_ne!(answer.header.session, 0);
}

pub(crate) fn the_reply_to_hello_gives_credit_for_the_input_banks(on: &dyn Boards) {
    for row_banks_in in [2, 4, 7] {
        let build = Build { row_banks_in, row_banks_out: row_banks_in.min(4), ..Build::default() };
        for build in offered(on, [build]) {
            let mut bench = Bench::switched_on(on, &build);
            assert_eq!(bench.done(&Request::Hello(HELLO)).header.window, row_banks_in.into());
        }
    }
}

pub(crate) fn a_repeated_nonce_is_answered_as_the_first_time_and_changes_nothing(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 4);
    bench.send_all(4, 0..2);
    let before = bench.status();
    let session = bench.session;
    assert_eq!(bench.greet(&HELLO).session, session);
    let after = bench.status();
    assert_eq!((after.next_row_in, after.rows_in, after.core_busy), (2, 2, 1));
    assert_eq!(after.packets, before.packets + 2, "the HELLO and this STATUS");
}

pub(crate) fn the_same_nonce_of_another_host_opens_a_session_of_its_own(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 4);
    bench.send_all(4, 0..2);
    let session = bench.session;
    let other = Hello { nonce: HELLO.nonce, ..OTHER };
    assert_eq!(bench.refused(&Request::Hello(other)).0, RefusalCode::Held);
    assert_eq!(bench.greet(&Hello { take_over: true, ..other }).session, following(session));
    assert_eq!(bench.status().next_row_in, 0);
}

pub(crate) fn a_new_session_drops_rows_and_counters_and_keeps_configuration_and_tables(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 4);
    bench.send_all(4, [0, 1, 3]);
    let old = bench.session;
    bench.greet(&Hello { nonce: 1, ..HELLO });
    assert_ne!(bench.session, old);
    let status = bench.status();
    assert_eq!((status.rows_in, status.rows_out, status.next_row_in, status.core_busy), (0, 0, 0, 0));
    assert_eq!((status.packets, status.generation), (1, 1));
    assert_eq!(rows_of(&bench.send_all(4, 0..4)), [0, 1, 2, 3]);
}

pub(crate) fn rows_are_counted_from_0_again_in_a_new_session(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 4);
    bench.send_all(4, 0..4);
    bench.greet(&Hello { nonce: 1, ..HELLO });
    let numbers: Vec<_> = bench.send_all(4, 0..4).iter().map(|packet| packet.header.sequence).collect();
    assert_eq!(numbers, [0, 1, 2, 3]);
}

pub(crate) fn sessions_are_counted_and_1_comes_behind_255(on: &dyn Boards) {
    let mut bench = new_board(on);
    let mut last = bench.greet(&HELLO).session;
    for nonce in 0..600 {
        let session = bench.greet(&Hello { nonce, ..HELLO }).session;
        assert_eq!(session, following(last));
        last = session;
    }
}

pub(crate) fn a_session_that_was_closed_is_counted(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    let closed = bench.session;
    bench.done(&Request::Reset(Reset { level: ResetLevel::Session, next_row: 0 }));
    assert_eq!(bench.greet(&Hello { nonce: 1, ..HELLO }).session, following(closed));
}

pub(crate) fn without_a_common_version_the_refusal_names_the_boards(on: &dyn Boards) {
    let mut bench = new_board(on);
    for (version_min, version_max) in [(2, 255), (0, 0), (2, 1)] {
        let hello = Hello { version_min, version_max, ..HELLO };
        assert_eq!(bench.refused(&Request::Hello(hello)), (RefusalCode::Version, 1));
    }
    assert_eq!(bench.greet(&Hello { version_min: 0, version_max: 255, ..HELLO }).version, 1);
}

pub(crate) fn a_hello_that_is_too_short_is_refused(on: &dyn Boards) {
    let mut bench = new_board(on);
    let header = bench.header(Kind::Hello.code());
    assert_eq!(bench.answer(&header, &[0; 10]).refusal(), Some((RefusalCode::Payload, 0)));
}

pub(crate) fn hello_may_carry_fields_of_a_later_version(on: &dyn Boards) {
    let mut bench = new_board(on);
    let header = bench.header(Kind::Hello.code());
    let mut payload = vec![0; 8];
    payload.extend([1, 9, 0, 0xaa, 0xbb]);
    assert_eq!(bench.answer(&header, &payload).refusal(), None);
}

pub(crate) fn outside_a_session_all_but_hello_is_refused(on: &dyn Boards) {
    let mut bench = new_board(on);
    let reset = Request::Reset(Reset { level: ResetLevel::Rows, next_row: 0 });
    for request in [Request::Capabilities, Request::Status { clear: false }, Request::Echo(b"?"), reset] {
        for session in [0, 1, 255] {
            bench.session = session;
            let answer = bench.ask(&request);
            assert_eq!(answer.refusal(), Some((RefusalCode::Session, 0)));
            assert_eq!(answer.header.session, session);
        }
    }
}

pub(crate) fn a_refusal_of_a_foreign_packet_carries_its_session_number(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    let open = bench.session;
    for session in (0..=255).filter(|&session| session != open) {
        bench.session = session;
        let answer = bench.ask(&Request::Echo(b"whose?"));
        assert_eq!(answer.refusal(), Some((RefusalCode::Session, 0)));
        assert_eq!(answer.header.session, session);
    }
    bench.session = open;
    let status = bench.status();
    assert_eq!((status.foreign_packets, status.refusals), (255, 255));
}

pub(crate) fn the_session_is_looked_at_before_kind_and_payload(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    bench.session = bench.foreign();
    for kind in [0x55, Kind::Status.code()] {
        let header = bench.header(kind);
        assert_eq!(bench.answer(&header, &[]).refusal(), Some((RefusalCode::Session, 0)));
    }
}

pub(crate) fn a_foreign_acknowledgement_is_counted_and_not_answered(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    let open = bench.session;
    bench.session = bench.foreign();
    assert_eq!(bench.say(&Request::RowAck), []);
    bench.session = open;
    let status = bench.status();
    assert_eq!((status.foreign_packets, status.refusals), (1, 0));
}

pub(crate) fn a_foreign_packet_is_not_carried_out(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 4);
    bench.send_all(4, 0..2);
    let open = bench.session;
    (bench.session, bench.window) = (bench.foreign(), 1);
    bench.ask(&Request::Reset(Reset { level: ResetLevel::Tables, next_row: 9 }));
    assert_eq!(bench.send(&row(4, 2))[0].refusal(), Some((RefusalCode::Session, 0)));
    (bench.session, bench.window) = (open, 0);
    let status = bench.status();
    assert_eq!((status.next_row_in, status.next_row_out, status.generation), (2, 0, 1));
}

pub(crate) fn the_window_of_hello_is_not_looked_at(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 4);
    bench.send_all(4, 0..2);
    bench.window = 1;
    bench.done(&Request::Hello(HELLO));
    bench.window = 0;
    assert_eq!(bench.status().next_row_out, 0);
}

pub(crate) fn a_hello_that_names_a_session_is_answered_with_the_one_it_opens(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    // Open at first, and no longer at the second time.
    let session = bench.session;
    for nonce in [1, 2] {
        let hello = Hello { nonce, ..HELLO };
        let header = Header { session, ..bench.header(Kind::Hello.code()) };
        let heard = bench.receive(&wire(&header, |payload| Request::Hello(hello).write(payload)));
        let Reply::Hello(welcome) = heard[0].reply() else { panic!("{heard:?}") };
        assert_eq!(heard[0].header.session, welcome.session);
        assert_ne!(welcome.session, session);
    }
}

pub(crate) fn whoever_takes_over_has_the_board_and_the_other_one_is_told(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    let old = bench.session;
    bench.greet(&Hello { take_over: true, ..OTHER });
    let new = bench.session;
    bench.session = old;
    let answer = bench.ask(&Request::Echo(b"mine?"));
    assert_eq!((answer.refusal(), answer.header.session), (Some((RefusalCode::Session, 0)), old));
    bench.session = new;
    bench.done(&Request::Echo(b"mine"));
    assert_eq!(bench.refused(&Request::Hello(Hello { nonce: 9, ..HELLO })), (RefusalCode::Held, 100));
}

pub(crate) fn any_take_over_but_0_is_one(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    let header = bench.header(Kind::Hello.code());
    let mut payload = Vec::new();
    Request::Hello(OTHER).write(&mut payload);
    *payload.last_mut().unwrap() = 0x80;
    assert_eq!(bench.answer(&header, &payload).refusal(), None);
}
