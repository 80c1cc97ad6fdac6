//! The bytes of the link test.

use rand_core::Rng;
use rand_pcg::Pcg64Mcg;

use halfrow_protocol::MAX_PAYLOAD;

/// Payloads that a poor link or packet buffer is likely to damage: every byte value, runs with and without zeros around the
/// stuffing's block of 254, alternating bits over two such blocks, and random bytes up to the longest packet. The header in front
/// of a payload ends in zeros, so a payload begins a block, and a zero behind 254 or 508 bytes follows a full one.
pub(crate) fn patterns(seed: u64) -> Vec<Vec<u8>> {
    let mut random = Pcg64Mcg::new(u128::from(seed) | 1 << 64);
    let mut noise = |length| {
        let mut bytes = vec![0; length];
        random.fill_bytes(&mut bytes);
        bytes
    };
    vec![
        (0..=255).collect(),
        vec![0; 512],
        vec![0xff; 253],
        [&[0xff; 254][..], &[0, 1]].concat(),
        vec![0xff; 255],
        [&[0x55, 0xaa].repeat(254)[..], &[0, 1, 0x55, 0xaa]].concat(),
        noise(1),
        noise(510),
        noise(511),
        noise(MAX_PAYLOAD),
    ]
}
