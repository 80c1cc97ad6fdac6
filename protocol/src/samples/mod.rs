//! Samples on the wire: always 12 bits, two samples in three bytes, the low bits first.

#[cfg(all(target_arch = "x86_64", feature = "std"))]
#[expect(
    unsafe_code,
    reason = "vector instructions: loads, stores, and calls behind a look at the processor"
)]
mod avx2;
#[cfg(not(all(target_arch = "x86_64", feature = "std")))]
mod avx2 {
    pub(super) fn pack(_samples: &[u16], _packed: &mut [u8]) -> usize {
        0
    }

    pub(super) fn unpack(_packed: &[u8], _samples: &mut [u16]) -> usize {
        0
    }
}

use alloc::vec::Vec;

/// Bytes that `samples` samples take on the wire; `samples` is even.
#[must_use]
pub const fn packed_length(samples: usize) -> usize {
    (samples / 2).saturating_mul(3)
}

/// Appends `samples`, an even number of them, to `packed`. Bits above the twelfth are dropped.
pub fn pack(samples: &[u16], packed: &mut Vec<u8>) {
    let begin = packed.len();
    packed.resize(begin + packed_length(samples.len()), 0);
    let place = &mut packed[begin..];
    let done = avx2::pack(samples, place);
    pack_pairs(&samples[done..], &mut place[packed_length(done)..]);
}

/// Unpacks as many samples as both sides hold, pair by pair.
pub fn unpack(packed: &[u8], samples: &mut [u16]) {
    let done = avx2::unpack(packed, samples);
    unpack_pairs(&packed[packed_length(done)..], &mut samples[done..]);
}

fn pack_pairs(samples: &[u16], packed: &mut [u8]) {
    for (triple, &[first, second]) in packed.as_chunks_mut::<3>().0.iter_mut().zip(samples.as_chunks().0) {
        let [bytes @ .., _] = (u32::from(first & 0xfff) | u32::from(second & 0xfff) << 12).to_le_bytes();
        *triple = bytes;
    }
}

fn unpack_pairs(packed: &[u8], samples: &mut [u16]) {
    for (&[low, middle, high], pair) in packed.as_chunks().0.iter().zip(samples.as_chunks_mut().0) {
        *pair = [u16::from_le_bytes([low, middle]) & 0xfff, u16::from_le_bytes([middle, high]) >> 4];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec;
    use proptest::prelude::*;

    #[test]
    fn the_first_sample_has_the_low_bits() {
        let mut packed = Vec::new();
        pack(&[0x123, 0xabc, 0xfff, 0x000], &mut packed);
        assert_eq!(packed, [0x23, 0xc1, 0xab, 0xff, 0x0f, 0x00]);
        let mut samples = [0; 4];
        unpack(&packed, &mut samples);
        assert_eq!(samples, [0x123, 0xabc, 0xfff, 0x000]);
    }

    /// Bit number `bit` of the wire, counted from the lowest bit of the first byte.
    fn bit(packed: &[u8], bit: usize) -> u16 {
        u16::from(packed[bit / 8] >> (bit % 8) & 1)
    }

    proptest! {
        /// Enough samples to fill vectors, with some left over, at any alignment.
        #[test]
        fn every_bit_has_its_place_whatever_the_length(
            pairs in prop::collection::vec(any::<[u16; 2]>(), 0..80),
            before in 0_usize..9,
        ) {
            let samples = pairs.as_flattened();
            let mut packed = vec![0xaa; before];
            pack(samples, &mut packed);
            prop_assert_eq!(&packed[..before], &vec![0xaa; before]);
            let packed = &packed[before..];
            prop_assert_eq!(packed.len(), packed_length(samples.len()));
            for (index, sample) in samples.iter().enumerate() {
                for place in 0..12 {
                    prop_assert_eq!(bit(packed, 12 * index + place), sample >> place & 1);
                }
            }
            let mut unpacked = vec![0xffff; samples.len() + before];
            unpack(packed, &mut unpacked[before..]);
            let expected = [vec![0xffff; before], samples.iter().map(|sample| sample & 0xfff).collect()].concat();
            prop_assert_eq!(unpacked, expected);
        }
    }
}
