//! Packing sixteen samples at a time, by AVX2 where the processor has it.

use core::arch::x86_64::*;

use super::packed_length;

/// Samples in a vector.
const GROUP: usize = 16;
/// Their bytes on the wire.
const PACKED: usize = packed_length(GROUP);

/// How far ahead of the samples being packed memory is prefetched, in bytes: about a row.
const AHEAD: usize = 4096;

/// Packs the first samples, as many as fill vectors, and returns how many.
pub(super) fn pack(samples: &[u16], packed: &mut [u8]) -> usize {
    if !std::is_x86_feature_detected!("avx2") {
        return 0;
    }
    let (groups, places) = (samples.as_chunks().0, packed.as_chunks_mut().0);
    // SAFETY: the processor has AVX2.
    unsafe { pack_groups(groups, places) };
    GROUP * groups.len().min(places.len())
}

/// Unpacks the first samples, as many as fill vectors, and returns how many.
pub(super) fn unpack(packed: &[u8], samples: &mut [u16]) -> usize {
    if !std::is_x86_feature_detected!("avx2") {
        return 0;
    }
    let (places, groups) = (packed.as_chunks().0, samples.as_chunks_mut().0);
    // SAFETY: the processor has AVX2.
    unsafe { unpack_groups(places, groups) };
    GROUP * groups.len().min(places.len())
}

#[target_feature(enable = "avx2")]
fn pack_groups(groups: &[[u16; GROUP]], places: &mut [[u8; PACKED]]) {
    let twelve_bits = _mm256_set1_epi16(0xfff);
    // A pair becomes first + 2^12 · second.
    let shift_second = _mm256_set1_epi32(1 << 28 | 1);
    let lower_three =
        _mm256_broadcastsi128_si256(_mm_setr_epi8(0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, -1, -1, -1, -1));
    let close_up = _mm256_setr_epi32(0, 1, 2, 4, 5, 6, 3, 7);
    for (group, place) in groups.iter().zip(places) {
        // The next row: frames come from memory, and a processor does not prefetch across a page boundary.
        _mm_prefetch::<_MM_HINT_T0>(group.as_ptr().cast::<i8>().wrapping_add(AHEAD));
        // SAFETY: the group is as long as the vector.
        let samples = unsafe { _mm256_loadu_si256(group.as_ptr().cast()) };
        let pairs = _mm256_madd_epi16(_mm256_and_si256(samples, twelve_bits), shift_second);
        let packed = _mm256_permutevar8x32_epi32(_mm256_shuffle_epi8(pairs, lower_three), close_up);
        let (low, high) = (_mm256_castsi256_si128(packed), _mm256_extracti128_si256::<1>(packed));
        // SAFETY: the place is 24 bytes long: 16, and the 8 after them.
        unsafe {
            _mm_storeu_si128(place.as_mut_ptr().cast(), low);
            _mm_storel_epi64(place[16..].as_mut_ptr().cast(), high);
        }
    }
}

#[target_feature(enable = "avx2")]
fn unpack_groups(places: &[[u8; PACKED]], groups: &mut [[u16; GROUP]]) {
    let twelve_bits = _mm256_set1_epi16(0xfff);
    // Each sample's two bytes; the upper lane is loaded four bytes early.
    let spread = _mm_setr_epi8(0, 1, 1, 2, 3, 4, 4, 5, 6, 7, 7, 8, 9, 10, 10, 11);
    let spread = _mm256_set_m128i(_mm_add_epi8(spread, _mm_set1_epi8(4)), spread);
    for (place, group) in places.iter().zip(groups) {
        // SAFETY: both vectors of 16 bytes lie inside the place, whose length is 24.
        let packed =
            unsafe { _mm256_loadu2_m128i(place[PACKED - 16..].as_ptr().cast(), place.as_ptr().cast()) };
        let words = _mm256_shuffle_epi8(packed, spread);
        let first = _mm256_and_si256(words, twelve_bits);
        let samples = _mm256_blend_epi16::<0b1010_1010>(first, _mm256_srli_epi16::<4>(words));
        // SAFETY: the group is as long as the vector.
        unsafe { _mm256_storeu_si256(group.as_mut_ptr().cast(), samples) };
    }
}
