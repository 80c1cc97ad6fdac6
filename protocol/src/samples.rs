//! Samples on the wire: always 12 bits, two samples in three bytes, the low bits first.

use alloc::vec::Vec;

/// Bytes that `samples` samples take; `samples` is even.
#[must_use]
pub const fn packed_length(samples: usize) -> usize {
    samples / 2 * 3
}

/// Appends `samples`, an even number of them, to `packed`. Bits above the twelfth are left out.
pub fn pack(samples: &[u16], packed: &mut Vec<u8>) {
    packed.extend(samples.as_chunks::<2>().0.iter().flat_map(|&[first, second]| {
        let [low, middle, high, _] =
            (u32::from(first & 0xfff) | u32::from(second & 0xfff) << 12).to_le_bytes();
        [low, middle, high]
    }));
}

/// Unpacks as many samples as both sides hold, pair by pair.
pub fn unpack(packed: &[u8], samples: &mut [u16]) {
    let triples = packed.as_chunks::<3>().0;
    for (&[low, middle, high], pair) in triples.iter().zip(samples.as_chunks_mut::<2>().0) {
        *pair = [u16::from_le_bytes([low, middle & 0x0f]), u16::from(middle >> 4) | u16::from(high) << 4];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_sample_has_the_low_bits() {
        let mut packed = Vec::new();
        pack(&[0x123, 0xabc, 0xfff, 0x000], &mut packed);
        assert_eq!(packed, [0x23, 0xc1, 0xab, 0xff, 0x0f, 0x00]);
        let mut samples = [0; 4];
        unpack(&packed, &mut samples);
        assert_eq!(samples, [0x123, 0xabc, 0xfff, 0x000]);
    }
}
