//! The datapath in vectors of 256 bits: 32 columns at a time, 16 a vector, one 16-bit lane each.
//!
//! AVX2 looks up bytes, in tables of 16 entries and in each half of a vector on its own. So the tables are kept as bytes, 64
//! entries in four parts, and each half, eight columns, takes its samples from its own window.

use std::arch::x86_64::*;

use super::entry::{load_8_samples, load_16_bytes, load_16_samples, store_16_samples};
use crate::WEIGHT_ONE;
use crate::fast::located::Located;
use crate::fast::nodes::{G0, G4, G6, INTERVALS, Nodes, R1, R5};
use crate::fast::padded::Outputs;
use crate::fast::walk::{LEADS, Start, Walk, blocks};
use crate::fast::{BLOCK, Rows};
use crate::frame;

/// Columns of a vector.
const VECTOR: usize = 16;

/// One byte of a table's 64 words.
type Plane = [[u8; 16]; INTERVALS / 16];

/// One tap's tables, byte by byte: low, rise, and the sign of the wrap.
struct TapPlanes {
    low: [Plane; 2],
    rise: [Plane; 2],
    wrap: Plane,
}

/// A kernel as bytes.
pub(in crate::fast) struct Planes {
    taps: [TapPlanes; 5],
    outer: bool,
    wild: bool,
}

impl Planes {
    pub(in crate::fast) fn new(nodes: &Nodes) -> Self {
        let taps = std::array::from_fn(|tap| {
            let tap = &nodes.taps[tap];
            TapPlanes { low: bytes(&tap.low), rise: bytes(&tap.rise), wrap: bytes(&tap.wrap)[0] }
        });
        Self { taps, outer: nodes.outer, wild: nodes.wild }
    }
}

fn bytes(words: &[i16; INTERVALS]) -> [Plane; 2] {
    std::array::from_fn(|byte| {
        std::array::from_fn(|part| std::array::from_fn(|entry| words[16 * part + entry].to_le_bytes()[byte]))
    })
}

/// The sources of 16 columns, in 16-bit lanes.
#[derive(Clone, Copy)]
struct Places {
    /// The least a of each half, counted from the block's least one: below 32.
    least: [usize; 2],
    /// a − the half's least a, 0 to 7.
    base: __m256i,
    /// x, the lower 14 bits.
    x: __m256i,
}

/// What the lanes of a row with a single factor have in common.
#[derive(Clone, Copy)]
struct Lanes {
    /// The change from the first column to the even ones of each vector, in 32-bit lanes.
    even: [__m256i; 2],
    /// The change from one column to the next.
    step: __m256i,
}

/// Corrects the rows with code for just the taps and the wildness that the kernel has.
#[target_feature(enable = "avx2")]
pub(super) fn correct<W: Walk, const ROWS: usize>(planes: &Planes, rows: Rows<'_, W, ROWS>) {
    match (planes.outer, planes.wild) {
        (false, false) => correct_as::<W, ROWS, 3, false>(planes, rows),
        (true, false) => correct_as::<W, ROWS, 5, false>(planes, rows),
        (false, true) => correct_as::<W, ROWS, 3, true>(planes, rows),
        (true, true) => correct_as::<W, ROWS, 5, true>(planes, rows),
    }
}

#[target_feature(enable = "avx2")]
fn correct_as<W: Walk, const ROWS: usize, const WEIGHTS: usize, const WILD: bool>(
    planes: &Planes,
    rows: Rows<'_, W, ROWS>,
) {
    let Rows { mut walk, width, max, inputs, mut outputs } = rows;
    let lanes = lanes(&walk);
    let max = _mm256_set1_epi16(max as i16);
    // Locating a block while the one before it is corrected hides most of the latency of its steps.
    let mut ahead = locate(&mut walk, &lanes);
    for column in blocks(width) {
        let (first, places) = std::mem::replace(&mut ahead, locate(&mut walk, &lanes));
        let weights = weights::<WEIGHTS, WILD>(planes, [places[0].x, places[1].x]);
        for (row, output) in inputs.iter().zip(&mut outputs) {
            let window = row.window(first);
            for (part, output) in output.block(column).as_chunks_mut().0.iter_mut().enumerate() {
                let [low, high] = places[part].least;
                // Both are below 32 anyway; the modulo lets the compiler see it and leave out its checks.
                let halves = [&window[low % BLOCK..], &window[high % BLOCK..]];
                let samples = blend::<WEIGHTS, WILD>(&weights[part], halves, places[part].base, max);
                store_16_samples(output, samples);
            }
        }
    }
    outputs.into_iter().for_each(Outputs::finish);
}

/// The sources of the next block, for checks.
#[target_feature(enable = "avx2")]
pub(super) fn locate_block<W: Walk>(walk: &mut W) -> Located {
    let lanes = lanes(walk);
    let (first, places) = locate(walk, &lanes);
    let mut located = Located { first, base: [0; BLOCK], x: [0; BLOCK] };
    let parts = located.base.as_chunks_mut().0.iter_mut().zip(located.x.as_chunks_mut().0);
    for ((bases, x), places) in parts.zip(places) {
        let [low, high] = places.least.map(|least| _mm_set1_epi16(least as i16));
        store_16_samples(bases, _mm256_add_epi16(places.base, _mm256_set_m128i(high, low)));
        store_16_samples(x, places.x);
    }
    located
}

#[target_feature(enable = "avx2")]
fn lanes(walk: &impl Walk) -> Lanes {
    let step = _mm256_set1_epi32(walk.step() as i32);
    Lanes { even: pairs().map(|pairs| _mm256_mullo_epi32(_mm256_add_epi32(step, step), pairs)), step }
}

/// 0 to 15 in 32-bit lanes.
#[target_feature(enable = "avx2")]
#[inline]
fn pairs() -> [__m256i; 2] {
    [_mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7), _mm256_setr_epi32(8, 9, 10, 11, 12, 13, 14, 15)]
}

/// The displacements of each vector's even and odd columns.
#[target_feature(enable = "avx2")]
#[inline]
fn displacements<W: Walk>(lanes: &Lanes, start: &Start) -> [[__m256i; 2]; 2] {
    let first = _mm256_set1_epi32(start.displacement as i32);
    if !W::CURVED {
        return lanes.even.map(|even| {
            let even = _mm256_add_epi32(first, even);
            [even, _mm256_add_epi32(even, lanes.step)]
        });
    }
    let &Start { step, half, bend, .. } = start;
    let [twice, half, bend] = [step.wrapping_mul(2), half, bend].map(|word| _mm256_set1_epi32(word as i32));
    pairs().map(|pairs| {
        let bent = _mm256_mullo_epi32(pairs, bend);
        let even = _mm256_add_epi32(first, _mm256_mullo_epi32(pairs, _mm256_add_epi32(bent, twice)));
        [even, _mm256_add_epi32(even, _mm256_add_epi32(bent, half))]
    })
}

/// [`Start::first`] of the next block, and a and x of each vector.
#[target_feature(enable = "avx2")]
#[inline]
fn locate<W: Walk>(walk: &mut W, lanes: &Lanes) -> (isize, [Places; 2]) {
    let start = walk.next();
    let [low, high] = displacements::<W>(lanes, &start);
    let leads = &LEADS[usize::from(start.lead)];
    (start.first, [place(low, load_16_samples(leads, 0)), place(high, load_16_samples(leads, VECTOR))])
}

#[target_feature(enable = "avx2")]
#[inline]
fn place([even, odd]: [__m256i; 2], leads: __m256i) -> Places {
    let moved = _mm256_blend_epi16::<0xAA>(_mm256_srai_epi32::<26>(even), _mm256_srai_epi32::<10>(odd));
    let x = _mm256_blend_epi16::<0xAA>(_mm256_srli_epi32::<13>(even), _mm256_slli_epi32::<3>(odd));
    let from_block = _mm256_add_epi16(_mm256_and_si256(moved, _mm256_set1_epi16(!1)), leads);
    // The lesser of a half's first two bases is its least.
    let first = _mm256_shuffle_epi8(from_block, _mm256_set1_epi16(0x0100));
    let second = _mm256_shuffle_epi8(from_block, _mm256_set1_epi16(0x0302));
    let least = _mm256_min_epu16(first, second);
    let halves = [_mm256_extract_epi16::<0>(least), _mm256_extract_epi16::<8>(least)];
    let base = _mm256_sub_epi16(from_block, least);
    Places { least: [halves[0] as usize, halves[1] as usize], base, x }
}

/// The weights of 32 columns: w = low + ((rise · t + 2^7) >> 8). A rounding multiplication of rise by t · 2^7 gives the second
/// term.
#[target_feature(enable = "avx2")]
#[inline]
fn weights<const WEIGHTS: usize, const WILD: bool>(
    planes: &Planes,
    x: [__m256i; 2],
) -> [[__m256i; WEIGHTS]; 2] {
    let node = _mm256_packus_epi16(_mm256_srli_epi16::<8>(x[0]), _mm256_srli_epi16::<8>(x[1]));
    let nodes = parts(_mm256_and_si256(node, _mm256_set1_epi8(63)));
    let mut weights = [[node; WEIGHTS]; 2];
    for (place, tap) in planes.taps[..WEIGHTS].iter().enumerate() {
        let [low, rise] = [look_up_words(&tap.low, nodes), look_up_words(&tap.rise, nodes)];
        for part in 0..2 {
            let t7 = _mm256_and_si256(_mm256_slli_epi16::<7>(x[part]), _mm256_set1_epi16(0x7f80));
            weights[part][place] = _mm256_add_epi16(low[part], _mm256_mulhrs_epi16(rise[part], t7));
        }
        if WILD {
            let wrap = look_up(&tap.wrap, nodes);
            for (part, wrap) in words(wrap, wrap).into_iter().enumerate() {
                let wrapped = _mm256_sign_epi16(_mm256_slli_epi16::<8>(x[part]), wrap);
                weights[part][place] = _mm256_add_epi16(weights[part][place], wrapped);
            }
        }
    }
    weights
}

/// The indices into each of a plane's four parts. Where the node is in another part, bit 7 is set, which looks up 0.
#[target_feature(enable = "avx2")]
#[inline]
fn parts(node: __m256i) -> [__m256i; 4] {
    let mut parts = [node; 4];
    for (part, places) in parts.iter_mut().enumerate() {
        let matching = _mm256_xor_si256(node, _mm256_set1_epi8(16 * part as i8));
        *places = _mm256_add_epi8(matching, _mm256_set1_epi8(0x70));
    }
    parts
}

/// The plane's bytes at the nodes.
#[target_feature(enable = "avx2")]
#[inline]
fn look_up(plane: &Plane, nodes: [__m256i; 4]) -> __m256i {
    let part = |part: usize| {
        _mm256_shuffle_epi8(_mm256_broadcastsi128_si256(load_16_bytes(&plane[part])), nodes[part])
    };
    _mm256_or_si256(_mm256_or_si256(part(0), part(1)), _mm256_or_si256(part(2), part(3)))
}

/// The words at the nodes, from their low and high bytes in the two planes: for the first 16 columns and for the second.
#[target_feature(enable = "avx2")]
#[inline]
fn look_up_words(planes: &[Plane; 2], nodes: [__m256i; 4]) -> [__m256i; 2] {
    words(look_up(&planes[0], nodes), look_up(&planes[1], nodes))
}

/// The words with these low and high bytes.
#[target_feature(enable = "avx2")]
#[inline]
fn words(low: __m256i, high: __m256i) -> [__m256i; 2] {
    [_mm256_unpacklo_epi8(low, high), _mm256_unpackhi_epi8(low, high)]
}

/// Computes acc in 32-bit lanes, two products at a time, then the output.
#[target_feature(enable = "avx2")]
#[inline]
fn blend<const WEIGHTS: usize, const WILD: bool>(
    weights: &[__m256i; WEIGHTS],
    windows: [&[u16]; 2],
    base: __m256i,
    max: __m256i,
) -> __m256i {
    // The indices of a word's two bytes, 2i and 2i + 1.
    let bytes =
        _mm256_add_epi16(_mm256_mullo_epi16(base, _mm256_set1_epi16(0x202)), _mm256_set1_epi16(0x100));
    let tap = |tap: usize| {
        let [low, high] = windows;
        let samples = _mm256_set_m128i(load_8_samples(high, tap), load_8_samples(low, tap));
        _mm256_shuffle_epi8(samples, bytes)
    };
    let (own, other) = (tap(2), tap(3));
    let from_own = |place: usize| _mm256_sub_epi16(tap(place), own);
    let from_other = |place: usize| _mm256_sub_epi16(tap(place), other);
    let mut sums = [_mm256_set1_epi32(WEIGHT_ONE / 2); 2];
    add_products(&mut sums, [weights[R1], weights[R5]], [from_other(1), from_other(5)]);
    let one = _mm256_set1_epi16(WEIGHT_ONE as i16);
    if WILD {
        add_products(&mut sums, [weights[G4], one], [from_own(4), own]);
        if WEIGHTS > 3 {
            add_products(&mut sums, [weights[G0], weights[G6]], [from_own(0), from_own(6)]);
        }
    } else {
        let mut g2 = _mm256_sub_epi16(one, weights[G4]);
        if WEIGHTS > 3 {
            g2 = _mm256_sub_epi16(_mm256_sub_epi16(g2, weights[G0]), weights[G6]);
            add_products(&mut sums, [weights[G0], weights[G6]], [tap(0), tap(6)]);
        }
        add_products(&mut sums, [weights[G4], g2], [tap(4), own]);
    }
    let [low, high] = sums;
    let rounded = _mm256_packus_epi32(_mm256_srai_epi32::<14>(low), _mm256_srai_epi32::<14>(high));
    _mm256_min_epu16(rounded, max)
}

/// Adds both products to the sums, which hold each half's lower and upper four lanes.
#[target_feature(enable = "avx2")]
#[inline]
fn add_products(sums: &mut [__m256i; 2], weights: [__m256i; 2], values: [__m256i; 2]) {
    let low = |pair: [__m256i; 2]| _mm256_unpacklo_epi16(pair[0], pair[1]);
    let high = |pair: [__m256i; 2]| _mm256_unpackhi_epi16(pair[0], pair[1]);
    sums[0] = _mm256_add_epi32(sums[0], _mm256_madd_epi16(low(weights), low(values)));
    sums[1] = _mm256_add_epi32(sums[1], _mm256_madd_epi16(high(weights), high(values)));
}

/// [`frame::bits_of`].
#[target_feature(enable = "avx2")]
pub(super) fn bits_of(samples: &[u16]) -> u16 {
    frame::bits_of(samples)
}
