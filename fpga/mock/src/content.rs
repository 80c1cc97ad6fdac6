//! The samples that a board makes on its own: `fpga/AT-SPEED.md`, *Content*.

use crate::depth::Depth;
use crate::gaps::draw;

/// The content id that AT-SPEED.md defines.
pub(crate) const CONTENT: u16 = 1;

/// Fills `samples` with those of a row, each of `depth` bits.
pub(crate) fn fill(samples: &mut [u16], depth: Depth, seed: u32, frame: u16, row: u16) {
    let first = draw((seed ^ ((u32::from(frame) << 12) + u32::from(row))) | 1 << 31);
    let max = depth.largest();
    let level = |x: u32| (x >> 20) as u16 & max;
    let mut x = first;
    let mut next = || {
        x = draw(x);
        x
    };
    match first & 3 {
        0 => samples.fill_with(|| level(next())),
        1 => samples.fill_with(|| if next() >= 1 << 31 { max } else { 0 }),
        2 => {
            let (pixels, phase) = (first >> 2 & 3, first >> 4 & 1);
            for (sample, column) in samples.iter_mut().zip(0_u32..) {
                *sample = if ((column >> pixels) + phase) & 1 == 1 { max } else { 0 };
            }
        }
        _ => {
            let mut held = None;
            for sample in samples {
                let x = next();
                let new = held.filter(|_| x & 15 != 0).unwrap_or(level(x));
                (*sample, held) = (new, Some(new));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(width: usize, depth: Depth, seed: u32, frame: u16, row: u16) -> Vec<u16> {
        let mut samples = vec![0; width];
        fill(&mut samples, depth, seed, frame, row);
        samples
    }

    fn crc(samples: impl IntoIterator<Item = u16>) -> u32 {
        crc32fast::hash(&samples.into_iter().flat_map(u16::to_le_bytes).collect::<Vec<_>>())
    }

    /// The rows of AT-SPEED.md, computed outside the project: seed 1, frame 0, 64 columns, 12 bits.
    #[test]
    fn each_kind_of_row_is_that_of_the_page() {
        let rows: [([u16; 12], u32); 4] = [
            ([4095, 0, 4095, 4095, 0, 4095, 4095, 0, 0, 0, 4095, 0], 0x3f30_8f73),
            ([2192, 2729, 3419, 1675, 316, 2892, 2077, 1755, 4021, 3317, 2157, 4039], 0x1470_85ad),
            ([2128, 2128, 2128, 2128, 2128, 2128, 2128, 2128, 64, 64, 64, 64], 0x4de3_0b33),
            ([0, 4095, 0, 4095, 0, 4095, 0, 4095, 0, 4095, 0, 4095], 0x4f53_a7e2),
        ];
        for (number, (first, expected)) in (0..).zip(rows) {
            let samples = row(64, Depth::Twelve, 1, 0, number);
            assert_eq!(
                (&samples[..12], crc(samples.iter().copied())),
                (&first[..], expected),
                "row {number}"
            );
        }
    }

    /// The frames of AT-SPEED.md.
    #[test]
    fn frames_have_the_content_of_the_page() {
        let frames = [
            (u32::MAX, u16::MAX, 64, 16, Depth::Ten, 0xa1de_c90f),
            (0x1234_5678, 1, 66, 33, Depth::Eight, 0x9705_d11d),
            (1, 0, 1920, 1080, Depth::Twelve, 0x406e_3c55),
        ];
        for (seed, frame, width, height, depth, expected) in frames {
            let rows = (0..height).flat_map(|number| row(width, depth, seed, frame, number));
            assert_eq!(crc(rows), expected, "seed {seed}");
        }
    }
}
