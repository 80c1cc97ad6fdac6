//! Tables that ask for samples that the ring does not hold: whatever is in its cells comes out instead.
//!
//! All cases have W = M = 64 and rows of equal samples, so that an output tells which row it came from.

use halfrow_mock::{Kernel, Node, RowBinding};

use crate::support::{binding, constant, core, row_out, run};

const QUARTER: u32 = 1 << 22;

fn stretched(centre2: u16, kernel: Kernel) -> RowBinding {
    RowBinding { centre2, ..binding(64, QUARTER, kernel) }
}

/// The outputs of a row of `samples[0]`, a row of `samples[1]` and so on.
fn rows_out(binding: &RowBinding, samples: &[u16], blanking: usize) -> Vec<Vec<u16>> {
    let rows: Vec<_> = samples.iter().map(|&sample| (vec![sample; 64], binding.clone())).collect();
    let outputs = run(&mut core(12, 64, None), &rows, blanking);
    (0..samples.len()).map(|index| row_out(&outputs, 64, index)).collect()
}

/// C = 126 and Q = 1/4: column j comes from 47.25 + j/4. When it is read, columns up to j + 35 have entered. So the window of
/// column 0, which is loaded at once, holds no sample later than column 35, and column 57 (n = 53, at j = 23) is the first that
/// enters the window in time. An output whose weights are all zero is the sample of its base column: 57 for j = 39, 56 for j =
/// 40, 57 for j = 41, 56 for j = 42, and 57 or more from j = 43 on.
#[test]
fn looking_too_far_ahead_shows_the_row_before() {
    let rows = rows_out(&stretched(126, Kernel::default()), &[100, 200], 0);
    let expected: Vec<u16> = (0..64).map(|j| if j < 39 || j == 40 || j == 42 { 100 } else { 200 }).collect();
    assert_eq!(rows[1], expected);
}

#[test]
fn looking_too_far_ahead_shows_an_empty_memory_in_the_first_row() {
    let rows = rows_out(&stretched(126, Kernel::default()), &[100], 0);
    let expected: Vec<u16> = (0..64).map(|j| if j < 39 || j == 40 || j == 42 { 0 } else { 100 }).collect();
    assert_eq!(rows[0], expected);
}

/// C = 0 and Q = 1/4: column j comes from j/4. When it is read, the newest sample is j + 35 columns into this row or the next,
/// so column j − 28 is the oldest that is left. Column n + 4 enters the window at j = 4n: from column 15 (n = 11, j = 44) on
/// they come too late and are the next row's. With g4 = 1 an output is the sample two columns right of its base: column 15 for
/// j = 53 and 55, column 14 for j = 54, 15 or more from j = 56 on.
#[test]
fn looking_too_far_back_shows_the_row_behind() {
    let right = constant(Node { g4: 1 << 14, ..Node::default() });
    let rows = rows_out(&stretched(0, right), &[100, 200], 0);
    let expected: Vec<u16> = (0..64).map(|j| if j < 53 || j == 54 { 100 } else { 200 }).collect();
    assert_eq!(rows[0], expected);
}

#[test]
fn looking_too_far_back_is_harmless_in_a_long_blanking() {
    let right = constant(Node { g4: 1 << 14, ..Node::default() });
    let rows = rows_out(&stretched(0, right), &[100, 200], 100);
    assert_eq!(rows, [vec![100; 64], vec![200; 64]]);
}
