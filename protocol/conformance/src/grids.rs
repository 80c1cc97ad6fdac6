//! The entries of a grid, written and read: datapath 2 of DATAPATH.md. Boards without grids are tested only by the tests for
//! such boards here and in `grid_commits`.

use halfrow_protocol::message::{
    Bank, Configuration, Entries, Grids, RefusalCode, Request, Reset, ResetLevel, Span, Table,
};

use crate::bench::{Bench, HELLO};
use crate::frames::{configuration, lean, ready};
use crate::material::UNSTRETCHED;
use crate::uploads::{span, write, write_both_banks};
use crate::{Boards, Build, offered};

/// The greatest entry of a grid.
pub(crate) const MOST: u32 = (1 << 25) - 1;

/// The board's support for grids; none if it is for a datapath that the page does not describe.
pub(crate) fn grids_of(bench: &mut Bench) -> Option<Grids> {
    bench.capabilities().grids.filter(|grids| grids.further_datapath == 2)
}

/// A board of this build with an open session; none if the build is not offered or takes no grids.
pub fn greeted(on: &dyn Boards, build: &Build) -> Option<(Bench, Grids)> {
    let build = offered(on, [build.clone()]).pop()?;
    let mut bench = Bench::switched_on(on, &build);
    bench.greet(&HELLO);
    let grids = grids_of(&mut bench)?;
    Some((bench, grids))
}

/// A configuration for rows of 64 samples, with the blanking that rows corrected by a grid need.
#[must_use]
pub fn narrow(grids: &Grids, height: u16) -> Configuration {
    Configuration { blanking: grids.grid_blanking.into(), ..configuration(height) }
}

fn words(values: &[u32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

fn shadow(table: Table, first: u16, count: u16) -> Span {
    span(table, Bank::Shadow, 0, first, count)
}

pub(crate) fn a_board_without_grids_refuses_their_spans_before_anything_else(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 2);
    if grids_of(&mut bench).is_some() {
        return;
    }
    bench.send_all(2, [0]);
    let active = Span { bank: Bank::Active, ..shadow(Table::Grid, 0, 1) };
    for request in [
        Request::TableRead(shadow(Table::Grid, 0, 1)),
        Request::TableCrc(Span { port: 9, ..shadow(Table::Grid, 0xffff, 0xffff) }),
        write(Table::Grid, 0, &words(&[UNSTRETCHED])),
        Request::TableWrite(Entries { span: active, bytes: &words(&[u32::MAX]) }),
    ] {
        assert_eq!(bench.refused(&request), (RefusalCode::Payload, 0), "{request:?}");
    }
}

pub(crate) fn a_grid_and_row_factors_are_one_memory(on: &dyn Boards) {
    let Some((mut bench, _)) = greeted(on, &Build::default()) else { return };
    bench.done(&write(Table::RowFactors, 5, &words(&[1, UNSTRETCHED])));
    bench.done(&write(Table::Grid, 7, &words(&[0, MOST, 7])));
    let expected = words(&[UNSTRETCHED, 1, UNSTRETCHED, 0, MOST, 7, UNSTRETCHED]);
    for table in [Table::Grid, Table::RowFactors] {
        assert_eq!(bench.read(shadow(table, 4, 7)), expected, "{table:?}");
        assert_eq!(bench.crc(shadow(table, 4, 7)), crc32fast::hash(&expected), "{table:?}");
    }
    let kernel = bench.read(shadow(Table::Kernel, 0, 65));
    assert_eq!(kernel, vec![0; kernel.len()], "the kernel is another");
}

pub(crate) fn an_entry_out_of_range_is_named_by_its_index_and_nothing_is_written(on: &dyn Boards) {
    for wrong in [MOST + 1, 1 << 31, u32::MAX] {
        let Some((mut bench, grids)) = greeted(on, &Build::default()) else { return };
        for first in [0, 100, grids.entries - 4] {
            let refusal = bench.refused(&write(Table::Grid, first, &words(&[7, MOST, wrong, wrong])));
            assert_eq!(refusal, (RefusalCode::Range, first + 2));
            assert_eq!(bench.read(shadow(Table::Grid, first, 4)), words(&[UNSTRETCHED; 4]));
        }
        // Row factors have a range of their own in the same memory.
        let refusal = bench.refused(&write(Table::RowFactors, 0, &words(&[UNSTRETCHED + 1])));
        assert_eq!(refusal, (RefusalCode::Range, 0));
    }
}

pub(crate) fn spans_of_a_grid_end_before_its_last_entry(on: &dyn Boards) {
    let small = Build { max_height: 100, ..Build::default() };
    for build in offered(on, [Build::default(), lean(), small]) {
        let Some((mut bench, Grids { entries, .. })) = greeted(on, &build) else { return };
        assert!(entries >= 2048 && entries >= build.max_height);
        bench.done(&write(Table::Grid, entries - 1, &words(&[MOST])));
        assert_eq!(bench.read(shadow(Table::Grid, entries - 1, 1)), words(&[MOST]));
        bench.done(&write(Table::Grid, entries, &[]));
        for first in [entries - 1, entries, 0xffff] {
            let refusal = bench.refused(&write(Table::Grid, first, &words(&[1, 1])));
            assert_eq!(refusal, (RefusalCode::Range, first));
        }
        let no_port = Span { port: bench.capabilities().step_ports, ..shadow(Table::Grid, 3, 1) };
        for wrong in [shadow(Table::Grid, entries - 1, 2), shadow(Table::Grid, 0xffff, 0xffff), no_port] {
            for request in [Request::TableRead(wrong), Request::TableCrc(wrong)] {
                assert_eq!(bench.refused(&request), (RefusalCode::Range, wrong.first), "{request:?}");
            }
        }
        // A packet has room for 4080 bytes, of which the span takes 7.
        bench.read(shadow(Table::Grid, 5, 1018));
        let longer = Request::TableRead(shadow(Table::Grid, 5, 1019));
        assert_eq!(bench.refused(&longer), (RefusalCode::Range, 5));
        let active = Span { bank: Bank::Active, ..shadow(Table::Grid, 9, 1) };
        let refusal = bench.refused(&Request::TableWrite(Entries { span: active, bytes: &words(&[1]) }));
        assert_eq!(refusal, (RefusalCode::Range, 9));
    }
}

pub(crate) fn before_any_write_every_entry_of_a_grid_is_1(on: &dyn Boards) {
    for build in offered(on, [Build::default(), lean()]) {
        let Some((mut bench, Grids { entries, .. })) = greeted(on, &build) else { return };
        let ones = crc32fast::hash(&words(&vec![UNSTRETCHED; entries.into()]));
        for round in 0..2 {
            for bank in [Bank::Shadow, Bank::Active] {
                let all = Span { bank, ..shadow(Table::Grid, 0, entries) };
                assert_eq!(bench.crc(all), ones, "{bank:?}, round {round}");
            }
            write_both_banks(&mut bench, |bench| {
                bench.done(&write(Table::Grid, entries - 2, &words(&[3, 4])));
            });
            bench.done(&Request::Reset(Reset { level: ResetLevel::Tables, next_row: 0 }));
        }
    }
}

pub(crate) fn a_grid_is_neither_read_nor_written_while_row_factors_are_not(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 2);
    if grids_of(&mut bench).is_none() {
        return;
    }
    let one = words(&[MOST]);
    assert_eq!(
        bench.refused(&write(Table::Grid, 0xffff, &one)),
        (RefusalCode::Busy, 0),
        "a commit is pending"
    );
    bench.send_all(2, [0]);
    bench.done(&write(Table::Grid, 0, &one));
    let read = Request::TableRead(shadow(Table::Grid, 0xffff, 1));
    assert_eq!(bench.refused(&read), (RefusalCode::Busy, 0), "a row is inside");
}
