//! The datapath in vectors of 512 bits: 32 columns at a time, one 16-bit lane each.

use std::arch::x86_64::*;

use super::entry::{load_32_samples, load_32_weights, store_32_samples};
use crate::WEIGHT_ONE;
use crate::fast::content;
use crate::fast::located::Located;
use crate::fast::nodes::{G0, G4, G6, Nodes, R1, R5, Tap};
use crate::fast::padded::Outputs;
use crate::fast::walk::{LEADS, Start, Walk, blocks};
use crate::fast::{BLOCK, Rows};
use crate::frame;

/// Lanes of the odd columns.
const ODD: u32 = 0xAAAA_AAAA;

/// What the lanes of a row with a single factor have in common.
struct Lanes {
    /// The change from the first column to the even ones, in 32-bit lanes.
    even: __m512i,
    /// The change from one column to the next.
    step: __m512i,
}

/// The sources of a block, in 16-bit lanes.
struct Places {
    /// [`Start::first`].
    first: isize,
    /// a − the block's least a, 0 to 31.
    base: __m512i,
    /// x, the lower 14 bits.
    x: __m512i,
}

/// The tables of one tap, each 64 words in two vectors.
#[derive(Clone, Copy)]
struct Table {
    low: [__m512i; 2],
    rise: [__m512i; 2],
    wrap: [__m512i; 2],
}

/// Corrects the rows with code for just the taps and the wildness that the kernel has.
#[target_feature(enable = "avx512f,avx512bw,avx512vl")]
pub(super) fn correct<W: Walk, const ROWS: usize>(nodes: &Nodes, rows: Rows<'_, W, ROWS>) {
    match (nodes.outer, nodes.wild) {
        (false, false) => correct_as::<W, ROWS, 3, false>(nodes, rows),
        (true, false) => correct_as::<W, ROWS, 5, false>(nodes, rows),
        (false, true) => correct_as::<W, ROWS, 3, true>(nodes, rows),
        (true, true) => correct_as::<W, ROWS, 5, true>(nodes, rows),
    }
}

#[target_feature(enable = "avx512f,avx512bw,avx512vl")]
fn correct_as<W: Walk, const ROWS: usize, const WEIGHTS: usize, const WILD: bool>(
    nodes: &Nodes,
    rows: Rows<'_, W, ROWS>,
) {
    let Rows { mut walk, width, max, inputs, mut outputs } = rows;
    let mut tables = [table(&nodes.taps[0]); WEIGHTS];
    for (table_of, tap) in tables.iter_mut().zip(&nodes.taps) {
        *table_of = table(tap);
    }
    let lanes = lanes(&walk);
    let max = _mm512_set1_epi16(max as i16);
    // Locating a block while the one before it is corrected hides most of the latency of its steps.
    let mut ahead = locate(&mut walk, &lanes);
    for column in blocks(width) {
        let places = std::mem::replace(&mut ahead, locate(&mut walk, &lanes));
        let weights = weights::<WEIGHTS, WILD>(&tables, places.x);
        for (row, output) in inputs.iter().zip(&mut outputs) {
            let samples = blend::<WEIGHTS, WILD>(&weights, row.window(places.first), places.base, max);
            store_32_samples(output.block(column), samples);
        }
    }
    outputs.into_iter().for_each(Outputs::finish);
}

/// The sources of the next block, for checks.
#[target_feature(enable = "avx512f,avx512bw,avx512vl")]
pub(super) fn locate_block(walk: &mut impl Walk) -> Located {
    let lanes = lanes(walk);
    let places = locate(walk, &lanes);
    let mut located = Located { first: places.first, base: [0; BLOCK], x: [0; BLOCK] };
    store_32_samples(&mut located.base, places.base);
    store_32_samples(&mut located.x, places.x);
    located
}

#[target_feature(enable = "avx512f,avx512bw,avx512vl")]
fn table(tap: &Tap) -> Table {
    let halves = |words: &[i16; 64]| {
        let [first, second] = words.as_chunks().0 else { return [_mm512_setzero_si512(); 2] };
        [load_32_weights(first), load_32_weights(second)]
    };
    Table { low: halves(&tap.low), rise: halves(&tap.rise), wrap: halves(&tap.wrap) }
}

#[target_feature(enable = "avx512f,avx512bw,avx512vl")]
fn lanes(walk: &impl Walk) -> Lanes {
    let step = _mm512_set1_epi32(walk.step() as i32);
    Lanes { even: _mm512_mullo_epi32(_mm512_add_epi32(step, step), pairs()), step }
}

/// 0 to 15 in 32-bit lanes.
#[target_feature(enable = "avx512f")]
#[inline]
fn pairs() -> __m512i {
    _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15)
}

/// The displacements of the even and of the odd columns.
#[target_feature(enable = "avx512f,avx512bw,avx512vl")]
#[inline]
fn displacements<W: Walk>(lanes: &Lanes, start: Start) -> [__m512i; 2] {
    let first = _mm512_set1_epi32(start.displacement as i32);
    if !W::CURVED {
        let even = _mm512_add_epi32(first, lanes.even);
        return [even, _mm512_add_epi32(even, lanes.step)];
    }
    let Start { step, half, bend, .. } = start;
    let bent = _mm512_mullo_epi32(pairs(), _mm512_set1_epi32(bend as i32));
    let along = _mm512_add_epi32(bent, _mm512_set1_epi32(step.wrapping_mul(2) as i32));
    let even = _mm512_add_epi32(first, _mm512_mullo_epi32(pairs(), along));
    [even, _mm512_add_epi32(even, _mm512_add_epi32(bent, _mm512_set1_epi32(half as i32)))]
}

/// a and x from the displacements.
#[target_feature(enable = "avx512f,avx512bw,avx512vl")]
#[inline]
fn locate<W: Walk>(walk: &mut W, lanes: &Lanes) -> Places {
    let start = walk.next();
    let [even, odd] = displacements::<W>(lanes, start);
    let moved = _mm512_mask_blend_epi16(ODD, _mm512_srai_epi32::<26>(even), _mm512_srai_epi32::<10>(odd));
    let x = _mm512_mask_blend_epi16(ODD, _mm512_srli_epi32::<13>(even), _mm512_slli_epi32::<3>(odd));
    let own = _mm512_and_si512(moved, _mm512_set1_epi16(!1));
    let base = _mm512_add_epi16(own, load_32_samples(&LEADS[usize::from(start.lead)], 0));
    Places { first: start.first, base, x }
}

/// w = low + ((rise · t + 2^7) >> 8). A rounding multiplication of rise by t · 2^7 gives the second term.
#[target_feature(enable = "avx512f,avx512bw,avx512vl")]
#[inline]
fn weights<const WEIGHTS: usize, const WILD: bool>(
    tables: &[Table; WEIGHTS],
    x: __m512i,
) -> [__m512i; WEIGHTS] {
    let node = _mm512_srli_epi16::<8>(x);
    let t7 = _mm512_and_si512(_mm512_slli_epi16::<7>(x), _mm512_set1_epi16(0x7f80));
    let mut weights = [x; WEIGHTS];
    for (weight, table) in weights.iter_mut().zip(tables) {
        let look_up = |table: [__m512i; 2]| _mm512_permutex2var_epi16(table[0], node, table[1]);
        *weight = _mm512_add_epi16(look_up(table.low), _mm512_mulhrs_epi16(look_up(table.rise), t7));
        if WILD {
            let t8 = _mm512_slli_epi16::<8>(x);
            *weight = _mm512_add_epi16(*weight, _mm512_mullo_epi16(look_up(table.wrap), t8));
        }
    }
    weights
}

/// Computes acc in 32-bit lanes, two products at a time, then the output.
#[target_feature(enable = "avx512f,avx512bw,avx512vl")]
#[inline]
fn blend<const WEIGHTS: usize, const WILD: bool>(
    weights: &[__m512i; WEIGHTS],
    window: &[u16],
    base: __m512i,
    max: __m512i,
) -> __m512i {
    let tap = |tap: usize| _mm512_permutexvar_epi16(base, load_32_samples(window, tap));
    let (own, other) = (tap(2), tap(3));
    let from_own = |place: usize| _mm512_sub_epi16(tap(place), own);
    let from_other = |place: usize| _mm512_sub_epi16(tap(place), other);
    let mut sums = [_mm512_set1_epi32(WEIGHT_ONE / 2); 2];
    add_products(&mut sums, [weights[R1], weights[R5]], [from_other(1), from_other(5)]);
    let one = _mm512_set1_epi16(WEIGHT_ONE as i16);
    if WILD {
        add_products(&mut sums, [weights[G4], one], [from_own(4), own]);
        if WEIGHTS > 3 {
            add_products(&mut sums, [weights[G0], weights[G6]], [from_own(0), from_own(6)]);
        }
    } else {
        let mut g2 = _mm512_sub_epi16(one, weights[G4]);
        if WEIGHTS > 3 {
            g2 = _mm512_sub_epi16(_mm512_sub_epi16(g2, weights[G0]), weights[G6]);
            add_products(&mut sums, [weights[G0], weights[G6]], [tap(0), tap(6)]);
        }
        add_products(&mut sums, [weights[G4], g2], [tap(4), own]);
    }
    let [low, high] = sums;
    let rounded = _mm512_packus_epi32(_mm512_srai_epi32::<14>(low), _mm512_srai_epi32::<14>(high));
    _mm512_min_epu16(rounded, max)
}

/// Adds both products to the sums, which hold the lower and upper four lanes of each 128 bits.
#[target_feature(enable = "avx512f,avx512bw,avx512vl")]
#[inline]
fn add_products(sums: &mut [__m512i; 2], weights: [__m512i; 2], values: [__m512i; 2]) {
    let low = |pair: [__m512i; 2]| _mm512_unpacklo_epi16(pair[0], pair[1]);
    let high = |pair: [__m512i; 2]| _mm512_unpackhi_epi16(pair[0], pair[1]);
    sums[0] = _mm512_add_epi32(sums[0], _mm512_madd_epi16(low(weights), low(values)));
    sums[1] = _mm512_add_epi32(sums[1], _mm512_madd_epi16(high(weights), high(values)));
}

/// [`frame::bits_of`].
#[target_feature(enable = "avx512f,avx512bw,avx512vl")]
pub(super) fn bits_of(samples: &[u16]) -> u16 {
    frame::bits_of(samples)
}

/// [`content::hold`]. Each column finds the nearest step at or left of it by doubling: among two columns, then among four, and
/// so on up to a block.
#[target_feature(enable = "avx512f,avx512bw,avx512vl")]
pub(super) fn hold(draws: &[u16], max: u16, samples: &mut [u16]) {
    let columns: [u16; BLOCK] = std::array::from_fn(|column| column as u16);
    let columns = load_32_samples(&columns, 0);
    let last = _mm512_set1_epi16(BLOCK as i16 - 1);
    let mut held = _mm512_set1_epi16(samples[0] as i16);
    let (blocks, _) = samples.as_chunks_mut();
    let whole = BLOCK * blocks.len();
    for (block, column) in blocks.iter_mut().zip((0..).step_by(BLOCK)) {
        let draws = load_32_samples(draws, column);
        let steps = _mm512_testn_epi16_mask(draws, _mm512_set1_epi16(15));
        let mut nearest = _mm512_maskz_mov_epi16(steps, columns);
        for reach in [1, 2, 4, 8, 16] {
            let left = _mm512_subs_epu16(columns, _mm512_set1_epi16(reach));
            nearest = _mm512_max_epu16(nearest, _mm512_permutexvar_epi16(left, nearest));
        }
        let levels = _mm512_and_si512(_mm512_srli_epi16::<4>(draws), _mm512_set1_epi16(max as i16));
        let before_steps = steps.wrapping_sub(1) & !steps;
        let found = _mm512_permutexvar_epi16(nearest, levels);
        let filled = _mm512_mask_blend_epi16(before_steps, found, held);
        store_32_samples(block, filled);
        held = _mm512_permutexvar_epi16(last, filled);
    }
    content::hold(&draws[whole - 1..], max, &mut samples[whole - 1..]);
}
