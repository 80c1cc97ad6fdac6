//! The content that a board makes from a seed, and how it signs what leaves (AT-SPEED.md, "Content" and "Signature"). Written
//! for clarity, since boards are judged by it.

use crate::BitDepth;

/// What determines the samples of a burst's frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Content {
    /// The burst's seed.
    pub seed: u32,
    /// The frame's number.
    pub frame: u16,
}

/// A kind of content. A row keeps it from its first sample to its last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Noise,
    Swing,
    /// Columns in groups of 2^p, alternately high and low; `high` says whether the first group is high.
    Toggle {
        p: u32,
        high: bool,
    },
    Steps,
}

/// A row before its first sample: its kind, and the draw d that decided it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RowStart {
    pub(crate) kind: Kind,
    pub(crate) x: u32,
}

impl Content {
    /// The state before row `row`, below 4096: its draw d comes after this.
    pub(crate) fn state(self, row: usize) -> u32 {
        (self.seed ^ (u32::from(self.frame) << 12 | row as u32)) | 1 << 31
    }

    /// The kind and the first draw of row `row`, below 4096.
    pub(crate) fn start(self, row: usize) -> RowStart {
        let d = xorshift32(self.state(row));
        let kind = match d % 4 {
            0 => Kind::Noise,
            1 => Kind::Swing,
            2 => Kind::Toggle { p: d >> 2 & 3, high: d >> 4 & 1 == 1 },
            _ => Kind::Steps,
        };
        RowStart { kind, x: d }
    }

    /// Fills `samples` with those of row `row`, below 4096, with the depth `depth`.
    pub fn row(self, row: usize, depth: BitDepth, samples: &mut [u16]) {
        let RowStart { kind, mut x } = self.start(row);
        let mut held = 0;
        for (column, sample) in samples.iter_mut().enumerate() {
            x = xorshift32(x);
            let level = (x >> 20) as u16 & depth.max();
            *sample = match kind {
                Kind::Noise => level,
                Kind::Swing => full(x >= 1 << 31, depth),
                Kind::Toggle { p, high } => full((column >> p) % 2 != usize::from(high), depth),
                Kind::Steps if column == 0 || x.is_multiple_of(16) => level,
                Kind::Steps => held,
            };
            held = *sample;
        }
    }
}

/// The largest sample, or 0.
pub(crate) fn full(high: bool, depth: BitDepth) -> u16 {
    if high { depth.max() } else { 0 }
}

/// The generator's next draw after `x` (WIRE.md, section 5), which is 0 for 0 alone.
#[must_use]
#[inline]
pub fn xorshift32(mut x: u32) -> u32 {
    x ^= x << 13;
    x ^= x >> 17;
    x ^ x << 5
}

/// The signature of a row: the CRC-32 of its samples, words of 16 bits, little endian.
#[must_use]
pub fn row_signature(samples: &[u16]) -> u32 {
    let words: Vec<_> = samples.iter().map(|sample| sample.to_le_bytes()).collect();
    crc32fast::hash(words.as_flattened())
}

/// The signature of a frame: the CRC-32 of its rows' signatures from the top, words of 32 bits, little endian.
#[must_use]
pub fn frame_signature(rows: &[u32]) -> u32 {
    let mut crc = crc32fast::Hasher::new();
    rows.iter().for_each(|row| crc.update(&row.to_le_bytes()));
    crc.finalize()
}
