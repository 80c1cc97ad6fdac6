//! COMMIT: when tables become active, and when they do not.

use halfrow_protocol::message::{Bank, Commit, Hello, RefusalCode, Reply, Request, Reset, ResetLevel, Table};

use crate::bench::{Bench, HELLO, ReceivedPacket};
use crate::frames::{configuration, ready, row, samples_of};
use crate::golden_rows::HERMITE;
use crate::material::{GOLDEN_FACTOR, UNSTRETCHED, hermite, noise_row};
use crate::uploads::{TableSet, span};
use crate::{Boards, Build};

/// Generation and samples of the rows that came back.
fn made(heard: &[ReceivedPacket]) -> Vec<(u8, Vec<u16>)> {
    heard.iter().map(|packet| (packet.row().generation, samples_of(&packet.row()))).collect()
}

fn golden_tables() -> TableSet {
    TableSet::new(&[GOLDEN_FACTOR], &hermite())
}

/// A board that has played frame 0, of one row, with tables of generation 1, and whose row is acknowledged.
fn in_use(on: &dyn Boards) -> Bench {
    let mut bench = ready(on, &Build::default(), 1);
    bench.send_all(1, [0]);
    bench.acknowledge(1);
    bench
}

pub(crate) fn the_reply_names_the_generation(on: &dyn Boards) {
    let mut bench = in_use(on);
    golden_tables().upload(&mut bench);
    let answer = bench.done(&golden_tables().commit(255, 3));
    assert_eq!(answer.reply(), Reply::Commit { generation: 255 });
}

pub(crate) fn a_commit_takes_effect_with_row_0_of_its_frame_and_not_before(on: &dyn Boards) {
    let mut bench = in_use(on);
    golden_tables().upload(&mut bench);
    bench.done(&golden_tables().commit(2, 3));
    let rows = bench.send_all(1, 1..5);
    let generations: Vec<_> = made(&rows).iter().map(|(generation, _)| *generation).collect();
    assert_eq!(generations, [1, 1, 2, 2]);
    assert_eq!(bench.status().generation, 2);
}

pub(crate) fn a_commit_waits_through_frames_of_higher_numbers(on: &dyn Boards) {
    let mut bench = in_use(on);
    golden_tables().upload(&mut bench);
    bench.done(&golden_tables().commit(2, 3));
    let generations = [(1, 5), (2, 6), (3, 3)].map(|(number, frame)| {
        let mut row = row(1, number);
        row.place.frame = frame;
        made(&bench.send(&row))[0].0
    });
    assert_eq!(generations, [1, 1, 2]);
}

pub(crate) fn two_frames_back_to_back_have_their_own_tables(on: &dyn Boards) {
    let mut bench = in_use(on);
    golden_tables().upload(&mut bench);
    bench.done(&golden_tables().commit(2, 2));
    let (mut first, mut second) = (row(1, 1), row(1, 2));
    for row in [&mut first, &mut second] {
        row.samples = noise_row(0, 64);
    }
    // Both arrive before the rest of the first one has left.
    let both = [bench.row_packet(&first), bench.row_packet(&second)].concat();
    let unchanged = first.samples.clone();
    assert_eq!(made(&bench.receive(&both)), [(1, unchanged), (2, HERMITE.to_vec())]);
}

pub(crate) fn every_row_of_the_frame_is_made_with_the_new_tables(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 2);
    bench.send_all(2, [0, 1]);
    bench.window = 2;
    let tables = TableSet::new(&[GOLDEN_FACTOR; 2], &hermite());
    tables.upload(&mut bench);
    bench.done(&tables.commit(2, 2));
    let generations: Vec<_> =
        made(&bench.send_all(2, 2..6)).iter().map(|(generation, _)| *generation).collect();
    assert_eq!(generations, [1, 1, 2, 2]);
}

pub(crate) fn a_crc_that_is_not_the_tables_is_refused_with_the_table(on: &dyn Boards) {
    let mut bench = in_use(on);
    golden_tables().upload(&mut bench);
    let Request::Commit(right) = golden_tables().commit(2, 1) else { unreachable!() };
    for (wrong, table) in [
        (Commit { steps_crc: !right.steps_crc, ..right }, 0),
        (Commit { kernel_crc: right.kernel_crc ^ 1, ..right }, 1),
    ] {
        assert_eq!(bench.refused(&Request::Commit(wrong)), (RefusalCode::TableCrc, table));
    }
    assert_eq!(made(&bench.send_all(1, [1]))[0].0, 1, "everything stays as it was");
    bench.done(&Request::Commit(Commit { first_frame: 2, ..right }));
}

pub(crate) fn the_crc_covers_the_factors_of_the_configured_height(on: &dyn Boards) {
    let mut bench = in_use(on);
    bench.done(&Request::Configure(configuration(3)));
    let tables = TableSet::new(&[5, 6, 7], &hermite());
    tables.upload(&mut bench);
    let shorter = TableSet::new(&[5, 6], &hermite());
    assert_eq!(bench.refused(&shorter.commit(2, 1)), (RefusalCode::TableCrc, 0));
    bench.done(&tables.commit(2, 1));
}

pub(crate) fn a_repeated_commit_is_answered_and_changes_nothing(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 1);
    let commit = TableSet::unstretched(1).commit(1, 0);
    assert_eq!(bench.done(&commit).reply(), Reply::Commit { generation: 1 }, "while it is pending");
    bench.send_all(1, [0]);
    golden_tables().upload(&mut bench);
    assert_eq!(bench.done(&commit).reply(), Reply::Commit { generation: 1 }, "when it is active");
    assert_eq!(made(&bench.send_all(1, [1]))[0].0, 1);
    bench.done(&golden_tables().commit(2, 2));
    assert_eq!(made(&bench.send_all(1, [2]))[0].0, 2);
}

pub(crate) fn a_commit_that_is_repeated_while_a_row_is_inside_is_answered(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 2);
    bench.send_all(2, [0]);
    bench.done(&TableSet::unstretched(2).commit(1, 0));
}

pub(crate) fn without_a_configuration_the_board_is_not_ready(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    let tables = TableSet::unstretched(4);
    tables.upload(&mut bench);
    assert_eq!(bench.refused(&tables.commit(1, 0)), (RefusalCode::NotReady, 0));
    bench.done(&Request::Configure(configuration(4)));
    bench.done(&tables.commit(1, 0));
}

pub(crate) fn generation_0_is_out_of_range(on: &dyn Boards) {
    let mut bench = in_use(on);
    assert_eq!(bench.refused(&TableSet::unstretched(1).commit(0, 1)), (RefusalCode::Range, 0));
}

pub(crate) fn nothing_is_committed_while_a_row_is_inside(on: &dyn Boards) {
    is_busy_while_a_row_is_inside(&mut ready(on, &Build::default(), 2));
}

/// Checks on a board that is ready for frames of two rows that COMMIT is refused with *busy* while a row is inside.
pub fn is_busy_while_a_row_is_inside(bench: &mut Bench) {
    bench.send_all(2, [0]);
    let tables = TableSet::unstretched(2);
    tables.upload(bench);
    assert_eq!(bench.refused(&tables.commit(2, 1)), (RefusalCode::Busy, 0));
    bench.send_all(2, [1]);
    bench.done(&tables.commit(2, 1));
}

pub(crate) fn another_commit_is_refused_while_one_is_pending_whatever_its_crcs(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 1);
    assert_eq!(bench.refused(&TableSet::unstretched(1).commit(2, 1)), (RefusalCode::Busy, 0));
    assert_eq!(bench.refused(&golden_tables().commit(2, 1)), (RefusalCode::Busy, 0));
}

pub(crate) fn hello_and_reset_forget_a_pending_commit_and_keep_its_tables(on: &dyn Boards) {
    let reset = Request::Reset(Reset { level: ResetLevel::Rows, next_row: 0 });
    let shadow_kernel = span(Table::Kernel, Bank::Shadow, 0, 0, 65);
    for request in [Request::Hello(Hello { nonce: 7, ..HELLO }), reset] {
        let mut bench = ready(on, &Build::default(), 1);
        let kernel = bench.crc(shadow_kernel);
        bench.session = bench.done(&request).header.session;
        assert_eq!(bench.send(&row(1, 0))[0].refusal(), Some((RefusalCode::NotReady, 0)));
        assert_eq!(bench.crc(shadow_kernel), kernel);
        bench.done(&TableSet::unstretched(1).commit(9, 0));
        assert_eq!(made(&bench.send_all(1, [0]))[0].0, 9);
    }
}

pub(crate) fn a_commit_for_a_frame_does_not_serve_the_frames_in_front_of_it(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    bench.done(&Request::Configure(configuration(1)));
    let tables = TableSet::new(&[UNSTRETCHED], &hermite());
    tables.upload(&mut bench);
    bench.done(&tables.commit(1, 5));
    assert_eq!(bench.send(&row(1, 0))[0].refusal(), Some((RefusalCode::NotReady, 0)));
    let mut fifth = row(1, 0);
    fifth.place.frame = 5;
    assert_eq!(made(&bench.send(&fifth))[0].0, 1);
}
