//! Runs of some of their parts only.

use std::sync::{Arc, Mutex};

use halfrow::board::{Board, BoardNature, Capabilities, OpenOptions};
use halfrow::frames::Builtin;
use halfrow::link::Candidate;
use halfrow::progress::Silent;
use halfrow::result::{CheckName, EqualAtSpeed, Finding, NoBurst, NotExercised, Outcome, Report, SoakLength};
use halfrow::run::{AtSpeed, Build, FrameSource, Part, Plan, Prices, Rates, RunOptions, Selection, verify};
use halfrow::target::BoardKind;
use halfrow::verdict::{Cause, Verdict};
use halfrow_mock::Options;
use halfrow_model::{BitDepth, Equidistant, Geometry, GridShape, Interpolant, TableSet};
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Altered, Passing, Toward};
use halfrow_tests::system::{System, failed_check, judge_by_plan, open};

const ROWS: usize = 16;

fn plan(selection: Option<Selection>) -> Plan {
    let system = System { height: ROWS, ..System::TINY };
    Plan { selection, fail_fast: false, ..system.plan() }
}

fn judged(board: &str, selection: Selection) -> Report {
    judge_by_plan(&plan(Some(selection)), open(board))
}

/// The packets that the host sends in a run by `plan`.
fn sent(plan: &Plan) -> Vec<Passing> {
    let packets = Arc::new(Mutex::new(Vec::new()));
    let seen = Arc::clone(&packets);
    let alter = move |toward, passing: Passing| {
        if toward == Toward::Board {
            seen.lock().unwrap().push(passing.clone());
        }
        vec![passing]
    };
    let report = judge_by_plan(plan, Altered::new(&Options::default(), alter).candidate());
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    packets.lock().unwrap().clone()
}

#[test]
fn all_parts_are_the_run_as_it_is_without_a_selection_to_the_byte() {
    let _alone = crate::RUNS.lock();
    let vary = halfrow::run::Vary { centre: true, depth: true };
    let whole = plan(None).varying(vary);
    let selection = Selection::all(whole.parts(&Build::full(64)));
    assert_eq!(selection.amount(Part::Centre), usize::MAX);
    let (expected, found) = (sent(&whole), sent(&Plan { selection: Some(selection), ..whole }));
    assert!(expected.iter().filter(|packet| packet.is(Kind::RowIn)).count() > 200);
    assert!(expected == found);
}

/// On a virtual clock nothing here is left to chance. Rows of 64 samples cost less than their price, and pixel clocks take the
/// mock no time.
#[test]
fn a_price_is_what_a_run_takes_and_a_little_more() {
    let _alone = crate::RUNS.lock();
    let least = Selection::least();
    let selections = [
        least.clone(),
        least.with(Part::AtSpeed, 3),
        least.with(Part::Corners, 1),
        least.with(Part::Rules, 1),
        least.with(Part::Swap, 16).with(Part::Gaps, 7),
        Selection::all(plan(None).parts(&Build::full(64))),
    ];
    let boards = [
        ("mock,speed=20000", 0.7),
        ("mock,speed=300000,delay=0.002", 0.8),
        ("mock,speed=300000,delay=0.002,bursts=untrapped", 0.8),
        ("mock,speed=300000,delay=0.002,bursts=no,entered=no", 0.8),
        ("mock,speed=5000000", 0.15),
    ];
    for (board, least_share) in boards {
        let mut opened = Board::open(open(board).link, &OpenOptions::default()).unwrap();
        let rates = Rates::of(&mut opened).unwrap();
        for selection in &selections {
            let plan = plan(Some(selection.clone()));
            let prices = Prices::new(&plan, opened.capabilities(), rates);
            let price = prices.opening() + prices.seconds(selection);
            let taken = judge_by_plan(&plan, open(board)).link.seconds;
            assert!(taken <= price, "{board}, {selection:?}: {taken} s for {price} s");
            assert!(taken > least_share * price, "{board}, {selection:?}: {taken} s for {price} s");
        }
    }
}

#[test]
fn one_row_and_a_burst_are_a_run() {
    let _alone = crate::RUNS.lock();
    let least = Selection::least().with(Part::AtSpeed, 2);
    let report = judged("mock", least.clone());
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    let [frame] = &report.frames[..] else { panic!("{:?}", report.frames) };
    assert_eq!((frame.first_rows, frame.rows, frame.comparison.samples), (Some(1), 1, 64));
    let at_speed = report.checks.iter().find(|check| check.name == CheckName::AtSpeed).unwrap();
    assert!(
        matches!(at_speed.finding, Finding::EqualAtSpeed(EqualAtSpeed { frames: 2, corners: 0, .. })),
        "{at_speed:?}"
    );

    // Both need rows after row 0.
    for fault in ["row-factor,row=9,hidden=true", "warm-bit,after=1,row=9"] {
        let report = judged(&format!("mock,fault={fault}"), least.clone());
        assert_eq!(failed_check(&report), Some(CheckName::AtSpeed), "{fault}: {}", report.headline());
    }
    let whole = judged("mock", least.with(Part::Corners, 1));
    let at_speed = whole.checks.iter().find(|check| check.name == CheckName::AtSpeed).unwrap();
    assert!(
        matches!(at_speed.finding, Finding::EqualAtSpeed(EqualAtSpeed { corners: 16, .. })),
        "{at_speed:?}"
    );
}

#[test]
fn a_row_that_is_wrong_is_found_with_it_and_not_without() {
    let _alone = crate::RUNS.lock();
    let spoilt = "mock,fault=spoilt-row,row=9,entered=no";
    for part in [Part::Judged(2), Part::Gaps, Part::SensorBlanking, Part::Decoy, Part::Swap] {
        let [without, with] = [9, 10].map(|rows| judged(spoilt, Selection::least().with(part, rows)));
        assert_eq!(without.verdict(), Verdict::Pass, "{part}: {}", without.headline());
        assert_eq!(failed_check(&with), Some(CheckName::Frames), "{part}: {}", with.headline());
        let cut: Vec<_> = with.frames.iter().filter(|frame| frame.first_rows == Some(10)).collect();
        let differ: Vec<_> = cut.iter().map(|frame| frame.comparison.first.unwrap().row).collect();
        assert_eq!(differ, vec![9; if part == Part::Swap { 2 } else { 1 }], "{part}");
        // One sample of the row, each time.
        let next = with.suspects[0].designer();
        assert!(!next.contains("at times"), "{part}: {next}");
    }
}

#[test]
fn frames_at_another_centre_and_depth_can_be_cut_too() {
    let _alone = crate::RUNS.lock();
    let selection = Selection::least().with(Part::Centre, 10).with(Part::Depth(8), 3).with(Part::Swap, 4);
    let vary = halfrow::run::Vary { centre: true, depth: true };
    let judged = |board| judge_by_plan(&plan(Some(selection.clone())).varying(vary), open(board));
    let report = judged("mock");
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    let rows: Vec<_> = report.frames.iter().map(|frame| (frame.rows, frame.generation)).collect();
    // One row of the decoy comes before the tables change.
    assert_eq!(rows, [(1, 1), (4, 1), (4, 2), (10, 3), (3, 4)]);
    let report = judged("mock,fault=spoilt-row,row=9,entered=no");
    assert_eq!(report.verdict(), Verdict::Fail, "{}", report.headline());
    let differs: Vec<_> = report.frames.iter().map(|frame| frame.comparison.differences > 0).collect();
    assert_eq!(differs, [false, false, false, true, false]);
}

#[test]
fn what_was_left_out_is_not_called_exercised() {
    let _alone = crate::RUNS.lock();
    let speed = |report: &Report| {
        report.checks.iter().find(|check| check.name == CheckName::AtSpeed).map(|check| {
            (check.outcome, matches!(check.finding, Finding::NothingAtSpeed { reason: NoBurst::LeftOut {} }))
        })
    };
    let rows_told = |report: &Report| {
        report
            .not_exercised
            .iter()
            .any(|part| matches!(part, NotExercised::RowTableAddress { lines } if lines.contains(&1)))
    };
    let report = judged("mock", Selection::least());
    assert_eq!(speed(&report), Some((Outcome::Skipped, true)));
    assert!(rows_told(&report), "{:?}", report.not_exercised);
    assert!(report.not_exercised.contains(&NotExercised::FullSpeed {}));
    assert!(report.not_exercised.contains(&NotExercised::Rules {}));
    // Frames at speed are made with all their rows.
    let report = judged("mock", Selection::least().with(Part::AtSpeed, 2));
    assert!(!rows_told(&report), "{:?}", report.not_exercised);
}

#[test]
fn a_frame_of_a_file_is_cut_like_any() {
    let _alone = crate::RUNS.lock();
    let whole = plan(None);
    let scene = whole.scene(7);
    let frame = Arc::new(Builtin::Noise.render(&scene).unwrap());
    let file = FrameSource::File { path: "own.pgm".into(), frame };
    let plan = Plan { at_speed: AtSpeed::Off, selection: Some(Selection::least()), ..whole.frames([file]) };
    let report = judge_by_plan(&plan, open("mock"));
    assert_eq!((report.verdict(), report.frames[0].first_rows), (Verdict::Pass, Some(1)));
}

/// DATAPATH.md, "Legal": S[0] = 8·C·(2^24 - Q[0]) + 2^15·O is 24,192 - 32,768 here, and must be at least -2^14. Moved half way to
/// 1 and rounded down, like all factors and offsets of a decoy, 24 becomes 16, and the offset stays -1: 16,128 - 32,768.
#[test]
fn a_grid_beside_which_there_is_no_decoy_is_judged_without_one() {
    let _alone = crate::RUNS.lock();
    let (geometry, one) = (Geometry::new(192, 8, BitDepth::Twelve, 126).unwrap(), 1 << 24);
    // Three segments: an offset and four nodes, each for three grid rows.
    let entries = [one - 1, one - 24, one, one, one].map(|entry| [entry; 3]).concat();
    let tables = TableSet::from_grid(geometry, GridShape::new(6, 6).unwrap(), &entries).unwrap();
    assert!(tables.check_ring(256).is_ok() && tables.halved().check_ring(256).is_err());
    let lens = Equidistant::from_radius(100.0).unwrap();
    let plan = Plan::new(tables, Interpolant::Hermite.into()).seen_through(lens);
    let report = judge_by_plan(&plan, open("mock"));
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    // All built-in frames, one with the sensor's blanking and one with gaps, all with the judged tables.
    let frames: Vec<_> = report.frames.iter().map(|frame| frame.generation).collect();
    assert_eq!(frames, vec![2; Builtin::ALL.len() + 2]);
    // Tables change in the corners of the board's settings, whose grids are others.
    assert!(!report.not_exercised.contains(&NotExercised::TableChangeAtSpeed {}));
    for (fault, check) in [("stuck-data", CheckName::Frames), ("late-swap", CheckName::AtSpeed)] {
        let report = judge_by_plan(&plan, open(&format!("mock,fault={fault}")));
        assert_eq!(failed_check(&report), Some(check), "{}", report.headline());
    }
    let at_speed = AtSpeed::Soak(SoakLength::Frames { frames: 100 });
    let report = judge_by_plan(&Plan { at_speed, ..plan }, open("mock"));
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    assert!(report.not_exercised.contains(&NotExercised::TableChangeAtSpeed {}));
}

/// Also where it is behind a link to the outside, and says itself what it is.
#[test]
fn a_board_that_says_that_it_is_none_is_no_hardware() {
    let _alone = crate::RUNS.lock();
    let judged = |nature, require_hardware| {
        let alter = move |_, packet: Passing| match packet.reply() {
            Some(Reply::Capabilities(capabilities)) => {
                vec![packet.saying(&Reply::Capabilities(Capabilities { nature, ..capabilities }))]
            }
            _ => vec![packet],
        };
        let candidate = Altered::new(&Options::default(), alter).candidate();
        let candidate = Candidate { kind: BoardKind::Hardware, ..candidate };
        let options = RunOptions { require_hardware, ..RunOptions::default() };
        verify(&plan(Some(Selection::least())), candidate, &options, &Silent).unwrap().report
    };
    let hardware = judged(BoardNature::Hardware, true);
    assert_eq!(hardware.verdict(), Verdict::Pass);
    assert!(hardware.not_exercised.contains(&NotExercised::CameraPins {}));
    // It says that its clock is the host's own, as a mock does.
    let clock = NotExercised::UnseenClock { clock_hz: 96_000_000 };
    assert!(hardware.not_exercised.contains(&clock), "{:?}", hardware.not_exercised);
    for (nature, board) in [(BoardNature::Mock, BoardKind::Mock), (BoardNature::Simulation, BoardKind::Sim)] {
        let report = judged(nature, false);
        assert_eq!(report.verdict(), Verdict::Pass);
        assert!(!report.not_exercised.contains(&NotExercised::CameraPins {}));
        let report = judged(nature, true);
        assert_eq!((report.verdict(), report.cause), (Verdict::Error, Cause::NothingJudged));
        assert_eq!(report.finding, Finding::HardwareRequired { board });
    }
}
