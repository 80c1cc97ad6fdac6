//! ECHO, and packets that are not valid requests.

use halfrow_protocol::message::{RefusalCode, Request};
use halfrow_protocol::{Kind, MAX_PAYLOAD};
use proptest::prelude::*;

use crate::bench::Bench;
use crate::{Boards, cases};

pub(crate) fn bytes_come_back_as_they_went_up_to_4080(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    for length in [0, 1, 253, 254, 255, 508, 4079, 4080] {
        for fill in [0x00, 0x01, 0xff] {
            let bytes = vec![fill; length];
            assert_eq!(bench.done(&Request::Echo(&bytes)).payload, bytes);
        }
    }
    assert_eq!(MAX_PAYLOAD, 4080);
}

pub(crate) fn any_bytes_come_back_as_they_went(on: &dyn Boards) {
    proptest!(cases(on, 8, concat!(env!("CARGO_MANIFEST_DIR"), "/proptest-regressions/echo.txt")), |(bytes in prop::collection::vec(any::<u8>(), 0..=4080))| {
        prop_assert_eq!(&Bench::greeted(on).done(&Request::Echo(&bytes)).payload, &bytes);
    });
}

pub(crate) fn kinds_that_no_host_sends_are_refused(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    // The last four belong to bursts; a board may refuse them too.
    let requests =
        [0x00, 0x01, 0x02, 0x03, 0x04, 0x10, 0x11, 0x12, 0x13, 0x18, 0x20, 0x22, 0x30, 0x31, 0x32, 0x33];
    for kind in (0..=255).filter(|kind| !requests.contains(kind)) {
        let header = bench.header(kind);
        assert_eq!(bench.answer(&header, &[0; 64]).refusal(), Some((RefusalCode::Kind, 0)), "{kind:#04x}");
    }
    assert_eq!(bench.status().refusals, 256 - 16);
}

pub(crate) fn payloads_that_are_too_short_are_refused(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    let lengths = [
        (Kind::Status, 1),
        (Kind::Reset, 5),
        (Kind::TableWrite, 7),
        (Kind::TableRead, 7),
        (Kind::TableCrc, 7),
        (Kind::Commit, 11),
        (Kind::Configure, 13),
        (Kind::RowIn, 12),
    ];
    for (kind, length) in lengths {
        for short in 0..length {
            let header = bench.header(kind.code());
            let answer = bench.answer(&header, &vec![0; short]);
            assert_eq!(answer.refusal(), Some((RefusalCode::Payload, 0)), "{kind:?} of {short} bytes");
        }
    }
}

pub(crate) fn fields_without_meaning_are_refused(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    let tables_and_banks = [[2, 0], [0xff, 0], [0, 2], [0, 3], [0, 0xff]];
    let spans = [Kind::TableWrite, Kind::TableRead, Kind::TableCrc]
        .into_iter()
        .flat_map(|kind| tables_and_banks.map(|[table, bank]| (kind, [table, bank, 0, 0, 0, 0, 0])));
    for (kind, payload) in spans.chain([(Kind::Reset, [3, 0, 0, 0, 0, 0, 0])]) {
        let header = bench.header(kind.code());
        assert_eq!(bench.answer(&header, &payload).refusal(), Some((RefusalCode::Payload, 0)), "{kind:?}");
    }
}

pub(crate) fn entries_and_samples_that_are_missing_make_the_payload_too_short(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    let header = bench.header(Kind::TableWrite.code());
    let two_factors_announced = [0, 0, 0, 0, 0, 2, 0, 1, 0, 0, 0, 1, 0, 0];
    assert_eq!(bench.answer(&header, &two_factors_announced).refusal(), Some((RefusalCode::Payload, 0)));
    let header = bench.header(Kind::RowIn.code());
    let four_samples_announced = [0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 0, 0, 1, 2, 3, 4, 5];
    assert_eq!(bench.answer(&header, &four_samples_announced).refusal(), Some((RefusalCode::Payload, 0)));
}

pub(crate) fn the_reply_flag_of_a_request_is_not_looked_at(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    let mut header = bench.header(Kind::Echo.code());
    header.reply = true;
    assert_eq!(bench.answer(&header, b"flagged").payload, b"flagged");
}
