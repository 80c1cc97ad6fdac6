//! The datapath in plain Rust, one column at a time.
//!
//! The weights of all seven taps at all 2^14 distances x are computed once per kernel. A sample is then one sum of products,
//! for which compilers use the vector instructions that every processor of the architecture has.

use super::located::Located;
use super::nodes::{G0, G4, G6, Nodes, R1, R5};
use super::padded::Outputs;
use super::walk::{LEADS, Start, Walk, blocks};
use super::{BLOCK, Rows};
use crate::WEIGHT_ONE;

/// Distances x, 2^-13 column apart.
const DISTANCES: usize = 1 << 14;

/// Terms of a sum: seven taps, and one with weight 0 that fills it up.
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

pub(super) fn correct<W: Walk, const ROWS: usize>(weights: &Weights, rows: Rows<'_, W, ROWS>) {
    match weights {
        Weights::Narrow(weights) => correct_as(weights, rows),
        Weights::Wide(weights) => correct_as(weights, rows),
    }
}

fn correct_as<W: Walk, T: Copy + Into<i32>, const ROWS: usize>(
    weights: &[[T; TERMS]],
    rows: Rows<'_, W, ROWS>,
) {
    let Rows { mut walk, width, max, inputs, mut outputs } = rows;
    let max = i32::from(max);
    let Some(weights) = weights.first_chunk::<DISTANCES>() else { return };
    for column in blocks(width) {
        let start = walk.next();
        let places = locate(&start);
        for (row, output) in inputs.iter().zip(&mut outputs) {
            correct_block(weights, row.window(start.first), &places, max, output.block(column));
        }
    }
    outputs.into_iter().for_each(Outputs::finish);
}

/// Corrects a block of one row. The taps of each output begin at its base in the window.
fn correct_block<T: Copy + Into<i32>>(
    weights: &[[T; TERMS]; DISTANCES],
    window: &[u16],
    places: &Places,
    max: i32,
    output: &mut [u16; BLOCK],
) {
    // The sums first, so that the rest is vectorised over all of them.
    let mut sums = [0; BLOCK];
    for ((sum, base), x) in sums.iter_mut().zip(places.base).zip(places.x) {
        // Neither changes either value: they let the compiler see the bounds and leave out its checks.
        let (offset, x) = (usize::from(base) % BLOCK, usize::from(x) % DISTANCES);
        *sum = weighted(&weights[x], &window[offset..offset + TERMS]);
    }
    for (output, sum) in output.iter_mut().zip(sums) {
        *output = ((sum + WEIGHT_ONE / 2) >> 14).clamp(0, max) as u16;
    }
}

/// Where the outputs of a block come from.
struct Places {
    /// a − the block's least a.
    base: [u16; BLOCK],
    /// x, below [`DISTANCES`].
    x: [u16; BLOCK],
}

/// a and x of the whole block, in a form that compilers vectorise.
#[inline]
fn locate(start: &Start) -> Places {
    let displacements = start.displacements();
    let leads = &LEADS[usize::from(start.lead)];
    let mut places = Places { base: [0; BLOCK], x: [0; BLOCK] };
    for (index, displacement) in displacements.into_iter().enumerate() {
        places.x[index] = (displacement >> 13 & 0x3fff) as u16;
        places.base[index] = ((displacement.cast_signed() >> 26) as u16 & !1).wrapping_add(leads[index]);
    }
    places
}

/// The sum of the taps' products; samples are at most 12 bits.
#[inline]
fn weighted<T: Copy + Into<i32>>(weights: &[T; TERMS], taps: &[u16]) -> i32 {
    weights.iter().zip(taps).map(|(&weight, &tap)| weight.into() * i32::from(tap as i16)).sum()
}

/// The sources of the next block, for checks.
pub(super) fn locate_block(walk: &mut impl Walk) -> Located {
    let start = walk.next();
    let Places { base, x } = locate(&start);
    Located { first: start.first, base, x }
}
