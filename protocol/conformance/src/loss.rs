//! Section 4 of WIRE.md: what the board does with a row that is sent again.

use halfrow_protocol::message::RowOut;

use crate::bench::{Bench, ReceivedPacket, rows_of};
use crate::frames::{Row, ready, ready_if_offered, row, samples_of};
use crate::{Boards, Build};

fn board(on: &dyn Boards) -> Bench {
    ready(on, &Build::default(), 4)
}

pub(crate) fn a_row_that_waits_in_a_bank_is_not_taken_twice(on: &dyn Boards) {
    let mut bench = board(on);
    bench.send_all(4, [1]);
    let other = Row { samples: vec![0; 64], ..row(4, 1) };
    assert_eq!(bench.send(&other), []);
    let heard = bench.send_all(4, [0, 2]);
    assert_eq!(samples_of(&heard[1].row()), row(4, 1).samples, "the first one counts");
}

pub(crate) fn a_row_inside_the_core_is_not_answered(on: &dyn Boards) {
    let mut bench = board(on);
    assert_eq!(bench.send_all(4, [0, 0, 0]), []);
    assert_eq!(bench.status().rows_in, 1);
}

pub(crate) fn a_row_that_came_out_is_sent_again_with_one_repeat_more(on: &dyn Boards) {
    let mut bench = board(on);
    let first = bench.send_all(4, 0..2).remove(0);
    let repeats: Vec<ReceivedPacket> = bench.send_all(4, [0, 0, 0]);
    for (index, packet) in repeats.iter().enumerate() {
        let repeats = index as u16 + 1;
        assert_eq!(packet.row(), RowOut { repeats, ..first.row() });
        assert_eq!(packet.header.sequence, repeats, "it counts all ROW_OUT packets");
        assert!(!packet.header.reply);
    }
    assert_eq!((first.header.sequence, first.row().repeats), (0, 0));
}

pub(crate) fn repeats_are_counted_for_each_row(on: &dyn Boards) {
    let mut bench = board(on);
    bench.send_all(4, 0..4);
    let heard = bench.send_all(4, [2, 0, 2, 3]);
    let repeats: Vec<_> = heard.iter().map(|packet| packet.row().repeats).collect();
    assert_eq!((rows_of(&heard), repeats), (vec![2, 0, 2, 3], vec![1, 1, 2, 1]));
}

pub(crate) fn a_row_is_not_played_again(on: &dyn Boards) {
    let mut bench = board(on);
    bench.send_all(4, 0..4);
    let blank = Row { samples: vec![0; 64], ..row(4, 2) };
    let heard = bench.send(&blank);
    assert_eq!(samples_of(&heard[0].row()), row(4, 2).samples);
    assert_eq!(bench.status().rows_out, 4);
}

pub(crate) fn a_row_that_comes_again_is_not_judged_by_its_place(on: &dyn Boards) {
    let mut bench = board(on);
    bench.send_all(4, 0..4);
    let mut other = row(4, 2);
    (other.place.frame, other.place.row) = (77, 1);
    assert_eq!(bench.send(&other)[0].row().place, row(4, 2).place);
}

pub(crate) fn an_acknowledged_row_is_not_sent_again(on: &dyn Boards) {
    let mut bench = board(on);
    bench.send_all(4, 0..4);
    bench.acknowledge(3);
    assert_eq!(bench.send_all(4, 0..3), []);
    assert_eq!(rows_of(&bench.send_all(4, [3])), [3]);
    assert_eq!(bench.status().rows_unneeded, 3);
}

pub(crate) fn the_acknowledgement_in_the_row_itself_comes_first(on: &dyn Boards) {
    let mut bench = board(on);
    bench.send_all(4, 0..4);
    bench.window = 2;
    assert_eq!(bench.send_all(4, [1]), []);
}

pub(crate) fn sending_a_row_again_frees_no_bank_and_blocks_none(on: &dyn Boards) {
    let build = Build { row_banks_in: 2, row_banks_out: 2, ..Build::default() };
    let Some(mut bench) = ready_if_offered(on, &build, 8) else { return };
    bench.send_all(8, 0..4);
    assert_eq!(rows_of(&bench.send_all(8, [0, 0])), [0, 0]);
    assert_eq!(bench.status().rows_out, 1);
    assert_eq!(rows_of(&bench.acknowledge(1)), [1]);
}
