//! Section 4 of WIRE.md: rows are played in the order of their numbers, and must follow each other.

use halfrow_protocol::Kind;
use halfrow_protocol::message::{
    Configuration, Hello, RefusalCode, Request, Reset, ResetLevel, RowIn, RowPlace,
};

use crate::bench::{Bench, HELLO, ReceivedPacket, rows_of, wire};
use crate::frames::{Row, configuration, make_ready, ready, row, samples_of};
use crate::uploads::TableSet;
use crate::{Boards, Build};

fn board(on: &dyn Boards, height: u16) -> Bench {
    ready(on, &Build::default(), height)
}

fn refusals(heard: &[ReceivedPacket]) -> Vec<(RefusalCode, u16)> {
    heard.iter().filter_map(ReceivedPacket::refusal).collect()
}

const ROW: [(RefusalCode, u16); 1] = [(RefusalCode::Row, 0)];
const NOT_READY: [(RefusalCode, u16); 1] = [(RefusalCode::NotReady, 0)];

/// The row of this number with its place changed and its samples kept.
fn moved(height: u16, number: u32, change: impl FnOnce(&mut RowPlace)) -> Row {
    let mut row = row(height, number);
    change(&mut row.place);
    row
}

pub(crate) fn a_later_row_waits_for_the_missing_one(on: &dyn Boards) {
    let mut bench = board(on, 4);
    assert_eq!(bench.send_all(4, [3, 2, 1]), []);
    assert_eq!(rows_of(&bench.send_all(4, [0])), [0, 1, 2, 3]);
}

pub(crate) fn every_order_of_arrival_gives_the_same_rows(on: &dyn Boards) {
    for order in [[0, 1, 2, 3], [1, 0, 3, 2], [2, 3, 0, 1], [3, 0, 2, 1], [1, 3, 2, 0]] {
        let mut bench = board(on, 4);
        let heard = bench.send_all(4, order);
        assert_eq!(rows_of(&heard), [0, 1, 2, 3]);
        for (number, packet) in heard.iter().enumerate() {
            assert_eq!(samples_of(&packet.row()), row(4, number as u32).samples);
        }
    }
}

pub(crate) fn places_come_back_as_they_went(on: &dyn Boards) {
    let mut bench = board(on, 2);
    let places: Vec<_> = bench.send_all(2, 0..4).iter().map(|packet| packet.row().place).collect();
    assert_eq!(places, [0, 1, 2, 3].map(|number| row(2, number).place));
}

pub(crate) fn rows_that_are_not_the_configurations_are_refused(on: &dyn Boards) {
    let mut bench = board(on, 4);
    for wrong in [
        Row { samples: vec![0; 62], ..moved(4, 0, |place| place.width = 62) },
        Row { samples: vec![0; 66], ..moved(4, 0, |place| place.width = 66) },
        Row { samples: vec![], ..moved(4, 0, |place| place.width = 0) },
        // No configuration has an odd width.
        moved(4, 0, |place| place.width = 63),
        Row { samples: vec![0; 66], ..moved(4, 0, |place| place.width = 65) },
        moved(4, 0, |place| place.row = 4),
        moved(4, 0, |place| place.row = u16::MAX),
        moved(4, 0, |place| place.last = true),
        moved(4, 3, |place| place.last = false),
        moved(4, 2, |place| place.last = true),
    ] {
        assert_eq!(refusals(&bench.send(&wrong)), ROW, "{:?}", wrong.place);
    }
    assert_eq!(bench.status().rows_in, 0);
}

pub(crate) fn a_refused_row_can_be_sent_right(on: &dyn Boards) {
    let mut bench = board(on, 1);
    bench.send(&moved(1, 0, |place| place.last = false));
    assert_eq!(rows_of(&bench.send_all(1, [0])), [0]);
}

pub(crate) fn a_row_must_follow_the_one_that_was_played(on: &dyn Boards) {
    for change in [
        |place: &mut RowPlace| place.row = 2,
        |place: &mut RowPlace| place.frame = 1,
        |place: &mut RowPlace| (place.row, place.last) = (3, true),
    ] {
        let mut bench = board(on, 4);
        bench.send_all(4, [0]);
        assert_eq!(refusals(&bench.send(&moved(4, 1, change))), ROW);
    }
}

pub(crate) fn a_row_must_follow_the_one_that_waits(on: &dyn Boards) {
    let mut bench = board(on, 4);
    bench.send_all(4, [1]);
    assert_eq!(refusals(&bench.send(&moved(4, 2, |place| place.row = 1))), ROW);
    assert_eq!(refusals(&bench.send(&moved(4, 2, |place| place.frame = 9))), ROW);
    assert_eq!(bench.send_all(4, [2]), []);
}

pub(crate) fn nothing_but_row_0_follows_the_last_row(on: &dyn Boards) {
    let mut bench = board(on, 2);
    bench.send_all(2, 0..2);
    assert_eq!(refusals(&bench.send(&moved(2, 2, |place| (place.row, place.last) = (1, true)))), ROW);
    assert_eq!(refusals(&bench.send(&moved(2, 2, |place| (place.frame, place.row) = (0, 2)))), ROW);
    assert_eq!(bench.send_all(2, [2]), []);
}

pub(crate) fn a_frame_that_became_taller_goes_on_behind_the_row_that_was_its_last(on: &dyn Boards) {
    let mut bench = board(on, 2);
    bench.send_all(2, 0..2);
    bench.window = 2;
    bench.done(&Request::Configure(configuration(4)));
    assert_eq!(bench.send_all(4, [2]), [], "row 2 of frame 0");
    let heard = bench.send_all(4, [3]);
    assert_eq!(rows_of(&heard), [2, 3]);
    assert_eq!(heard[0].row().place, row(4, 2).place);
}

pub(crate) fn the_first_row_of_all_is_row_0(on: &dyn Boards) {
    let mut bench = board(on, 4);
    let wrong = moved(4, 0, |place| place.row = 1);
    assert_eq!(refusals(&bench.send(&wrong)), ROW);
    assert_eq!(bench.status().next_row_in, 0);
}

pub(crate) fn a_row_whose_predecessor_is_missing_is_taken_as_it_is(on: &dyn Boards) {
    let mut bench = board(on, 4);
    assert_eq!(bench.send(&moved(4, 2, |place| place.row = 1)), []);
    assert_eq!(bench.status().rows_in, 1);
}

pub(crate) fn a_row_that_its_late_predecessor_does_not_fit_is_played_under_the_place_that_it_names(
    on: &dyn Boards,
) {
    let mut bench = board(on, 4);
    let misplaced = moved(4, 1, |place| place.row = 2);
    assert_eq!(bench.send(&misplaced), []);
    assert_eq!(rows_of(&bench.send_all(4, [0])), [0]);
    assert_eq!(refusals(&bench.send_all(4, [2])), ROW, "it is row 2 of the frame once more");
    let heard = bench.send(&moved(4, 2, |place| (place.row, place.last) = (3, true)));
    assert_eq!(heard.iter().map(|packet| packet.row().place.row).collect::<Vec<_>>(), [2, 3]);
    assert_eq!(samples_of(&heard[0].row()), misplaced.samples);
}

pub(crate) fn row_0_may_follow_any_row(on: &dyn Boards) {
    let mut bench = board(on, 4);
    bench.send_all(4, 0..2);
    let rows = [0, 1, 2, 3]
        .map(|number| moved(4, number, |place| (place.row_sequence, place.frame) = (number + 2, 1)));
    let heard: Vec<_> = rows[..2].iter().flat_map(|row| bench.send(row)).collect();
    assert_eq!(rows_of(&heard), [1, 2]);
    assert_eq!(samples_of(&heard[1].row()), rows[0].samples);
    assert_eq!((heard[1].row().first_latency, heard[1].row().last_latency), (44, 44));
}

/// Sends a row with its payload changed by `change`.
fn send_changed(bench: &mut Bench, row: &Row, change: impl FnOnce(&mut Vec<u8>)) -> Vec<ReceivedPacket> {
    let header = bench.header(Kind::RowIn.code());
    let mut payload = Vec::new();
    RowIn::write_samples(&row.place, &row.samples, &mut payload);
    change(&mut payload);
    bench.receive(&wire(&header, |to| to.extend(payload)))
}

pub(crate) fn generation_and_further_flags_of_a_row_are_not_looked_at(on: &dyn Boards) {
    let mut bench = board(on, 2);
    let sent = (0..2).flat_map(|number| {
        send_changed(&mut bench, &row(2, number), |payload| {
            payload[10] |= 0xfe;
            payload[11] = 255;
        })
    });
    let heard: Vec<_> = sent.collect();
    assert_eq!(
        heard.iter().map(|packet| packet.payload[10..12].to_vec()).collect::<Vec<_>>(),
        [[0, 1], [1, 1]]
    );
    for (number, packet) in (0..).zip(&heard) {
        assert_eq!(packet.row().place, row(2, number).place);
    }
}

pub(crate) fn of_several_wrong_things_about_a_row_the_first_of_the_page_is_named(on: &dyn Boards) {
    const CREDIT: [(RefusalCode, u16); 1] = [(RefusalCode::Credit, 0)];
    let wide = |number| Row { samples: vec![0; 66], ..moved(4, number, |place| place.width = 66) };
    let mut bench = Bench::greeted(on);
    for is_configured in [false, true] {
        if is_configured {
            bench.done(&Request::Configure(configuration(4)));
        }
        assert_eq!(refusals(&bench.send(&wide(1000))), CREDIT, "{is_configured}");
        assert_eq!(refusals(&bench.send(&wide(0))), NOT_READY, "{is_configured}");
    }
    make_ready(&mut bench, 4);
    assert_eq!(refusals(&bench.send(&wide(1000))), CREDIT);
    bench.send_all(4, [0]);
    for row in [wide(1000), wide(0), row(4, 0)] {
        let heard = send_changed(&mut bench, &row, |payload| payload.truncate(payload.len() - 1));
        assert_eq!(refusals(&heard), [(RefusalCode::Payload, 0)], "{:?}", row.place);
    }
    bench.done(&Request::Reset(Reset { level: ResetLevel::Tables, next_row: 4 }));
    assert_eq!(bench.send(&wide(0)), [], "it is known, though nothing is ready");
    assert_eq!(refusals(&bench.send(&wide(4))), NOT_READY);
}

pub(crate) fn frame_numbers_are_as_the_host_likes(on: &dyn Boards) {
    let mut bench = board(on, 1);
    bench.send_all(1, [0]);
    for (row_sequence, frame) in [(1, 65535), (2, 0), (3, 0)] {
        let heard = bench.send(&moved(1, row_sequence, |place| place.frame = frame));
        assert_eq!(heard[0].row().place.frame, frame);
    }
}

pub(crate) fn without_configuration_or_tables_no_row_is_taken(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    let tables = TableSet::unstretched(4);
    assert_eq!(refusals(&bench.send_all(4, [0])), NOT_READY);
    tables.upload(&mut bench);
    bench.done(&Request::Configure(configuration(4)));
    for number in 0..4 {
        assert_eq!(refusals(&bench.send_all(4, [number])), NOT_READY, "row {number}");
    }
    bench.done(&tables.commit(1, 0));
    assert_eq!(rows_of(&bench.send_all(4, 0..4)), [0, 1, 2, 3]);
}

pub(crate) fn a_configuration_that_outlives_the_session_serves_the_next_one(on: &dyn Boards) {
    let mut bench = board(on, 1);
    bench.send_all(1, [0]);
    bench.greet(&Hello { nonce: 3, ..HELLO });
    assert_eq!(rows_of(&bench.send_all(1, [0])), [0]);
}

pub(crate) fn rows_behind_the_frame_that_a_commit_waits_for_may_come_before_it(on: &dyn Boards) {
    let mut bench = board(on, 1);
    assert_eq!(bench.send_all(1, [2, 1]), [], "frames 1 and 2, while frame 0 is missing");
    let heard = bench.send_all(1, [0]);
    assert_eq!(rows_of(&heard), [0, 1, 2]);
    assert!(heard.iter().all(|packet| packet.row().generation == 1));
}

pub(crate) fn a_wider_configuration_takes_wider_rows(on: &dyn Boards) {
    let mut bench = board(on, 1);
    bench.done(&Request::Configure(Configuration { width: 2048, ..configuration(1) }));
    assert_eq!(refusals(&bench.send_all(1, [0])), ROW);
    let wide = Row { samples: vec![7; 2048], ..moved(1, 0, |place| place.width = 2048) };
    assert_eq!(bench.send(&wide)[0].row().place.width, 2048);
}
