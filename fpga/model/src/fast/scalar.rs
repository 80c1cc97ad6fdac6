//! The datapath in plain Rust, one column at a time.
//!
//! The weights of all seven taps at all 2^14 distances x are computed once a kernel. A sample is then one sum of products,
//! which compilers make of the vector instructions that every processor of a kind has.

use super::nodes::{G0, G4, G6, Nodes, R1, R5};
use super::walk::{Located, Walk, blocks};
use super::{BLOCK, Rows};
use crate::WEIGHT_ONE;

/// Distances x, 2^-13 column apart.
const DISTANCES: usize = 1 << 14;

/// Samples of a sum: seven taps, and one that has no weight.
const TERMS: usize = 8;

/// G0 R1 G2 R3 G4 R5 G6 and 0, as 16 bits where all of them fit.
pub(super) enum Weights {
    Narrow(Box<[[i16; TERMS]]>),
    Wide(Box<[[i32; TERMS]]>),
}

impl Weights {
    pub(super) fn new(nodes: &Nodes) -> Self {
        let wide = (0..DISTANCES).map(|x| weights_at(nodes, x));
        if nodes.wild {
            Self::Wide(wide.collect())
        } else {
            Self::Narrow(wide.map(|weights| weights.map(|weight| weight as i16)).collect())
        }
    }
}

fn weights_at(nodes: &Nodes, x: usize) -> [i32; TERMS] {
    let stored = |tap: usize| i32::from(nodes.taps[tap].weight(x));
    let [g0, r1, g4, r5, g6] = [G0, R1, G4, R5, G6].map(stored);
    [g0, r1, WEIGHT_ONE - g0 - g4 - g6, -r1 - r5, g4, r5, g6, 0]
}

pub(super) fn correct<const ROWS: usize>(weights: &Weights, rows: Rows<'_, ROWS>) {
    match weights {
        Weights::Narrow(weights) => correct_as(weights, rows),
        Weights::Wide(weights) => correct_as(weights, rows),
    }
}

fn correct_as<W: Copy + Into<i32>, const ROWS: usize>(weights: &[[W; TERMS]], rows: Rows<'_, ROWS>) {
    let Rows { walk, width, max, inputs, mut outputs } = rows;
    let max = i32::from(max);
    let Some(weights) = weights.first_chunk::<DISTANCES>() else { return };
    for column in blocks(width, BLOCK) {
        let start = walk.start(column);
        let mut places = [(0, 0); BLOCK];
        for (index, place) in places.iter_mut().enumerate() {
            let (first, x) = locate(walk, column + index);
            *place = (first - start.first, x);
        }
        for (row, output) in inputs.iter().zip(&mut outputs) {
            let output = &mut output[column..column + BLOCK];
            correct_block(weights, row.window(start.first), &places, max, output);
        }
    }
}

/// Corrects a block of one row whose taps begin at `places` of the window, at the distances beside them.
fn correct_block<W: Copy + Into<i32>>(
    weights: &[[W; TERMS]; DISTANCES],
    window: &[u16],
    places: &[(usize, usize); BLOCK],
    max: i32,
    output: &mut [u16],
) {
    // The sums first, and then what vectors do at once to all of them.
    let mut sums = [0; BLOCK];
    for (sum, &(offset, x)) in sums.iter_mut().zip(places) {
        // Below 32 as it is; that the compiler sees it saves checking.
        let offset = offset % BLOCK;
        *sum = weighted(&weights[x], &window[offset..offset + TERMS]);
    }
    for (output, sum) in output.iter_mut().zip(sums) {
        *output = ((sum + WEIGHT_ONE / 2) >> 14).clamp(0, max) as u16;
    }
}

/// The padded row's sample of tap G0, and x below [`DISTANCES`].
#[inline]
fn locate(walk: Walk, column: usize) -> (usize, usize) {
    let coordinate = walk.coordinate(column);
    let n = (coordinate >> 25) as usize;
    let back = (n ^ column) & 1;
    let x = (coordinate >> 12) as usize & 0x1fff | back << 13;
    (Walk::first_tap(n) - back, x)
}

/// The sum of the taps' products; samples are at most 12 bits.
#[inline]
fn weighted<W: Copy + Into<i32>>(weights: &[W; TERMS], taps: &[u16]) -> i32 {
    weights.iter().zip(taps).map(|(&weight, &tap)| weight.into() * i32::from(tap as i16)).sum()
}

/// The sources of one block, for those who check them.
pub(super) fn locate_block(walk: Walk, column: usize) -> Located {
    let located: [_; BLOCK] = std::array::from_fn(|index| locate(walk, column + index));
    let first = walk.start(column).first;
    Located { first, base: located.map(|(tap, _)| (tap - first) as u16), x: located.map(|(_, x)| x as u16) }
}
