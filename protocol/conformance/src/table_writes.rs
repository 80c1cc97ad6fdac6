//! TABLE_WRITE: what may be written, and when.

use halfrow_protocol::message::{Bank, Entries, RefusalCode, Request, Span, Table};

use crate::bench::{Bench, HELLO};
use crate::frames::{lean, ready};
use crate::{Boards, Build, offered};

use crate::uploads::{span, write};

fn factors(values: &[u32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

fn node(words: [i16; 5]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

fn read(bench: &mut Bench, table: Table, first: u16, count: u16) -> Vec<u8> {
    bench.read(span(table, Bank::Shadow, 0, first, count))
}

pub(crate) fn entries_are_written_from_the_first_one_on_and_nowhere_else(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    let before = read(&mut bench, Table::RowFactors, 0, 8);
    bench.done(&write(Table::RowFactors, 3, &factors(&[1, 1 << 24, 123_456])));
    let expected = [&before[..12], &factors(&[1, 1 << 24, 123_456]), &before[24..]].concat();
    assert_eq!(read(&mut bench, Table::RowFactors, 0, 8), expected);
    let before = read(&mut bench, Table::Kernel, 0, 65);
    bench.done(&write(Table::Kernel, 64, &node([1, -2, 3, -4, i16::MIN])));
    let expected = [&before[..640], &node([1, -2, 3, -4, i16::MIN])].concat();
    assert_eq!(read(&mut bench, Table::Kernel, 0, 65), expected);
}

pub(crate) fn the_reply_is_empty_and_the_port_is_not_looked_at(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    let span = Span { table: Table::RowFactors, bank: Bank::Shadow, port: 255, first: 0, count: 1 };
    let bytes = &factors(&[5]);
    assert_eq!(bench.done(&Request::TableWrite(Entries { span, bytes })).payload, []);
    assert_eq!(read(&mut bench, Table::RowFactors, 0, 1), factors(&[5]));
}

pub(crate) fn a_factor_out_of_range_is_named_by_its_index_and_nothing_is_written(on: &dyn Boards) {
    for wrong in [0, (1 << 24) + 1, u32::MAX] {
        let mut bench = Bench::greeted(on);
        let before = read(&mut bench, Table::RowFactors, 100, 4);
        let refusal = bench.refused(&write(Table::RowFactors, 100, &factors(&[7, 7, wrong, 0])));
        assert_eq!(refusal, (RefusalCode::Range, 102));
        assert_eq!(read(&mut bench, Table::RowFactors, 100, 4), before);
    }
}

pub(crate) fn spans_end_before_max_height_and_node_65(on: &dyn Boards) {
    for max_height in [100, 2048] {
        for build in offered(on, [Build { max_height, ..Build::default() }]) {
            let mut bench = Bench::switched_on(on, &build);
            bench.greet(&HELLO);
            bench.done(&write(Table::RowFactors, max_height - 1, &factors(&[1])));
            for first in [max_height - 1, max_height, 0xffff] {
                let refusal = bench.refused(&write(Table::RowFactors, first, &factors(&[1, 1])));
                assert_eq!(refusal, (RefusalCode::Range, first));
            }
        }
    }
    let mut bench = Bench::greeted(on);
    bench.done(&write(Table::Kernel, 64, &node([0; 5])));
    for first in [64, 65, 0xffff] {
        let refusal = bench.refused(&write(Table::Kernel, first, &[0; 20]));
        assert_eq!(refusal, (RefusalCode::Range, first));
    }
    assert_eq!(bench.refused(&write(Table::Kernel, 0, &[0; 660])), (RefusalCode::Range, 0));
}

pub(crate) fn a_span_of_no_entries_is_legal(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    bench.done(&write(Table::RowFactors, 0, &[]));
    bench.done(&write(Table::RowFactors, 2048, &[]));
    bench.done(&write(Table::Kernel, 65, &[]));
}

pub(crate) fn the_active_bank_is_not_written(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 4);
    for first in [0, 9] {
        let span = Span { table: Table::RowFactors, bank: Bank::Active, port: 0, first, count: 1 };
        let bytes = &factors(&[5]);
        let refusal = bench.refused(&Request::TableWrite(Entries { span, bytes }));
        assert_eq!(refusal, (RefusalCode::Range, first));
    }
}

pub(crate) fn five_taps_refuse_a_node_that_needs_seven_and_name_it(on: &dyn Boards) {
    let Some(build) = offered(on, [lean()]).pop() else { return };
    let mut bench = Bench::switched_on(on, &build);
    bench.greet(&HELLO);
    let five = node([0, -1, 2, -3, 0]);
    bench.done(&write(Table::Kernel, 10, &five));
    for seven in [[1, 0, 0, 0, 0], [0, 0, 0, 0, -1]] {
        let nodes = [node([0; 5]), node(seven), node([0; 5])].concat();
        assert_eq!(bench.refused(&write(Table::Kernel, 10, &nodes)), (RefusalCode::Taps, 11));
        assert_eq!(read(&mut bench, Table::Kernel, 10, 1), five);
    }
}

pub(crate) fn of_several_wrong_things_the_bank_is_named_then_busy_then_the_span(on: &dyn Boards) {
    let write_to = |bank, first| {
        let span = Span { table: Table::RowFactors, bank, port: 0, first, count: 1 };
        Request::TableWrite(Entries { span, bytes: &[0; 4] })
    };
    let mut bench = ready(on, &Build::default(), 1);
    assert_eq!(
        bench.refused(&write_to(Bank::Active, 9)),
        (RefusalCode::Range, 9),
        "while a commit is pending"
    );
    assert_eq!(bench.refused(&write_to(Bank::Shadow, 0xffff)), (RefusalCode::Busy, 0));
    bench.send_all(1, [0]);
    assert_eq!(bench.refused(&write_to(Bank::Shadow, 0xffff)), (RefusalCode::Range, 0xffff));
    assert_eq!(bench.refused(&write_to(Bank::Shadow, 3)), (RefusalCode::Range, 3));
}

pub(crate) fn nothing_is_written_while_a_commit_is_pending(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 4);
    assert_eq!(bench.refused(&write(Table::RowFactors, 0, &factors(&[1]))), (RefusalCode::Busy, 0));
    bench.send_all(4, 0..4);
    bench.done(&write(Table::RowFactors, 0, &factors(&[1])));
}

pub(crate) fn the_shadow_bank_is_written_while_rows_use_the_other_one(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 4);
    bench.send_all(4, [0]);
    bench.done(&write(Table::RowFactors, 0, &factors(&[1])));
}
