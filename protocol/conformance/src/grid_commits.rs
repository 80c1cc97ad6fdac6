//! COMMIT of a grid: what is refused, and what its CRC covers.

use halfrow_protocol::message::{Commit, Configuration, Grids, Hello, RefusalCode, Request, Shape, Table};

use crate::bench::{Bench, HELLO};
use crate::frames::{configuration, row, samples_of};
use crate::golden_rows::HERMITE;
use crate::grids::{MOST, greeted, grids_of, narrow};
use crate::material::{GOLDEN_FACTOR, UNSTRETCHED, drawn_grid, grid_size, hermite, noise_row};
use crate::uploads::{TableSet, write};
use crate::{Boards, Build};

const SHAPE: Shape = Shape { v: 1, k: 5 };

/// The fields of a commit.
fn fields(tables: &TableSet, generation: u8, first_frame: u16) -> Commit {
    let Request::Commit(commit) = tables.commit(generation, first_frame) else { unreachable!() };
    commit
}

fn grid(height: u16) -> TableSet {
    TableSet::grid(SHAPE, &drawn_grid(SHAPE, 64, height, 7), &hermite())
}

/// A board that takes grids, configured for four rows of 64 samples, with a grid in its shadow bank.
fn uploaded(on: &dyn Boards) -> Option<(Bench, Grids)> {
    let (mut bench, grids) = greeted(on, &Build::default())?;
    bench.done(&Request::Configure(narrow(&grids, 4)));
    grid(4).upload(&mut bench);
    Some((bench, grids))
}

pub(crate) fn a_board_without_grids_looks_at_no_shape(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    if grids_of(&mut bench).is_some() {
        return;
    }
    bench.done(&Request::Configure(configuration(1)));
    let tables = TableSet::new(&[GOLDEN_FACTOR], &hermite());
    tables.upload(&mut bench);
    let shape = Some(Shape { v: 255, k: 255 });
    bench.done(&Request::Commit(Commit { shape, ..fields(&tables, 1, 0) }));
    let mut golden = row(1, 0);
    golden.samples = noise_row(0, 64);
    assert_eq!(samples_of(&bench.send(&golden)[0].row()), HERMITE);
}

pub(crate) fn a_shape_out_of_range_is_named_the_first_of_several(on: &dyn Boards) {
    let Some((mut bench, grids)) = greeted(on, &Build::default()) else { return };
    let of = |generation, v, k| {
        let shape = Some(Shape { v, k });
        Request::Commit(Commit { steps_crc: 0, kernel_crc: 0, first_frame: 1, generation, shape })
    };
    assert_eq!(bench.refused(&of(0, 255, 255)), (RefusalCode::NotReady, 0));
    let tables = TableSet::unstretched(4);
    tables.upload(&mut bench);
    bench.done(&Request::Configure(narrow(&grids, 4)));
    for is_pending in [false, true] {
        assert_eq!(bench.refused(&of(0, 255, 255)), (RefusalCode::Range, 0), "{is_pending}");
        for v in [7, 8, 64, 128, 255] {
            assert_eq!(bench.refused(&of(9, v, 255)), (RefusalCode::Range, 1), "{is_pending}, v = {v}");
        }
        for k in (0..=255).filter(|&k| !grids.takes(k)) {
            assert_eq!(bench.refused(&of(9, 6, k)), (RefusalCode::Range, 2), "{is_pending}, k = {k}");
        }
        let then =
            if is_pending { (RefusalCode::Busy, 0) } else { (RefusalCode::TableCrc, Table::Grid as u16) };
        for k in (0..=255).filter(|&k| grids.takes(k)) {
            assert_eq!(bench.refused(&of(9, 6, k)), then, "{is_pending}, k = {k}");
        }
        if !is_pending {
            bench.done(&tables.commit(1, 0));
        }
    }
    bench.send_all(4, [0]);
    assert_eq!(bench.refused(&of(9, 7, 5)), (RefusalCode::Range, 1), "while a row is inside");
    assert_eq!(bench.refused(&of(9, 6, if grids.takes(5) { 5 } else { 6 })), (RefusalCode::Busy, 0));
}

/// A shape and a width, and the greatest height with which the grid fills a bank of `entries` to the last one, if any.
fn fullest(entries: u16, k: u8) -> Option<(Shape, u16, u16)> {
    let fills = |shape, width, height| {
        let (segments, grid_rows) = grid_size(shape, width, height);
        (segments + 2) * grid_rows == entries.into()
    };
    let shapes = (1..=6).map(|v| Shape { v, k });
    let frames = shapes.flat_map(|shape| (64..=2048).step_by(1 << k).map(move |width| (shape, width)));
    frames
        .filter_map(|(shape, width)| Some((shape, width, last(|height| fills(shape, width, height))?)))
        .next()
}

/// The last height, below 2047, for which `is_so` holds.
fn last(is_so: impl Fn(u16) -> bool) -> Option<u16> {
    (1..2047).find(|&height| is_so(height) && !is_so(height + 1))
}

pub(crate) fn a_grid_may_fill_its_bank_and_no_more(on: &dyn Boards) {
    let Some((mut bench, grids)) = greeted(on, &Build::default()) else { return };
    for (generation, k) in (1..).zip((5..=6).filter(|&k| grids.takes(k))) {
        let Some((shape, width, height)) = fullest(grids.entries, k) else { continue };
        let tables = TableSet::grid(shape, &drawn_grid(shape, width, height, 1), &hermite());
        let configuration = |height| {
            Request::Configure(Configuration { width, centre2: width - 1, ..narrow(&grids, height) })
        };
        bench.done(&configuration(height + 1));
        tables.upload(&mut bench);
        assert_eq!(bench.refused(&tables.commit(generation, 0)), (RefusalCode::Range, 2), "{shape:?}");
        bench.done(&configuration(height));
        bench.done(&tables.commit(generation, 0));
        // A pending commit would make the board refuse the next one.
        bench.greet(&Hello { nonce: generation.into(), ..HELLO });
    }
}

pub(crate) fn the_crc_covers_the_entries_of_the_configured_frame(on: &dyn Boards) {
    let Some((mut bench, grids)) = uploaded(on) else { return };
    bench.done(&write(Table::Grid, 16, &MOST.to_le_bytes()));
    bench.done(&grid(4).commit(1, 0));
    bench.greet(&Hello { nonce: 5, ..HELLO });
    // A frame of five rows has one more grid row, and so one more offset and one more factor per node column.
    bench.done(&Request::Configure(narrow(&grids, 5)));
    assert_eq!(bench.refused(&grid(4).commit(2, 0)), (RefusalCode::TableCrc, Table::Grid as u16));
    grid(5).upload(&mut bench);
    bench.done(&write(Table::Grid, 19, &UNSTRETCHED.to_le_bytes()));
    assert_eq!(bench.refused(&grid(5).commit(2, 0)), (RefusalCode::TableCrc, Table::Grid as u16));
    grid(5).upload(&mut bench);
    bench.done(&grid(5).commit(2, 0));
}

pub(crate) fn a_crc_that_is_not_the_grids_is_refused_with_its_table(on: &dyn Boards) {
    let Some((mut bench, _)) = uploaded(on) else { return };
    let right = fields(&grid(4), 1, 0);
    let (steps_crc, kernel_crc) = (right.steps_crc ^ 1 << 31, right.kernel_crc ^ 1);
    for (wrong, table) in [
        (Commit { steps_crc, ..right }, Table::Grid),
        (Commit { kernel_crc, ..right }, Table::Kernel),
        (Commit { steps_crc, kernel_crc, ..right }, Table::Grid),
        // The same bank as row factors.
        (Commit { shape: None, ..right }, Table::RowFactors),
        (Commit { shape: Some(Shape { v: 0, k: 5 }), ..right }, Table::RowFactors),
        // The same bank as a grid of fewer grid rows.
        (Commit { shape: Some(Shape { v: 2, ..SHAPE }), ..right }, Table::Grid),
    ] {
        assert_eq!(
            bench.refused(&Request::Commit(wrong)),
            (RefusalCode::TableCrc, table as u16),
            "{wrong:?}"
        );
    }
    bench.done(&Request::Commit(right));
}

pub(crate) fn a_repeated_commit_of_another_shape_changes_nothing(on: &dyn Boards) {
    let Some(bent) = rows_behind(on, &[]) else { return };
    assert_ne!(bent[0], noise_row(0, 64));
    for shape in [None, Some(Shape { v: 255, k: 0 }), Some(Shape { v: 6, k: 6 })] {
        assert_eq!(rows_behind(on, &[shape]).as_ref(), Some(&bent), "{shape:?}");
    }
}

/// The rows of a frame corrected by a grid whose commit is repeated with these shapes.
fn rows_behind(on: &dyn Boards, repeated: &[Option<Shape>]) -> Option<Vec<Vec<u16>>> {
    let (mut bench, _) = uploaded(on)?;
    let right = fields(&grid(4), 1, 0);
    bench.done(&Request::Commit(right));
    for &shape in repeated {
        bench.done(&Request::Commit(Commit { shape, steps_crc: 0, ..right }));
    }
    Some(bench.send_all(4, 0..4).iter().map(|packet| samples_of(&packet.row())).collect())
}

pub(crate) fn hello_forgets_a_pending_grid_and_the_next_commit_may_be_of_row_factors(on: &dyn Boards) {
    let Some((mut bench, _)) = uploaded(on) else { return };
    bench.done(&grid(4).commit(1, 0));
    bench.greet(&Hello { nonce: 8, ..HELLO });
    assert_eq!(bench.send(&row(4, 0))[0].refusal(), Some((RefusalCode::NotReady, 0)));
    let tables = TableSet::unstretched(4);
    tables.upload(&mut bench);
    bench.done(&tables.commit(2, 0));
    let rows = bench.send_all(4, 0..4);
    assert_eq!(samples_of(&rows[3].row()), noise_row(3, 64));
}
