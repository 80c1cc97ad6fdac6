//! Boards whose datapath needs a longer pause between two rows than they say, and one that needs what it says.

use halfrow::Plan;
use halfrow::result::{CheckName, Report};
use halfrow::verdict::Verdict;
use halfrow_mock::Options;
use halfrow_model::{BitDepth, Camera, Equidistant, Geometry, GridShape};
use halfrow_protocol::message::{FrameRecord, Records, Request};
use halfrow_protocol::{Kind, Reply};
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
    assert!(report.headline().contains("the board names as the least"), "{}", report.headline());
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

/// What the mock claims in capability 12.
const GRID_BLANKING: u16 = 32;
const GRID_WIDTH: u16 = 144;

/// Rows of a grid that are narrower than grid_width need grid_blanking clocks between them (WIRE.md, 12), those of two frames of a
/// burst included. This board makes such rows wrongly after fewer.
#[test]
fn a_board_gets_the_blanking_that_it_names_for_narrow_rows_of_a_grid() {
    let geometry = Geometry::centred(64, 16, BitDepth::Twelve).unwrap();
    let lens = Equidistant::from_radius(60.0).unwrap();
    let camera = Camera::new(geometry, lens.into(), (31.5, 7.5), 180.0).unwrap();
    let tables = camera.grid_by_formula(GridShape::new(2, 5).unwrap());
    let plan = Plan { fail_fast: false, ..Plan::new(tables, System::TINY.plan().kernel).seen_through(lens) };
    let (mut is_grid, mut is_narrow, mut rows, mut frames) = (false, false, 0, 0);
    let alter = move |toward, mut packet: Passing| {
        let is_close = is_grid && is_narrow && rows < GRID_BLANKING;
        match (toward, packet.request(), packet.reply()) {
            (Toward::Board, Some(Request::Commit(commit)), _) => {
                is_grid = commit.shape.is_some_and(|shape| shape.v > 0);
            }
            (Toward::Board, Some(Request::Configure(settings)), _) => {
                (is_narrow, rows) = (settings.width < GRID_WIDTH, settings.blanking);
            }
            (Toward::Board, Some(Request::Burst(burst)), _) => frames = burst.frame_blanking,
            (Toward::Host, _, Some(Reply::RowOut(_))) if is_close => packet.payload[SAMPLES] ^= 5,
            (Toward::Host, _, Some(Reply::Records(found)))
                if is_close || is_grid && is_narrow && frames < GRID_BLANKING =>
            {
                let wrong = |record| FrameRecord { signature: 0, ..record };
                let bytes: Vec<_> = found.records().map(|record| wrong(record).to_bytes()).collect();
                return vec![packet.saying(&Reply::Records(Records { bytes: &bytes, ..found }))];
            }
            _ => {}
        }
        vec![packet]
    };
    // No row of this build is wide, not even those with which the corners of its settings are tried.
    let options = Options { max_width: 64, ring: Some(128), ..Options::default() };
    let report = judge_by_plan(&plan, Altered::new(&options, alter).candidate());
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
}
