//! The datapath in vectors of 512 bits: 32 columns at a time, one 16-bit lane each.

use std::arch::x86_64::*;

use super::entry::{load_16_words, load_32_samples, load_32_weights, store_32_samples};
use crate::WEIGHT_ONE;
use crate::fast::content;
use crate::fast::located::Located;
use crate::fast::nodes::{G0, G4, G6, Nodes, R1, R5, Tap};
use crate::fast::walk::{LEADS, Start, Walk, blocks, is_within_segment};
use crate::fast::{BLOCK, Rows};
use crate::frame;

/// Lanes of the odd columns.
const ODD: u32 = 0xAAAA_AAAA;

/// What the lanes of a row of one factor have in common.
struct Lanes {
    /// 2Q times the even columns, 0 to 30, in 32-bit lanes.
    even: __m512i,
    /// 2Q in 32-bit lanes.
    stride: __m512i,
}

/// Where the outputs of a block come from, in 16-bit lanes.
struct Places {
    /// a − the block's least a, 0 to 31.
    base: __m512i,
    /// x, the lower 14 bits.
    x: __m512i,
}

/// The table of one tap, 64 words in two vectors each.
#[derive(Clone, Copy)]
struct Table {
    low: [__m512i; 2],
    rise: [__m512i; 2],
    wrap: [__m512i; 2],
}

/// Corrects the rows with the kernel's own combination of taps and wildness.
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
    let Rows { walk, width, max, inputs, mut outputs } = rows;
    let mut tables = [table(&nodes.taps[0]); WEIGHTS];
    for (table_of, tap) in tables.iter_mut().zip(&nodes.taps) {
        *table_of = table(tap);
    }
    let lanes = lanes(walk);
    let max = _mm512_set1_epi16(max as i16);
    for column in blocks(width, BLOCK) {
        let start = walk.start(column);
        let places = locate(relatives(walk, &lanes, column, &start), start.lead);
        let weights = weights::<WEIGHTS, WILD>(&tables, places.x);
        for (row, output) in inputs.iter().zip(&mut outputs) {
            let window = row.window(start.first);
            store_32_samples(output, column, blend::<WEIGHTS, WILD>(&weights, window, places.base, max));
        }
    }
}

/// The sources of one block, for those who check them.
#[target_feature(enable = "avx512f,avx512bw,avx512vl")]
pub(super) fn locate_block(walk: impl Walk, column: usize) -> Located {
    let start = walk.start(column);
    let places = locate(relatives(walk, &lanes(walk), column, &start), start.lead);
    let mut located = Located { first: start.first, base: [0; BLOCK], x: [0; BLOCK] };
    store_32_samples(&mut located.base, 0, places.base);
    store_32_samples(&mut located.x, 0, places.x);
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
fn lanes(walk: impl Walk) -> Lanes {
    let stride = _mm512_set1_epi32(walk.stride() as i32);
    let columns = _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
    Lanes { even: _mm512_mullo_epi32(stride, columns), stride }
}

/// The coordinates of the even and of the odd columns relative to the block: below 2^26 + 31 · 2^25, so 31 bits hold them.
#[target_feature(enable = "avx512f,avx512bw,avx512vl")]
#[inline]
fn relatives<W: Walk>(walk: W, lanes: &Lanes, column: usize, start: &Start) -> [__m512i; 2] {
    if !W::CURVED {
        let even = _mm512_add_epi32(_mm512_set1_epi32(start.relative as i32), lanes.even);
        return [even, _mm512_add_epi32(even, lanes.stride)];
    }
    if !is_within_segment(column) {
        return scattered(walk, column, start);
    }
    let even = _mm512_setr_epi32(-16, -14, -12, -10, -8, -6, -4, -2, 0, 2, 4, 6, 8, 10, 12, 14);
    let odd = _mm512_setr_epi32(-15, -13, -11, -9, -7, -5, -3, -1, 1, 3, 5, 7, 9, 11, 13, 15);
    [along(start, even), along(start, odd)]
}

/// The coordinates of columns that lie across two segments.
#[target_feature(enable = "avx512f,avx512bw,avx512vl")]
#[cold]
#[inline(never)]
fn scattered(walk: impl Walk, column: usize, start: &Start) -> [__m512i; 2] {
    let of = |first: usize| std::array::from_fn(|lane| walk.relative(first + 2 * lane, start));
    [load_16_words(&of(column)), load_16_words(&of(column + 1))]
}

/// The coordinates at these columns from the block's middle.
#[target_feature(enable = "avx512f,avx512bw,avx512vl")]
#[inline]
fn along(start: &Start, columns: __m512i) -> __m512i {
    let piece = &start.piece;
    let squares = _mm512_mullo_epi32(columns, columns);
    let bent = _mm512_mullo_epi32(squares, _mm512_set1_epi32(piece.curve));
    let bent = _mm512_srai_epi32::<3>(_mm512_add_epi32(bent, _mm512_set1_epi32(piece.rest as i32)));
    let straight = _mm512_mullo_epi32(columns, _mm512_set1_epi32(piece.slope as i32));
    _mm512_add_epi32(
        _mm512_add_epi32(straight, _mm512_set1_epi32((start.relative + piece.middle) as i32)),
        bent,
    )
}

/// n, then a and x, from the coordinates relative to the block.
#[target_feature(enable = "avx512f,avx512bw,avx512vl")]
#[inline]
fn locate([even, odd]: [__m512i; 2], lead: bool) -> Places {
    let n = _mm512_mask_blend_epi16(ODD, _mm512_srli_epi32::<25>(even), _mm512_srli_epi32::<9>(odd));
    let q = _mm512_mask_blend_epi16(ODD, _mm512_srli_epi32::<12>(even), _mm512_slli_epi32::<4>(odd));
    // n counts from an even column, so bit 13 of q tells its parity, and that of x whether it is the output's.
    let x = _mm512_xor_si512(q, _mm512_set1_epi32(1 << 29));
    let rounded = _mm512_and_si512(_mm512_add_epi16(n, _mm512_set1_epi32(1 << 16)), _mm512_set1_epi16(!1));
    let base = _mm512_add_epi16(rounded, load_32_samples(&LEADS[usize::from(lead)], 0));
    Places { base, x }
}

/// w = low + ((rise · t + 2^7) >> 8), which is what a rounding multiplication by t · 2^7 gives.
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

/// acc in 32-bit lanes, two products at a time, then the output.
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

/// Adds both products to the sums of each 128 bits' lower and upper four lanes.
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

/// [`content::hold`]. Each column looks for the nearest step up to it: among two columns, then among those of the column two to
/// the left as well, and so on up to a block.
#[target_feature(enable = "avx512f,avx512bw,avx512vl")]
pub(super) fn hold(draws: &[u16], max: u16, samples: &mut [u16]) {
    let columns: [u16; BLOCK] = std::array::from_fn(|column| column as u16);
    let columns = load_32_samples(&columns, 0);
    let last = _mm512_set1_epi16(BLOCK as i16 - 1);
    let mut held = _mm512_set1_epi16(samples[0] as i16);
    let whole = samples.len() / BLOCK * BLOCK;
    for column in (0..whole).step_by(BLOCK) {
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
        let block = _mm512_mask_blend_epi16(before_steps, found, held);
        store_32_samples(samples, column, block);
        held = _mm512_permutexvar_epi16(last, block);
    }
    content::hold(&draws[whole - 1..], max, &mut samples[whole - 1..]);
}
