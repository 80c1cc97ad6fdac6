//! RESET: what each level drops, and where the window continues.

use halfrow_protocol::message::{Hello, RefusalCode, Request, Reset, ResetLevel, Status};

use crate::bench::{Bench, HELLO, rows_of};
use crate::frames::{Row, configuration, make_ready, ready, row, samples_of};
use crate::uploads::TableSet;
use crate::{Boards, Build};

fn reset(level: ResetLevel, next_row: u32) -> Request<'static> {
    Request::Reset(Reset { level, next_row })
}

/// Row `number` of frames of four rows that are numbered from `first` on.
fn row_behind(first: u32, number: u32) -> Row {
    let mut row = row(4, number);
    row.place.row_sequence += first;
    row
}

/// A board with one row in the core, one that waits, and one that is not acknowledged.
fn full_of_rows(on: &dyn Boards) -> Bench {
    let mut bench = ready(on, &Build::default(), 4);
    bench.send_all(4, [0, 1, 3]);
    bench
}

pub(crate) fn level_0_drops_all_rows_and_keeps_the_rest(on: &dyn Boards) {
    let mut bench = full_of_rows(on);
    bench.done(&reset(ResetLevel::Rows, 4));
    let Status { next_row_in, next_row_out, core_busy, generation, rows_in, .. } = bench.status();
    assert_eq!((next_row_in, next_row_out, core_busy, generation, rows_in), (4, 4, 0, 1, 3));
    let corrected: Vec<_> = (0..4).flat_map(|number| bench.send(&row_behind(4, number))).collect();
    assert_eq!(rows_of(&corrected), [4, 5, 6, 7]);
}

pub(crate) fn rows_in_front_of_the_next_one_count_as_acknowledged(on: &dyn Boards) {
    let mut bench = full_of_rows(on);
    bench.done(&reset(ResetLevel::Rows, 9));
    assert_eq!(bench.send_all(4, [0, 1, 3]), []);
    assert_eq!(bench.status().rows_unneeded, 3);
}

pub(crate) fn the_window_is_counted_from_the_next_row(on: &dyn Boards) {
    let mut bench = full_of_rows(on);
    let window = bench.done(&Request::Echo(b"")).header.window;
    assert_eq!(window, 6, "two rows have entered, and there are four banks");
    assert_eq!(bench.done(&reset(ResetLevel::Rows, window)).header.window, 10);
    assert_eq!(bench.send(&row_behind(10, 0))[0].refusal(), Some((RefusalCode::Credit, 0)));
    assert_eq!(bench.send(&row_behind(6, 3)), []);
    assert_eq!(bench.status().next_row_in, 6);
}

pub(crate) fn rows_are_counted_on_through_a_reset(on: &dyn Boards) {
    let mut bench = full_of_rows(on);
    bench.done(&reset(ResetLevel::Rows, 4));
    let sequences: Vec<_> = (0..3).flat_map(|number| bench.send(&row_behind(4, number))).collect();
    let sequences: Vec<_> = sequences.iter().map(|packet| packet.header.sequence).collect();
    assert_eq!(sequences, [1, 2], "one was sent before the reset");
}

pub(crate) fn a_frame_must_begin_anew_behind_a_reset(on: &dyn Boards) {
    let mut bench = full_of_rows(on);
    bench.done(&reset(ResetLevel::Rows, 4));
    assert_eq!(bench.send(&row_behind(2, 2))[0].refusal(), Some((RefusalCode::Row, 0)));
    assert_eq!(bench.status().rows_in, 3);
}

pub(crate) fn level_1_answers_and_closes_the_session(on: &dyn Boards) {
    let mut bench = full_of_rows(on);
    let session = bench.session;
    let answer = bench.done(&reset(ResetLevel::Session, 4));
    assert_eq!((answer.header.session, answer.payload.len()), (session, 0));
    assert_eq!(bench.refused(&Request::Capabilities), (RefusalCode::Session, 0));
    let other = Hello { nonce: 2, host: 2, ..HELLO };
    assert_ne!(bench.greet(&other).session, session);
    let status = bench.status();
    assert_eq!((status.generation, status.next_row_in), (1, 0));
    assert_eq!(rows_of(&bench.send_all(4, 0..2)), [0]);
}

pub(crate) fn a_nonce_opens_another_session_once_its_own_is_closed(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    let session = bench.session;
    bench.done(&reset(ResetLevel::Session, 0));
    assert_ne!(bench.greet(&HELLO).session, session);
}

pub(crate) fn level_2_drops_configuration_and_tables_too(on: &dyn Boards) {
    let mut bench = full_of_rows(on);
    bench.done(&reset(ResetLevel::Tables, 4));
    let status = bench.status();
    assert_eq!((status.generation, status.core_busy, status.next_row_in), (0, 0, 4));
    assert_eq!(bench.send(&row_behind(4, 0))[0].refusal(), Some((RefusalCode::NotReady, 0)));
    let tables = TableSet::unstretched(4);
    assert_eq!(bench.refused(&tables.commit(7, 0)), (RefusalCode::NotReady, 0));
    bench.done(&Request::Configure(configuration(4)));
    assert_eq!(bench.send(&row_behind(4, 0))[0].refusal(), Some((RefusalCode::NotReady, 0)));
    assert_eq!(bench.refused(&tables.commit(7, 0)), (RefusalCode::TableCrc, 1), "the kernel is gone");
    make_ready(&mut bench, 4);
    assert_eq!(bench.send(&row_behind(4, 0)), []);
    assert_eq!(bench.status().generation, 1);
}

pub(crate) fn a_reset_to_a_smaller_row_begins_there_anew(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 4);
    assert_eq!(bench.send_all(4, 0..8).len(), 4, "the output banks are full");
    bench.acknowledge(4);
    let packets = bench.status().rows_out;
    bench.window = 0;
    assert_eq!(bench.done(&reset(ResetLevel::Rows, 0)).header.window, 4);
    let Status { next_row_in, next_row_out, core_busy, .. } = bench.status();
    assert_eq!((next_row_in, next_row_out, core_busy), (0, 0, 0));
    let other = Row { samples: row(4, 9).samples, ..row(4, 0) };
    assert_eq!(bench.send(&other), [], "it is a row that the board does not know");
    let heard = bench.send_all(4, [1]);
    assert_eq!((rows_of(&heard), samples_of(&heard[0].row())), (vec![0], other.samples));
    assert_eq!((heard[0].row().repeats, u32::from(heard[0].header.sequence)), (0, packets));
}

pub(crate) fn a_repeated_reset_changes_nothing(on: &dyn Boards) {
    let mut bench = full_of_rows(on);
    bench.done(&reset(ResetLevel::Rows, 20));
    let status = bench.status();
    assert_eq!(bench.done(&reset(ResetLevel::Rows, 20)).header.window, 24);
    assert_eq!(bench.status(), Status { packets: status.packets + 2, ..status });
}

pub(crate) fn a_reset_ends_a_wait_for_a_lost_row(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 4);
    bench.send_all(4, [1, 2, 3]);
    assert_eq!(bench.refused(&Request::Configure(configuration(4))), (RefusalCode::Busy, 0));
    bench.done(&reset(ResetLevel::Rows, 8));
    bench.done(&Request::Configure(configuration(4)));
}

pub(crate) fn the_last_row_numbers_of_all_can_be_waited_for(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 1);
    bench.send_all(1, [0]);
    for next_row in [u32::MAX - 2, u32::MAX - 1, u32::MAX] {
        bench.done(&reset(ResetLevel::Rows, next_row));
        assert_eq!(bench.status().next_row_in, next_row);
        for row_sequence in next_row..=u32::MAX {
            let mut row = row(1, 0);
            row.place.row_sequence = row_sequence;
            bench.send(&row);
            bench.acknowledge(u32::MAX);
        }
        assert_eq!(bench.status().next_row_in, u32::MAX);
    }
}
