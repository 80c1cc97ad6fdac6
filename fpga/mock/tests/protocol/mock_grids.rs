//! Grids on the mock: builds that no other board has, and the mock's faults, each of which also shows in rows that go through a
//! grid.

use halfrow_conformance::at_speed::ONE;
use halfrow_conformance::capabilities::values;
use halfrow_conformance::frames::{row, samples_of};
use halfrow_conformance::grids::{greeted, narrow};
use halfrow_conformance::material::{drawn_grid, hermite};
use halfrow_conformance::uploads::{TableSet, span, write};
use halfrow_conformance::{Bench, Build, ReceivedPacket, suite};
use halfrow_mock::{Board, BoardFault, FAULTS, Options, board_fault};
use halfrow_protocol::message::{
    Bank, Burst, BurstMode, Commit, Configuration, Hello, RefusalCode, Request, Reset, ResetLevel, Shape,
    Table,
};

use crate::at_speed::Built;

const SHAPE: Shape = Shape { v: 1, k: 5 };

fn without() -> Options {
    Options { datapath2: false, ..Options::default() }
}

fn with_entries(entries: u16) -> Built {
    Built(Options { entries, ..Options::default() }, None)
}

/// The first four bytes that the board sends about its grids: the datapath's id and T.
fn said(options: &Options) -> Option<u32> {
    values(&mut Bench::of(Box::new(Board::new(options, None).unwrap()))).get(&0x12).copied()
}

#[test]
fn the_mock_takes_grids_unless_it_is_told_not_to() {
    assert_eq!(said(&Options::default()), Some(2 | 2048 << 16));
    assert_eq!(said(&with_entries(4096).0), Some(2 | 4096 << 16));
    assert_eq!(said(&without()), None);
}

#[test]
fn a_mock_without_grids_is_as_a_board_was_before() {
    let board = Built(without(), None);
    suite::grids::a_board_without_grids_refuses_their_spans_before_anything_else(&board);
    suite::grid_commits::a_board_without_grids_looks_at_no_shape(&board);
    suite::table_writes::spans_end_before_max_height_and_node_65(&board);
    assert!(greeted(&board, &Build::default()).is_none());
}

#[test]
fn a_mock_of_more_entries_takes_larger_grids() {
    for entries in [4096, 32768] {
        let board = with_entries(entries);
        suite::grids::spans_of_a_grid_end_before_its_last_entry(&board);
        suite::grids::before_any_write_every_entry_of_a_grid_is_1(&board);
        suite::grid_commits::a_grid_may_fill_its_bank_and_no_more(&board);
    }
}

/// A mock, with or without a fault, that waits for tables for frames of `height` rows of 64 samples, whose optical centre is beside
/// the middle.
fn configured(fault: Option<BoardFault>, height: u16) -> Bench {
    let (mut bench, grids) = greeted(&Built(Options::default(), fault), &Build::default()).unwrap();
    bench.done(&Request::Configure(Configuration { centre2: 44, ..narrow(&grids, height) }));
    bench
}

fn grid(height: u16, seed: u32) -> TableSet {
    TableSet::grid(SHAPE, &drawn_grid(SHAPE, 64, height, seed), &hermite())
}

/// The fault of this name, with parameters that make it show in small frames.
fn fault(name: &str, given: &[(&str, &str)]) -> BoardFault {
    board_fault(&[&[("fault", name)], given].concat()).unwrap().unwrap()
}

/// All that a host hears from a board that plays frames of four rows through grids and makes frames itself, is given a damaged
/// packet, entries, a commit and a row that it must refuse, and is greeted by another host.
fn heard_of(fault: Option<BoardFault>) -> Vec<ReceivedPacket> {
    let mut bench = configured(fault, 4);
    let mut heard = bench.say(&Request::Capabilities);
    let tables = [grid(4, 7), grid(4, 8)];
    tables[0].upload(&mut bench);
    heard.extend(bench.say(&write(Table::RowFactors, 0, &[1, 0, 0, 0, 0, 0, 0, 0])));
    let own = std::mem::replace(&mut bench.session, 77);
    heard.extend(bench.say(&Request::Capabilities));
    bench.session = own;
    let Request::Commit(right) = tables[0].commit(1, 0) else { unreachable!() };
    heard.extend(bench.say(&Request::Commit(Commit { steps_crc: !right.steps_crc, generation: 3, ..right })));
    heard.extend(bench.say(&Request::Commit(right)));
    for frame in 0..4 {
        if frame == 3 {
            tables[1].upload(&mut bench);
            heard.extend(bench.say(&tables[1].commit(2, 3)));
        }
        heard.extend(bench.send_all(4, 4 * frame..4 * (frame + 1)));
        if frame == 0 {
            bench.acknowledge(0);
            heard.extend(bench.send_all(4, [0, 0]));
            let mut damaged = bench.packet(&Request::Echo(&[1; 4]));
            // In the payload, after a zero, the stuffing's first byte and twelve bytes of header.
            damaged[15] ^= 2;
            heard.extend(bench.receive(&damaged));
            heard.extend(bench.send_all(4, [0]));
        }
        bench.acknowledge(4 * (frame + 1));
    }
    bench.say(&Request::Reset(Reset { level: ResetLevel::Rows, next_row: 16 }));
    let close = Burst { frames: 4, mode: BurstMode::Alternating, frame_blanking: 8, ..ONE };
    heard.extend(bench.say(&Request::Burst(close)));
    heard.extend(bench.say(&Request::Records { from: 0 }));
    bench.say(&Request::Reset(Reset { level: ResetLevel::Rows, next_row: 17 }));
    heard.extend(bench.send(&row(4, 17)));
    bench.say(&Request::Reset(Reset { level: ResetLevel::Rows, next_row: 20 }));
    heard.extend(bench.send_all(4, 20..24));
    let other = Hello { nonce: 5, host: 77, version_min: 1, version_max: 1, take_over: false };
    heard.extend(bench.say(&Request::Hello(other)));
    bench.greet(&Hello { nonce: 6, take_over: true, ..other });
    heard.extend(bench.say(&Request::Status { clear: false }));
    heard
}

#[test]
fn every_fault_of_the_board_shows_in_what_is_made_with_grids() {
    let sound = heard_of(None);
    assert_eq!(heard_of(None), sound);
    for info in FAULTS.iter().map(|fault| fault.info) {
        // By default one output in 100,000 flips, and there are fewer than that.
        let often: &[_] = if info.name == "slow-path" { &[("one-in", "50")] } else { &[] };
        assert_ne!(heard_of(Some(fault(info.name, often))), sound, "{}", info.name);
    }
}

/// Rows of 64 samples that go through a grid need the 32 pixel clocks between them that the mock claims, also from frame to frame,
/// whichever bank has the grid.
#[test]
fn a_late_swap_shows_when_frames_of_a_grid_are_as_close_as_they_may_be() {
    let rows = TableSet::unstretched(4);
    for [active, shadow] in [[&grid(4, 7), &grid(4, 8)], [&rows, &grid(4, 8)]] {
        let signed = |fault, frame_blanking| {
            let mut bench = configured(fault, 4);
            // Gives the bank that is the shadow's afterwards the shape of a grid.
            for (tables, generation, frame) in [(shadow, 1, 0), (active, 2, 1)] {
                tables.upload(&mut bench);
                bench.done(&tables.commit(generation, frame));
                bench.send_all(4, u32::from(frame) * 4..u32::from(frame + 1) * 4);
                bench.acknowledge(u32::from(frame + 1) * 4);
            }
            let burst = Burst { frames: 3, mode: BurstMode::Alternating, frame_blanking, ..ONE };
            bench.signed(&burst).iter().map(|record| record.signature).collect::<Vec<_>>()
        };
        let (late, sound) = (Some(fault("late-swap", &[])), signed(None, 32));
        assert_eq!(signed(late, 33), sound);
        let close = signed(late, 32);
        assert_eq!(close[0], sound[0]);
        assert!(close[1] != sound[1] && close[2] != sound[2]);
    }
}

/// The rows of a frame of twelve that a board, with or without a fault, makes with these tables.
fn rows_of(fault: Option<BoardFault>, tables: &TableSet) -> Vec<Vec<u16>> {
    let mut bench = configured(fault, 12);
    tables.upload(&mut bench);
    bench.done(&tables.commit(1, 0));
    let mut rows = Vec::new();
    for number in 0..12 {
        rows.extend(bench.send(&row(12, number)).iter().map(|packet| samples_of(&packet.row())));
        bench.acknowledge(rows.len() as u32);
    }
    rows
}

/// With eight grid rows, entry 11 is that of node 0 in grid row 3. Rows 2 to 7 have it among their three, but row 2 gives it no
/// weight.
#[test]
fn a_hidden_bit_of_an_entry_changes_the_rows_around_its_grid_row_as_another_entry_would() {
    let hidden = fault("row-factor", &[("row", "11"), ("bit", "20"), ("hidden", "true")]);
    let mut entries = drawn_grid(SHAPE, 64, 12, 7);
    let sound = rows_of(None, &grid(12, 7));
    let broken = rows_of(Some(hidden), &grid(12, 7));
    entries[11] ^= 1 << 20;
    assert_eq!(broken, rows_of(None, &TableSet::grid(SHAPE, &entries, &hermite())));
    let wrong: Vec<_> = (0..12).filter(|&row| broken[row] != sound[row]).collect();
    assert_eq!(wrong, [3, 4, 5, 6, 7]);
}

#[test]
fn a_bit_of_an_entry_that_reads_back_wrong_is_not_committed() {
    let mut bench = configured(Some(fault("row-factor", &[("row", "11"), ("bit", "0")])), 12);
    grid(12, 7).upload(&mut bench);
    let uploaded = drawn_grid(SHAPE, 64, 12, 7)[11];
    let read = bench.read(span(Table::Grid, Bank::Shadow, 0, 11, 1));
    assert_eq!(read, (uploaded ^ 1).to_le_bytes());
    assert_eq!(bench.refused(&grid(12, 7).commit(1, 0)), (RefusalCode::TableCrc, Table::Grid as u16));
}

/// It flips after the first of two frames.
#[test]
fn a_drifting_entry_of_a_grid_spoils_the_rows_that_use_it_from_then_on() {
    let drifting = fault("drifting-table", &[("after", "12"), ("row", "11"), ("bit", "20")]);
    let mut bench = configured(Some(drifting), 12);
    grid(12, 7).upload(&mut bench);
    bench.done(&grid(12, 7).commit(1, 0));
    let sound = rows_of(None, &grid(12, 7));
    for frame in 0..2 {
        let mut wrong = Vec::new();
        for number in 0..12 {
            let mut sent = row(12, 12 * frame + number);
            sent.samples = row(12, number).samples;
            for packet in bench.send(&sent) {
                let out = packet.row();
                if samples_of(&out) != sound[usize::from(out.place.row)] {
                    wrong.push(out.place.row);
                }
                bench.window = out.place.row_sequence + 1;
            }
        }
        assert_eq!(wrong, if frame == 0 { vec![] } else { vec![3, 4, 5, 6, 7] });
    }
}
