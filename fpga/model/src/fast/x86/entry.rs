//! All the `unsafe` code of this crate: calls of functions that need processor features, and moving vectors from and to memory.
//!
//! Vector arithmetic is safe inside a function that is compiled for the feature. A call from any other function is not, since
//! on a processor without the feature the behaviour is undefined. So it takes a token that only detection hands out. Loads and
//! stores take pointers, so they are wrapped here to take arrays of the vector's size, which are valid at every address.
#![allow(unsafe_code)]

use std::arch::x86_64::{
    __m128i, __m256i, __m512i, _mm_loadu_si128, _mm256_loadu_si256, _mm256_storeu_si256, _mm512_loadu_si512,
    _mm512_storeu_si512,
};

use super::{avx2, avx512};
use crate::fast::Rows;
use crate::fast::located::Located;
use crate::fast::nodes::Nodes;
use crate::fast::walk::Walk;

/// Proof that this processor has AVX2.
#[derive(Clone, Copy)]
pub(in crate::fast) struct Avx2(());

/// Proof that this processor has AVX-512 F, BW and VL.
#[derive(Clone, Copy)]
pub(in crate::fast) struct Avx512(());

impl Avx2 {
    pub(in crate::fast) fn detect() -> Option<Self> {
        is_x86_feature_detected!("avx2").then_some(Self(()))
    }

    pub(in crate::fast) fn correct<W: Walk, const ROWS: usize>(
        self,
        nodes: &avx2::Planes,
        rows: Rows<'_, W, ROWS>,
    ) {
        // SAFETY: the token says that the processor has AVX2.
        unsafe { avx2::correct(nodes, rows) }
    }

    pub(in crate::fast) fn locate(self, walk: &mut impl Walk) -> Located {
        // SAFETY: the token says that the processor has AVX2.
        unsafe { avx2::locate_block(walk) }
    }

    pub(in crate::fast) fn bits_of(self, samples: &[u16]) -> u16 {
        // SAFETY: the token says that the processor has AVX2.
        unsafe { avx2::bits_of(samples) }
    }
}

impl Avx512 {
    pub(in crate::fast) fn detect() -> Option<Self> {
        let all = is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512bw")
            && is_x86_feature_detected!("avx512vl");
        all.then_some(Self(()))
    }

    pub(in crate::fast) fn correct<W: Walk, const ROWS: usize>(self, nodes: &Nodes, rows: Rows<'_, W, ROWS>) {
        // SAFETY: the token says that the processor has the three features.
        unsafe { avx512::correct(nodes, rows) }
    }

    pub(in crate::fast) fn locate(self, walk: &mut impl Walk) -> Located {
        // SAFETY: the token says that the processor has the three features.
        unsafe { avx512::locate_block(walk) }
    }

    pub(in crate::fast) fn bits_of(self, samples: &[u16]) -> u16 {
        // SAFETY: the token says that the processor has the three features.
        unsafe { avx512::bits_of(samples) }
    }

    pub(in crate::fast) fn hold(self, draws: &[u16], max: u16, samples: &mut [u16]) {
        // SAFETY: the token says that the processor has the three features.
        unsafe { avx512::hold(draws, max, samples) }
    }
}

/// Loads 16 bytes.
#[target_feature(enable = "avx2")]
#[inline]
pub(super) fn load_16_bytes(bytes: &[u8; 16]) -> __m128i {
    // SAFETY: 16 bytes may be read at the array's address, and the load asks for no alignment.
    unsafe { _mm_loadu_si128(bytes.as_ptr().cast()) }
}

/// Loads eight samples, starting with sample `from`.
#[target_feature(enable = "avx2")]
#[inline]
pub(super) fn load_8_samples(samples: &[u16], from: usize) -> __m128i {
    let samples = &samples[from..from + 8];
    // SAFETY: as above; 8 samples are 16 bytes.
    unsafe { _mm_loadu_si128(samples.as_ptr().cast()) }
}

/// Loads sixteen samples, starting with sample `from`.
#[target_feature(enable = "avx2")]
#[inline]
pub(super) fn load_16_samples(samples: &[u16], from: usize) -> __m256i {
    let samples = &samples[from..from + 16];
    // SAFETY: 32 bytes may be read at the slice's address, and the load asks for no alignment.
    unsafe { _mm256_loadu_si256(samples.as_ptr().cast()) }
}

/// Stores sixteen samples.
#[target_feature(enable = "avx2")]
#[inline]
pub(super) fn store_16_samples(samples: &mut [u16; 16], vector: __m256i) {
    // SAFETY: 32 bytes may be written at the array's address, and the store asks for no alignment.
    unsafe { _mm256_storeu_si256(samples.as_mut_ptr().cast(), vector) }
}

/// Loads 32 samples, starting with sample `from`.
#[target_feature(enable = "avx512f")]
#[inline]
pub(super) fn load_32_samples(samples: &[u16], from: usize) -> __m512i {
    let samples = &samples[from..from + 32];
    // SAFETY: 64 bytes may be read at the slice's address, and the load asks for no alignment.
    unsafe { _mm512_loadu_si512(samples.as_ptr().cast()) }
}

/// Loads 32 signed words of 16 bits.
#[target_feature(enable = "avx512f")]
#[inline]
pub(super) fn load_32_weights(words: &[i16; 32]) -> __m512i {
    // SAFETY: as above.
    unsafe { _mm512_loadu_si512(words.as_ptr().cast()) }
}

/// Stores 32 samples.
#[target_feature(enable = "avx512f")]
#[inline]
pub(super) fn store_32_samples(samples: &mut [u16; 32], vector: __m512i) {
    // SAFETY: 64 bytes may be written at the array's address, and the store asks for no alignment.
    unsafe { _mm512_storeu_si512(samples.as_mut_ptr().cast(), vector) }
}
