//! What holds for the mock alone: builds and faults that no other board has, and that it takes no time of its own.

use halfrow_mock::{Board, BoardFault, Depth, Options, TapCount, Weight};
use halfrow_protocol::message::{Bank, Datapath, RefusalCode, Reply, Request, Table};

use halfrow_conformance::capabilities::values;
use halfrow_conformance::frames::{configuration, make_ready, row};
use halfrow_conformance::uploads::{TableSet, span};
use halfrow_conformance::{Bench, HELLO, ReceivedPacket, is_busy_while_a_row_is_inside, rows_of};

fn switched_on(options: &Options, fault: Option<BoardFault>) -> Bench {
    Bench::of(Box::new(Board::new(options, fault).unwrap()))
}

/// A board of the default build, with or without a fault, that is ready for frames of `height` rows and changes no sample.
fn ready_with(fault: Option<BoardFault>, height: u16) -> Bench {
    let mut bench = switched_on(&Options::default(), fault);
    bench.greet(&HELLO);
    make_ready(&mut bench, height);
    bench
}

#[test]
fn the_board_is_a_mock_of_datapath_1() {
    let values = values(&mut switched_on(&Options::default(), None));
    assert_eq!((values[&0x01], values[&0x20]), (1, 3));
    assert_eq!((values[&0x0c], values[&0x0d]), (1, 2), "one port for factors, two for nodes");
    assert_eq!((values[&0x07], values[&0x0e]), (2048, 0), "the clock is the host's");
}

#[test]
fn the_options_of_the_build_show() {
    let options = Options {
        latency: 17,
        ring: Some(4096),
        least_blanking: 300,
        row_banks_in: 5,
        row_banks_out: 6,
        taps: TapCount::Five,
        max_width: 1920,
        max_height: 1080,
        depths: vec![Depth::Eight, Depth::Twelve],
        pixel_clock: 74_250_000,
        ..Options::default()
    };
    let values = values(&mut switched_on(&options, None));
    let shown: Vec<_> = [2, 3, 4, 5, 6, 7, 8, 0x0a, 0x0b, 0x0f].iter().map(|tag| values[tag]).collect();
    assert_eq!(shown, [1920, 1080, 0b101, 5, 17, 4096, 300, 5, 6, 74_250_000]);
}

#[test]
fn every_depth_has_its_bit_however_often_it_is_listed() {
    for (depth, bit) in [(Depth::Eight, 1), (Depth::Ten, 2), (Depth::Twelve, 4)] {
        let options = Options { depths: vec![depth; 70], ..Options::default() };
        assert_eq!(values(&mut switched_on(&options, None))[&4], bit);
    }
    assert_eq!(values(&mut switched_on(&Options::default(), None))[&4], 7);
}

#[test]
fn a_board_may_lie_about_its_latency() {
    let honest = values(&mut switched_on(&Options::default(), None));
    let lying = values(&mut switched_on(&Options::default(), Some(BoardFault::WrongLatencyClaim)));
    assert_eq!((honest[&6], lying[&6]), (12, 13));
    assert!(honest.keys().all(|tag| *tag == 6 || honest[tag] == lying[tag]));
}

#[test]
fn a_board_may_claim_another_datapath() {
    let honest = values(&mut switched_on(&Options::default(), None));
    let lying = values(&mut switched_on(&Options::default(), Some(BoardFault::WrongDatapath)));
    let claimed = u16::try_from(lying[&1]).unwrap();
    assert!(Datapath::try_from(claimed).is_err(), "{claimed} is one that this program knows");
    assert!(honest.keys().all(|tag| *tag == 1 || honest[tag] == lying[tag]));
}

#[test]
fn a_table_that_reads_back_wrong_is_not_committed() {
    let fault = BoardFault::RowFactor { row: 0, bit: 9, hidden: false };
    let mut bench = switched_on(&Options::default(), Some(fault));
    bench.greet(&HELLO);
    bench.done(&Request::Configure(configuration(1)));
    TableSet::unstretched(1).upload(&mut bench);
    let commit = TableSet::unstretched(1).commit(1, 0);
    assert_eq!(bench.refused(&commit), (RefusalCode::TableCrc, 0));
}

/// Its only fault is that it does not check the CRCs.
#[test]
fn a_board_that_checks_no_commit_is_busy_while_a_row_is_inside() {
    is_busy_while_a_row_is_inside(&mut ready_with(Some(BoardFault::UncheckedCommit), 2));
}

#[test]
fn a_row_that_the_core_loses_never_comes_out_and_those_behind_it_do() {
    let mut bench = ready_with(Some(BoardFault::LostRow { row: 2 }), 4);
    assert_eq!(rows_of(&bench.send_all(4, [0, 1, 2, 3, 2, 2])), [0, 1, 3]);
    let status = bench.status();
    assert_eq!((status.rows_in, status.rows_out, status.rows_unneeded), (4, 3, 2));
}

#[test]
fn a_late_board_reports_the_latency_that_it_has() {
    let mut bench = ready_with(Some(BoardFault::Late), 1);
    let heard = bench.send_all(1, [0]);
    assert_eq!((heard[0].row().first_latency, heard[0].row().last_latency), (45, 45));
}

#[test]
fn the_next_frame_enters_while_the_rest_of_the_last_one_leaves() {
    let mut bench = ready_with(None, 1);
    let status = bench.packet(&Request::Status { clear: false });
    let bytes = [bench.row_packet(&row(1, 0)), status.clone(), bench.row_packet(&row(1, 1)), status].concat();
    let heard = bench.receive(&bytes);
    let busy =
        |packet: &ReceivedPacket| matches!(packet.reply(), Reply::Status(status) if status.core_busy == 1);
    assert!(busy(&heard[0]), "the rest has not left when the STATUS behind it comes");
    assert_eq!(rows_of(&heard[1..2]), [0], "row 0 leaves while row 1 enters");
    assert!(busy(&heard[2]));
    assert_eq!(rows_of(&heard[3..]), [1]);
}

#[test]
fn a_read_shows_what_the_datapath_gets_not_what_was_written() {
    let flipped = BoardFault::KernelWord { node: 16, weight: Weight::G4, bit: 12, hidden: false };
    let mut bench = with_hermite(flipped);
    let payload = bench.done(&Request::TableRead(span(Table::Kernel, Bank::Shadow, 0, 16, 1))).payload;
    // Hermite at x = 1/2: g4 = 5/32, which is 2560 in units of 2^-14; with bit 12 set it is 6656.
    assert_eq!(payload[11..13], 6656_u16.to_le_bytes());
}

/// A board with this fault and with Hermite's kernel in its shadow bank.
fn with_hermite(fault: BoardFault) -> Bench {
    let mut bench = switched_on(&Options::default(), Some(fault));
    bench.greet(&HELLO);
    TableSet::unstretched(1).upload(&mut bench);
    bench
}

#[test]
fn a_hidden_fault_does_not_show_in_a_read() {
    let hidden = BoardFault::RowFactor { row: 0, bit: 3, hidden: true };
    let mut bench = ready_with(Some(hidden), 1);
    assert_eq!(
        bench.crc(span(Table::RowFactors, Bank::Shadow, 0, 0, 1)),
        crc32fast::hash(&(1_u32 << 24).to_le_bytes())
    );
}

#[test]
fn a_row_comes_back_when_the_one_that_pushed_it_out_has_entered() {
    let mut bench = ready_with(None, 8);
    let windows: Vec<_> = bench.send_all(8, 0..4).iter().map(|packet| packet.header.window).collect();
    assert_eq!(windows, [6, 7, 8]);
}
