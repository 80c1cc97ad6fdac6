//! What a run keeps of its frames.

use std::error::Error;

use halfrow::frames::Builtin;
use halfrow::link;
use halfrow::model::{BitDepth, Frame, Phase};
use halfrow::progress::Silent;
use halfrow::run::{Finished, FrameSource, Plan, RunOptions, verify};
use halfrow_tests::system::System;

/// Frames that all differ, in addition to the run's own.
const FRAMES: u32 = 200;

/// Large enough for faults whose suspects can only be told apart by frames that came back right.
const DIAGNOSED: System = System { height: 16, radius: 40.0, ..System::TINY };

/// The result of a run of many frames on a broken board.
fn run(evidence_bytes: usize) -> Finished {
    let plan = System::TINY.plan().frames([FrameSource::Builtin(Builtin::Noise)]);
    let plan = Plan { repeat: FRAMES, fail_fast: false, ..plan };
    let board = link::open(&"mock,fault=stuck-data".parse().unwrap()).unwrap();
    let options = RunOptions { evidence_bytes, ..RunOptions::default() };
    verify(&plan, board, &options, &Silent).unwrap()
}

/// The tables are for 64 x 8 of 12 bits.
#[test]
fn a_frame_that_the_tables_are_not_for_is_refused_before_the_board_is_asked() {
    let _alone = crate::RUNS.lock();
    let frames = [
        (66, 8, BitDepth::Twelve, "the frame is 66 x 8 and the tables are for 64 x 8"),
        (128, 16, BitDepth::Twelve, "the frame is 128 x 16 and the tables are for 64 x 8"),
        (64, 8, BitDepth::Eight, "the frame has 8 bits a sample and the tables are for 12"),
    ];
    for (width, height, depth, why) in frames {
        let frame = Frame::new(width, depth, Phase::Grbg, vec![7; width * height]).unwrap();
        let file = FrameSource::File { path: "own.pgm".into(), frame: frame.into() };
        let plan = System::TINY.plan().frames([FrameSource::Builtin(Builtin::Noise), file]);
        let board = link::open(&"mock,fault=stuck-data".parse().unwrap()).unwrap();
        let refused =
            verify(&plan, board, &RunOptions::default(), &Silent).map(|ended| ended.report.verdict());
        let refused = refused.unwrap_err();
        assert!(refused.to_string().contains("own.pgm"), "{refused}");
        assert!(refused.source().is_some_and(|source| source.to_string().starts_with(why)), "{refused:?}");
    }
}

/// Bytes of the frames that were kept, and of the counts by row and column.
fn bytes(finished: &Finished) -> (usize, usize) {
    let frames = finished.evidence.iter().flat_map(|kept| [&kept.input, &kept.found, &kept.expected]);
    let counts = finished.report.frames.iter().flat_map(|frame| {
        let comparison = &frame.comparison;
        [&comparison.by_row, &comparison.by_column]
    });
    (
        frames.map(|frame| size_of_val(frame.samples())).sum(),
        counts.map(|counts| size_of_val(counts.as_slice())).sum(),
    )
}

#[test]
fn a_run_of_many_frames_that_differ_keeps_within_its_budget_and_says_what_it_left_out() {
    let _alone = crate::RUNS.lock();
    const BUDGET: usize = 64 << 10;
    let whole = run(usize::MAX);
    let differing = whole.report.frames.iter().filter(|frame| frame.comparison.differences > 0).count();
    assert!(differing >= FRAMES as usize, "{differing}");
    assert_eq!((whole.evidence.len(), whole.report.evidence.left_out), (differing, 0));
    assert!(bytes(&whole).0 > 4 * BUDGET, "the budget is none: {:?}", bytes(&whole));

    let kept = run(BUDGET);
    let (frames, counts) = bytes(&kept);
    assert!(frames + counts <= BUDGET && frames > BUDGET / 2, "{frames} {counts}");
    let said = kept.report.evidence;
    assert_eq!((said.kept, said.bytes), (kept.evidence.len(), frames as u64));
    assert_eq!(said.kept + said.left_out, differing);
    let found = |finished: &Finished| finished.report.suspects.first().map(halfrow::result::Suspect::place);
    assert!(found(&kept).is_some_and(|place| place.contains("bit 5")), "{:?}", kept.report.headline());
    assert_eq!(found(&kept), found(&whole));
}

/// The diagnosis of the board `target`: each suspect's place, share and evidence.
fn suspects(target: &str, keep_equal: bool) -> Vec<(String, f64, String)> {
    let board = link::open(&target.parse().unwrap()).unwrap();
    let options = RunOptions { keep_equal, ..RunOptions::default() };
    let plan = Plan { fail_fast: true, ..DIAGNOSED.plan() };
    let report = verify(&plan, board, &options, &Silent).unwrap().report;
    report.suspects.iter().map(|suspect| (suspect.place(), suspect.explained, suspect.evidence())).collect()
}

/// With some of these faults, frames come back right that one suspect would have changed and another not.
#[test]
fn suspects_are_the_same_whether_pictures_are_wanted_or_not() {
    let _alone = crate::RUNS.lock();
    for fault in [
        "drifting-table",
        "kernel-word,hidden=true,bit=1",
        "kernel-word,hidden=true",
        "row-factor,hidden=true",
        "stuck-data",
        "no-rounding",
    ] {
        let target = format!("mock,fault={fault}");
        let without = suspects(&target, false);
        assert!(!without.is_empty(), "{fault}");
        assert_eq!(without, suspects(&target, true), "{fault}");
    }
}
