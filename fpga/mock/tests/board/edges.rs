//! Columns outside the row: the nearest sample of the same colour stands in.

use halfrow_mock::{Kernel, Node, RowBinding};

use crate::support::{
    GOLDEN_FACTOR, binding, constant, core, hermite, keys, noise_row, row_out, run, unchanged,
};

fn corrected(samples: &[u16], binding: RowBinding) -> Vec<u16> {
    row_out(&run(&mut core(12, 2048, None), &[(samples.to_vec(), binding)], 0), 64, 0)
}

#[test]
fn the_first_two_columns_stand_in_on_the_left() {
    let samples = noise_row(0, 64);
    let two_left = constant(Node { g0: 1 << 14, ..Node::default() });
    let expected: Vec<_> = [0, 1].into_iter().chain(0..62).map(|column| samples[column]).collect();
    assert_eq!(corrected(&samples, binding(64, 1 << 24, two_left)), expected);
}

#[test]
fn the_last_two_columns_stand_in_on_the_right() {
    let samples = noise_row(0, 64);
    let four_right = constant(Node { g6: 1 << 14, ..Node::default() });
    let expected: Vec<_> = (4..64).chain([62, 63, 62, 63]).map(|column| samples[column]).collect();
    assert_eq!(corrected(&samples, binding(64, 1 << 24, four_right)), expected);
}

/// With C = 0 and Q = 1/4, columns 0 to 3 come from n = 0. The base of the odd ones is column −1, for which column 1 stands in;
/// so it does for the taps two columns left of that base.
#[test]
fn a_base_left_of_the_row_takes_the_second_column() {
    let samples = noise_row(0, 64);
    for kernel in [Kernel::default(), constant(Node { g0: 1 << 14, ..Node::default() })] {
        let row = RowBinding { centre2: 0, ..binding(64, 1 << 22, kernel) };
        let expected = [0, 1, 0, 1].map(|column| samples[column]);
        assert_eq!(corrected(&samples, row)[..4], expected);
    }
}

#[test]
fn a_row_flat_in_each_colour_stays_flat_up_to_its_edges() {
    let samples: Vec<_> = (0..64).map(|column| if column % 2 == 0 { 1000 } else { 3000 }).collect();
    for kernel in [hermite(), keys()] {
        for (centre2, factor) in
            [(0, GOLDEN_FACTOR), (63, GOLDEN_FACTOR), (126, 1 << 24), (63, 1), (10, 1 << 23)]
        {
            let row = RowBinding { centre2, values: factor.into(), ..unchanged(64) };
            assert_eq!(corrected(&samples, RowBinding { kernel: kernel.clone().into(), ..row }), samples);
        }
    }
}
