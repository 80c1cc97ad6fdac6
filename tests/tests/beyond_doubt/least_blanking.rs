//! Boards whose datapath needs a longer pause between two rows than they say.

use halfrow::Plan;
use halfrow::result::{CheckName, Report};
use halfrow_mock::Options;
use halfrow_protocol::Kind;
use halfrow_tests::altered::{Altered, Passing, Toward};
use halfrow_tests::system::{System, failed_check, judge_by_plan};

/// Where CONFIGURE has the blanking, and ROW_OUT its row and the first of its samples (WIRE.md, 18 and 21).
const BLANKING: std::ops::Range<usize> = 6..8;
const ROW: std::ops::Range<usize> = 6..8;
const SAMPLES: usize = 20;

/// The report on a board that makes rows wrongly which follow another one after less than `needs` pixel clocks.
fn needing(needs: u16) -> Report {
    needing_in(needs, |row| row > 0)
}

/// The same for a board that makes only those of these rows wrongly that are `meant`.
fn needing_in(needs: u16, meant: fn(u16) -> bool) -> Report {
    let mut blanking = 0;
    let plan = Plan { fail_fast: false, ..System::TINY.plan() };
    let board = Altered::new(&Options::default(), move |toward, mut packet: Passing| {
        if toward == Toward::Board && packet.is(Kind::Configure) {
            blanking = packet.payload.get(BLANKING).map_or(0, |at| u16::from_le_bytes([at[0], at[1]]));
        }
        let follows = |out: &[u8]| meant(u16::from_le_bytes([out[ROW][0], out[ROW][1]])) && blanking < needs;
        if toward == Toward::Host && packet.is(Kind::RowOut) && follows(&packet.payload) {
            packet.payload[SAMPLES] ^= 5;
        }
        vec![packet]
    });
    judge_by_plan(&plan, board.candidate())
}

#[test]
fn a_board_that_names_too_small_a_blanking_is_told_so() {
    let report = needing(200);
    assert_eq!(failed_check(&report), Some(CheckName::Frames), "{}", report.headline());
    let suspect = report.suspects.first().unwrap();
    assert_eq!(suspect.part(), "blanking", "{}", report.headline());
    assert!(report.headline().contains("the board names as its least_blanking"), "{}", report.headline());
    assert!(suspect.designer().contains("least_blanking"), "{}", suspect.designer());
}

#[test]
fn a_board_that_is_wrong_with_any_blanking_is_not() {
    let report = needing(u16::MAX);
    assert_eq!(failed_check(&report), Some(CheckName::Frames), "{}", report.headline());
    assert_ne!(report.suspects.first().unwrap().part(), "blanking", "{}", report.headline());
}

/// One row of a frame may also be right by chance.
#[test]
fn a_board_that_is_wrong_in_one_row_of_a_frame_is_not() {
    let report = needing_in(200, |row| row == 3);
    assert_eq!(failed_check(&report), Some(CheckName::Frames), "{}", report.headline());
    assert_ne!(report.suspects.first().unwrap().part(), "blanking", "{}", report.headline());
}
