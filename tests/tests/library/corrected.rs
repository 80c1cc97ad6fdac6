//! Frames that a board corrects for a program of its own.

use std::iter;
use std::num::NonZeroU8;
use std::ops::ControlFlow;
use std::sync::Arc;

use halfrow::board::{Board, OpenOptions};
use halfrow::correction::Correction;
use halfrow::progress::Silent;
use halfrow::result::Problem;
use halfrow_model::{BitDepth, Equidistant, Frame, Geometry, Interpolant, Kernel, Phase, TableSet};
use halfrow_tests::system::open;

const COLUMNS: usize = 64;
const ROWS: usize = 8;

fn grey(columns: usize, rows: usize, depth: BitDepth, sample: u16) -> Arc<Frame> {
    Arc::new(Frame::new(columns, depth, Phase::Grbg, vec![sample; columns * rows]).unwrap())
}

/// The frames that the mock board `target` returned for `inputs`, with tables for 64 x 8 samples of 8 bits, and why it returned no
/// more.
fn corrected(target: &str, inputs: impl IntoIterator<Item = Arc<Frame>>) -> (Vec<Vec<u16>>, Option<Problem>) {
    let lens = Equidistant::from_radius(10.0).unwrap();
    let geometry = Geometry::centred(COLUMNS, ROWS, BitDepth::Eight).unwrap();
    let tables = TableSet::from_lens(geometry, &lens, None).unwrap();
    let kernel = Kernel::from(Interpolant::Linear);
    let correction =
        Correction { tables: &tables, kernel: &kernel, generation: NonZeroU8::MIN, first_frame: 0 };
    let mut taken = Vec::new();
    let take = |samples| {
        taken.push(samples);
        ControlFlow::Continue(())
    };
    let run = |board: &mut Board| correction.run(board, inputs.into_iter(), take, &Silent);
    let ran = Board::with(open(target).link, &OpenOptions::default(), run).unwrap();
    (taken, ran.err().map(|error| Problem::of(&error)))
}

#[test]
fn a_frame_that_does_not_fit_the_tables_ends_a_correction_after_those_that_do() {
    let _alone = crate::RUNS.lock();
    let sound = grey(COLUMNS, ROWS, BitDepth::Eight, 100);
    let unfit = [
        (grey(COLUMNS, ROWS, BitDepth::Twelve, 4000), "12 bits"),
        (grey(COLUMNS, 2 * ROWS, BitDepth::Eight, 100), "64 x 16"),
        (grey(2 * COLUMNS, ROWS, BitDepth::Eight, 100), "128 x 8"),
    ];
    for (unfit, named) in unfit {
        let inputs = [Arc::clone(&sound), Arc::clone(&sound), unfit, Arc::clone(&sound)];
        let (taken, problem) = corrected("mock", inputs);
        // Equal samples have that sample between them, and the last ones are repeated beyond the edges.
        assert_eq!(taken, vec![vec![100; COLUMNS * ROWS]; 2], "{named}");
        let Problem { code, message, .. } = problem.unwrap();
        assert_eq!(code, "frame-does-not-fit-tables", "{message}");
        assert!(message.contains(named), "{message}");
    }
}

#[test]
fn no_board_is_blamed_for_tables_that_do_not_suit_it() {
    let _alone = crate::RUNS.lock();
    let (taken, problem) = corrected("mock,max-height=4", iter::empty());
    assert!(taken.is_empty());
    assert_eq!(problem.unwrap().code, "frames-too-large-for-board");
}
