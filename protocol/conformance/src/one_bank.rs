//! A build with one bank of tables: rows use what is written.

use halfrow_protocol::message::{Bank, RefusalCode, Request, Table};

use crate::bench::{Bench, HELLO};
use crate::frames::{configuration, lean, row, samples_of};
use crate::golden_rows::HERMITE;
use crate::material::{GOLDEN_FACTOR, hermite, noise_row};
use crate::uploads::{TableSet, span, write};
use crate::{Boards, Build, offered};

/// A configured board with one bank of tables, if that build is offered.
fn one_bank(on: &dyn Boards, height: u16) -> Option<Bench> {
    let build = offered(on, [lean()]).pop()?;
    let mut bench = Bench::switched_on(on, &build);
    bench.greet(&HELLO);
    bench.done(&Request::Configure(configuration(height)));
    Some(bench)
}

/// Like [`one_bank`], with tables that change no sample committed as generation 1.
fn ready(on: &dyn Boards, height: u16) -> Option<Bench> {
    let mut bench = one_bank(on, height)?;
    TableSet::unstretched(height).upload(&mut bench);
    bench.done(&TableSet::unstretched(height).commit(1, 40_000));
    Some(bench)
}

pub(crate) fn the_board_says_how_many_banks_it_has(on: &dyn Boards) {
    for build in offered(on, [lean(), Build::default()]) {
        let mut bench = Bench::switched_on(on, &build);
        bench.greet(&HELLO);
        assert_eq!(bench.capabilities().table_banks, build.table_banks);
    }
}

pub(crate) fn a_commit_takes_effect_at_once_whatever_its_frame(on: &dyn Boards) {
    let Some(mut bench) = ready(on, 1) else { return };
    assert_eq!(bench.status().generation, 1);
    let heard = bench.send_all(1, [0]);
    assert_eq!((heard[0].row().generation, samples_of(&heard[0].row())), (1, noise_row(0, 64)));
}

pub(crate) fn both_banks_are_the_same_memory(on: &dyn Boards) {
    let Some(mut bench) = ready(on, 1) else { return };
    bench.done(&write(Table::RowFactors, 0, &GOLDEN_FACTOR.to_le_bytes()));
    for bank in [Bank::Shadow, Bank::Active] {
        assert_eq!(bench.read(span(Table::RowFactors, bank, 0, 0, 1)), GOLDEN_FACTOR.to_le_bytes());
    }
}

pub(crate) fn rows_use_what_is_written_behind_the_commit_under_the_same_generation(on: &dyn Boards) {
    let Some(mut bench) = ready(on, 1) else { return };
    bench.done(&write(Table::RowFactors, 0, &GOLDEN_FACTOR.to_le_bytes()));
    let heard = bench.send_all(1, [0]);
    assert_eq!((heard[0].row().generation, samples_of(&heard[0].row())), (1, HERMITE.to_vec()));
}

pub(crate) fn tables_are_written_and_committed_between_frames(on: &dyn Boards) {
    let Some(mut bench) = ready(on, 1) else { return };
    bench.send_all(1, [0]);
    let tables = TableSet::new(&[GOLDEN_FACTOR], &hermite());
    tables.upload(&mut bench);
    bench.done(&tables.commit(2, 1));
    let mut golden = row(1, 1);
    golden.samples = noise_row(0, 64);
    let heard = bench.send(&golden);
    assert_eq!((heard[0].row().generation, samples_of(&heard[0].row())), (2, HERMITE.to_vec()));
}

pub(crate) fn nothing_is_written_while_any_row_is_inside(on: &dyn Boards) {
    let Some(mut bench) = ready(on, 2) else { return };
    bench.send_all(2, [0]);
    let one = write(Table::RowFactors, 0, &[1, 0, 0, 0]);
    assert_eq!(bench.refused(&one), (RefusalCode::Busy, 0));
    assert_eq!(bench.refused(&write(Table::Kernel, 0, &[0; 10])), (RefusalCode::Busy, 0));
    bench.send_all(2, [1]);
    bench.done(&one);
}

pub(crate) fn nothing_is_committed_while_a_row_is_inside(on: &dyn Boards) {
    let Some(mut bench) = ready(on, 2) else { return };
    bench.send_all(2, [0]);
    assert_eq!(bench.refused(&TableSet::unstretched(2).commit(2, 0)), (RefusalCode::Busy, 0));
    bench.send_all(2, [1]);
    bench.done(&TableSet::unstretched(2).commit(2, 0));
}

pub(crate) fn commits_follow_each_other_without_a_frame_between_them(on: &dyn Boards) {
    let Some(mut bench) = ready(on, 1) else { return };
    for generation in [2, 3, 3, 1] {
        bench.done(&TableSet::unstretched(1).commit(generation, 0));
        assert_eq!(bench.status().generation, generation.into());
    }
}

pub(crate) fn a_wrong_crc_leaves_the_generation(on: &dyn Boards) {
    let Some(mut bench) = ready(on, 1) else { return };
    let other = TableSet::new(&[GOLDEN_FACTOR], &hermite());
    assert_eq!(bench.refused(&other.commit(2, 0)), (RefusalCode::TableCrc, 0));
    assert_eq!(bench.status().generation, 1);
}

pub(crate) fn before_the_first_commit_no_row_is_taken(on: &dyn Boards) {
    let Some(mut bench) = one_bank(on, 1) else { return };
    assert_eq!(bench.send(&row(1, 0))[0].refusal(), Some((RefusalCode::NotReady, 0)));
}
