//! Section 2 of WIRE.md: the 10 s for which a silent host keeps the board.

use std::time::Duration;

use halfrow_protocol::message::{Hello, RefusalCode, Request, Reset, ResetLevel};
use halfrow_protocol::{Kind, VERSION};

use crate::Boards;
use crate::bench::{Bench, HELLO};

const OTHER: Request<'_> =
    Request::Hello(Hello { nonce: 0x0bad_cafe, host: 0x0000_0b0b, take_over: false, ..HELLO });

/// The refusal that another host gets at this time, in milliseconds.
fn other_is_told(bench: &mut Bench, milliseconds: u64) -> Option<(RefusalCode, u16)> {
    bench.now = Duration::from_millis(milliseconds);
    bench.ask(&OTHER).refusal()
}

pub(crate) fn another_host_is_told_for_how_long_the_board_is_held(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    for (milliseconds, tenths) in [(0, 100), (2700, 73), (5000, 50), (9900, 1)] {
        assert_eq!(other_is_told(&mut bench, milliseconds), Some((RefusalCode::Held, tenths)));
    }
}

pub(crate) fn a_refusal_of_hello_has_the_session_number_of_hello_and_the_boards_window(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    let window = bench.done(&Request::Echo(b"")).header.window;
    let refusal = bench.ask(&OTHER).header;
    assert_eq!((refusal.session, refusal.window), (0, window));
}

pub(crate) fn the_board_is_free_after_10_s_and_not_before(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    bench.now = Duration::from_nanos(9_999_999_999);
    assert_eq!(bench.refused(&OTHER), (RefusalCode::Held, 1));
    assert_eq!(other_is_told(&mut bench, 10_000), None);
}

pub(crate) fn the_host_that_holds_the_board_may_open_another_session_at_any_time(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    let old = bench.session;
    assert_ne!(bench.greet(&Hello { nonce: 1, ..HELLO }).session, old);
}

pub(crate) fn every_whole_packet_of_the_holder_counts_even_one_that_is_refused(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    bench.now = Duration::from_secs(6);
    bench.say(&Request::RowAck);
    assert_eq!(other_is_told(&mut bench, 9000), Some((RefusalCode::Held, 70)));
    let header = bench.header(0x55);
    bench.answer(&header, &[]);
    assert_eq!(other_is_told(&mut bench, 18_000), Some((RefusalCode::Held, 10)));
}

pub(crate) fn a_repeated_hello_of_the_holder_counts(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    bench.now = Duration::from_secs(6);
    bench.greet(&HELLO);
    assert_eq!(other_is_told(&mut bench, 11_000), Some((RefusalCode::Held, 50)));
}

pub(crate) fn damaged_and_foreign_packets_do_not_count(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    bench.now = Duration::from_secs(6);
    let mut damaged = bench.packet(&Request::Echo(b"damaged"));
    damaged[8] ^= 0x10;
    assert_eq!(bench.receive(&damaged), []);
    let open = bench.session;
    bench.session = bench.foreign();
    bench.ask(&Request::Echo(b"foreign"));
    bench.session = open;
    bench.refused(&OTHER);
    assert_eq!(other_is_told(&mut bench, 9000), Some((RefusalCode::Held, 10)));
    assert_eq!(other_is_told(&mut bench, 10_000), None);
}

pub(crate) fn a_closed_session_holds_nothing(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    bench.done(&Request::Reset(Reset { level: ResetLevel::Session, next_row: 0 }));
    assert_eq!(bench.ask(&OTHER).refusal(), None);
}

pub(crate) fn a_host_of_another_version_is_told_so_even_while_the_board_is_held(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    let header = bench.header(Kind::Hello.code());
    let payload = [1, 0, 0, 0, 2, 0, 0, 0, VERSION + 1, VERSION + 1, 0];
    assert_eq!(bench.answer(&header, &payload).refusal(), Some((RefusalCode::Version, VERSION.into())));
}
