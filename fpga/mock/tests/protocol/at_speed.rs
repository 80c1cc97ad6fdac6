//! AT-SPEED.md on the mock: the frames that need a fast board, builds that no other board has, and faults that show only at
//! speed.

use halfrow_conformance::at_speed::{ENDLESS, FRAME, HEIGHT, ONE, golden_tables, ready_with};
use halfrow_conformance::frames::{configuration, make_ready, row};
use halfrow_conformance::material::{Nodes, crc_of_words, factors, hermite, keys};
use halfrow_conformance::uploads::TableSet;
use halfrow_conformance::{Bench, Boards, Build, Subject};
use halfrow_mock::{Board, BoardFault, BurstBuild, Options};
use halfrow_protocol::message::{
    Burst, BurstMode, BurstState, Configuration, Expect, FrameRecord, RefusalCode, Reply, Request,
};
use halfrow_protocol::samples;

/// Mocks of one build, with or without a fault.
pub(crate) struct Built(pub(crate) Options, pub(crate) Option<BoardFault>);

impl Boards for Built {
    fn offers(&self, build: &Build) -> bool {
        *build == Build::default()
    }

    fn switched_on(&self, _: &Build) -> Box<dyn Subject> {
        Box::new(Board::new(&self.0, self.1).unwrap())
    }

    fn cases(&self) -> u32 {
        1
    }
}

const TALL: Configuration =
    Configuration { width: 1920, height: 1080, centre2: 1919, blanking: 0, gap_seed: 0, bits: 12 };

/// A mock that is ready to make frames of 1920 x 1080 with the table of R = 1106.697.
fn full_size(kernel: &Nodes) -> Bench {
    let tables = TableSet::new(&factors(1080, 1106.697), kernel);
    ready_with(&crate::Mock, &Build::default(), TALL, &tables).unwrap().0
}

/// A mock with this fault that is ready to make the page's frame of four rows.
fn broken(fault: BoardFault) -> Bench {
    let boards = Built(Options::default(), Some(fault));
    ready_with(&boards, &Build::default(), configuration(HEIGHT), &golden_tables()).unwrap().0
}

#[test]
fn the_golden_frames_of_full_size_are_signed() {
    let one = Burst { frames: 1, mode: BurstMode::Repeating, ..ONE };
    assert_eq!(full_size(&hermite()).signed(&one)[0].signature, 0xfedd_7f90);
    let next = Burst { first_frame: 1, ..one };
    assert_eq!(full_size(&keys()).signed(&next)[0].signature, 0x9b2e_415a);
}

/// Latencies of a full frame: half a row and L.
#[test]
fn a_full_frame_is_counted() {
    let expected = FrameRecord {
        signature: 0xfedd_7f90,
        samples: 1920 * 1080,
        rows: 1080,
        least_latency: 972,
        most_latency: 972,
        pauses: 0,
        generation: 1,
        held_back: false,
    };
    assert_eq!(full_size(&hermite()).signed(&ONE), [expected]);
}

/// The reply to a packet waits for about one frame of full size, and not for the burst.
#[test]
fn a_burst_goes_on_by_about_a_frame_with_every_packet() {
    let mut bench = full_size(&hermite());
    bench.done(&Request::Burst(ENDLESS));
    for packets in 1..5 {
        let made = bench.records(0).records.len();
        assert!((packets - 1..=packets + 1).contains(&made), "{made} frames with {packets} packets");
    }
    bench.done(&Request::Burst(Burst { frames: 0, ..ENDLESS }));
    assert!(bench.records_when(0, |told| told.state == BurstState::Ended).records.len() < 9);
}

#[test]
fn a_mock_may_be_one_from_before_bursts() {
    let old = Built(Options { bursts: BurstBuild::None, entered: false, ..Options::default() }, None);
    let mut bench = Bench::greeted(&old);
    let answer = bench.done(&Request::Capabilities);
    let Reply::Capabilities(capabilities) = answer.reply() else { panic!("{answer:?}") };
    assert_eq!((capabilities.bursts, capabilities.entered), (None, false));
    for request in [Request::Burst(ONE), Request::Records { from: 0 }, Request::Trap] {
        assert_eq!(bench.refused(&request), (RefusalCode::Kind, 0));
    }
    assert_eq!(bench.refused(&Request::Expect(Expect { first: 0, bytes: &[] })), (RefusalCode::Kind, 0));
    make_ready(&mut bench, 1);
    assert_eq!(bench.send_all(1, [0])[0].row().entered, None);
    halfrow_conformance::suite::burst_refusals::a_board_that_makes_none_refuses_the_kinds(&old);
}

#[test]
fn a_mock_may_be_without_a_trap_and_keep_few_records() {
    let options =
        Options { bursts: BurstBuild::Untrapped, records: 2, least_frame_blanking: 0, ..Options::default() };
    let few = Built(options, None);
    let (mut bench, bursts) =
        ready_with(&few, &Build::default(), configuration(HEIGHT), &golden_tables()).unwrap();
    assert_eq!((bursts.trap, bursts.records, bursts.least_frame_blanking), (false, 2, 0));
    let trapped = Burst { mode: BurstMode::Trapped, ..ONE };
    assert_eq!(bench.refused(&Request::Burst(trapped)), (RefusalCode::Range, 5));
    assert_eq!(bench.refused(&Request::Trap), (RefusalCode::Kind, 0));
    bench.done(&Request::Burst(Burst { frame_blanking: 0, ..ENDLESS }));
    assert_eq!(bench.records_when(0, |told| told.records.len() == 2).state, BurstState::UnderWay);
    assert!(bench.records_when(2, |told| told.records.len() == 2).records[0].held_back);
    halfrow_conformance::suite::bursts::a_frame_without_a_free_record_is_held_back_and_says_so(&few);
    halfrow_conformance::suite::burst_refusals::a_board_that_makes_none_refuses_the_kinds(&few);
}

/// The signatures of a burst of `frames` golden frames.
fn signatures(bench: &mut Bench, frames: u32) -> Vec<u32> {
    bench.signed(&Burst { frames, ..ENDLESS }).iter().map(|record| record.signature).collect()
}

/// Whether rows that a host sends come back unchanged and in time, with the CRC-32 of what was sent.
fn is_right_row_by_row(fault: BoardFault) -> bool {
    let mut bench = Bench::greeted(&Built(Options::default(), Some(fault)));
    make_ready(&mut bench, 8);
    let mut right = true;
    for number in 0..16 {
        for packet in bench.send_all(8, [number]) {
            let out = packet.row();
            let mut found = vec![0; out.place.width.into()];
            samples::unpack(out.packed, &mut found);
            let sent = row(8, out.place.row_sequence).samples;
            right &= found == sent && out.entered == Some(crc_of_words(sent));
            right &= (out.first_latency, out.last_latency, out.pauses) == (44, 44, 0);
            bench.window = out.place.row_sequence + 1;
        }
    }
    right && bench.window == 16
}

#[test]
fn faults_that_only_speed_shows_do_not_show_row_by_row() {
    for fault in [
        BoardFault::SlowPath { bit: 5, one_in: 1, seed: 2 },
        BoardFault::WarmBit { after: 0, row: 3, bit: 5 },
        BoardFault::LateSwap,
        BoardFault::HiddenPause { row: 3 },
    ] {
        assert!(is_right_row_by_row(fault), "{fault:?}");
    }
    assert!(!is_right_row_by_row(BoardFault::SpoiltRow { row: 3, column: None, bit: 5 }));
}

/// One output in 256 flips, but none in the burst's first row.
#[test]
fn a_slow_path_flips_outputs_of_rows_that_follow_without_a_pause() {
    let found = signatures(&mut broken(BoardFault::SlowPath { bit: 5, one_in: 256, seed: 2 }), 40);
    let wrong = found.iter().filter(|&&signature| signature != FRAME).count();
    assert!((10..40).contains(&wrong), "{wrong} of 40 frames");
    let mut bench = broken(BoardFault::SlowPath { bit: 0, one_in: 1, seed: 1 });
    bench.done(&Request::Configure(configuration(1)));
    let alone = Burst { frames: 1, ..ENDLESS };
    let mut sound =
        ready_with(&crate::Mock, &Build::default(), configuration(HEIGHT), &golden_tables()).unwrap().0;
    sound.done(&Request::Configure(configuration(1)));
    assert_eq!(bench.signed(&alone), sound.signed(&alone), "a row in front of which there is none");
}

#[test]
fn a_warm_board_flips_a_bit_behind_so_many_frames_of_all_bursts() {
    let mut bench = broken(BoardFault::WarmBit { after: 3, row: 2, bit: 11 });
    assert_eq!(signatures(&mut bench, 2), [FRAME; 2]);
    let warm: Vec<_> = bench.signed(&Burst { burst: 2, frames: 3, ..ENDLESS });
    assert_eq!(warm[0].signature, FRAME);
    assert!(
        warm[1..].iter().all(|record| record.signature == warm[1].signature && record.signature != FRAME)
    );
}

/// What is signed when row 0 alone has the tables of the frame before.
#[test]
fn a_late_swap_shows_when_frames_are_as_close_as_they_may_be() {
    let mut bench = broken(BoardFault::LateSwap);
    TableSet::unstretched(HEIGHT).upload(&mut bench);
    let close = Burst { mode: BurstMode::Alternating, frames: 3, frame_blanking: 8, ..ONE };
    let found = bench.signed(&close);
    let far = bench.signed(&Burst { burst: 2, frame_blanking: 9, ..close });
    assert_eq!((found[0], far[0].signature), (far[0], FRAME));
    assert_ne!(found[1].signature, far[1].signature);
    assert_ne!(found[2].signature, far[2].signature);
    assert_eq!(found[1].generation, 0, "the record denies it");
    let fresh = Burst { burst: 3, mode: BurstMode::Repeating, ..close };
    assert!(bench.signed(&fresh).iter().all(|record| record.signature == FRAME), "no bank changes");
}

/// Its row 0 is its last, too.
#[test]
fn a_late_swap_is_denied_by_the_records_of_frames_of_one_row() {
    let mut bench = broken(BoardFault::LateSwap);
    bench.done(&Request::Configure(configuration(1)));
    TableSet::unstretched(HEIGHT).upload(&mut bench);
    let close = Burst { mode: BurstMode::Alternating, frames: 3, frame_blanking: 8, ..ONE };
    let found: Vec<_> = bench.signed(&close).iter().map(|record| record.generation).collect();
    assert_eq!(found, [1, 0, 1]);
}

#[test]
fn a_hidden_pause_shows_in_the_latency_alone() {
    let record = broken(BoardFault::HiddenPause { row: 3 }).signed(&ONE)[0];
    assert_eq!((record.least_latency, record.most_latency, record.pauses), (44, 45, 0));
    assert_eq!((record.signature, record.samples), (FRAME, 256));
}

/// Row 3, column 7: the row comes back with the CRC-32 of what entered, so that a fault on the way in is not taken for one of
/// the core.
#[test]
fn a_row_that_is_spoilt_on_its_way_in_says_what_entered() {
    let mut bench = Bench::greeted(&Built(
        Options::default(),
        Some(BoardFault::SpoiltRow { row: 3, column: Some(7), bit: 5 }),
    ));
    make_ready(&mut bench, 4);
    let heard = bench.send_all(4, 0..4);
    for (number, packet) in (0..).zip(&heard) {
        let mut expected = row(4, number).samples;
        if number == 3 {
            expected[7] ^= 32;
        }
        assert_eq!(packet.row().entered, Some(crc_of_words(expected.iter().copied())), "row {number}");
        let mut found = vec![0; 64];
        samples::unpack(packet.row().packed, &mut found);
        assert_eq!(found, expected, "row {number}");
    }
}

/// Faults of the core and the tables show at speed as they do row by row.
#[test]
fn faults_of_the_core_show_in_a_burst_too() {
    let late = broken(BoardFault::Late).signed(&ONE)[0];
    assert_eq!((late.signature, late.least_latency, late.most_latency), (FRAME, 45, 45));
    let stuck = broken(BoardFault::StuckData { bit: 5, value: true }).signed(&ONE)[0];
    assert_ne!(stuck.signature, FRAME);
    let lost = broken(BoardFault::LostRow { row: 1 }).signed(&ONE)[0];
    assert_eq!((lost.rows, lost.samples), (3, 192));
    assert_ne!(lost.signature, FRAME);
}
