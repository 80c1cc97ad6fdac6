//! A Bayer frame: samples as they come from the sensor, row by row.

use crate::{Geometry, Phase};

/// Bits of one sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum BitDepth {
    /// 8 bits, 0 to 255.
    Eight,
    /// 10 bits, 0 to 1023.
    Ten,
    /// 12 bits, 0 to 4095: the paper's system.
    #[default]
    Twelve,
}

impl BitDepth {
    /// All depths, from the smallest.
    pub const ALL: [Self; 3] = [Self::Eight, Self::Ten, Self::Twelve];

    /// The number of bits: 8, 10 or 12.
    #[must_use]
    pub const fn bits(self) -> u32 {
        match self {
            Self::Eight => 8,
            Self::Ten => 10,
            Self::Twelve => 12,
        }
    }

    /// The depth of `bits` bits, if the datapath has it.
    #[must_use]
    pub fn from_bits(bits: u32) -> Option<Self> {
        Self::ALL.into_iter().find(|depth| depth.bits() == bits)
    }

    /// The largest sample, 2^bits − 1.
    #[must_use]
    pub const fn max(self) -> u16 {
        (1 << self.bits()) - 1
    }
}

/// The bits that are set in any of `samples`: at most a depth's largest sample if and only if every sample is. Inlined, so that
/// it is vectorised for whatever its caller is compiled for.
#[inline(always)]
pub(crate) fn bits_of(samples: &[u16]) -> u16 {
    samples.iter().fold(0, |bits, sample| bits | sample)
}

/// A frame of raw samples, one colour each, row after row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame {
    width: usize,
    depth: BitDepth,
    phase: Phase,
    samples: Vec<u16>,
}

/// The samples do not make a frame: their number, the size or the depth is wrong.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FrameError {
    /// A frame without samples.
    #[error("a frame needs at least one row and two columns")]
    Empty,
    /// Colours alternate in pairs of columns.
    #[error("the width {0} is odd, and Bayer columns come in pairs; crop or pad one column")]
    OddWidth(usize),
    /// The samples do not fill whole rows.
    #[error("{samples} samples are no whole number of rows of {width}; check the width and the height")]
    Ragged {
        /// Samples given.
        samples: usize,
        /// Samples in a row.
        width: usize,
    },
    /// A sample that the depth cannot hold.
    #[error(
        "the sample at row {row}, column {column} is {value}, above {max}, the largest of {bits} bits; \
         give the depth that the samples were taken with"
    )]
    TooBright {
        /// Its row.
        row: usize,
        /// Its column.
        column: usize,
        /// The sample.
        value: u16,
        /// 2^bits − 1.
        max: u16,
        /// The depth.
        bits: u32,
    },
}

impl FrameError {
    /// Refuses a width that no frame has.
    ///
    /// # Errors
    /// [`FrameError::Empty`] for 0, [`FrameError::OddWidth`] for an odd one.
    pub fn check_width(width: usize) -> Result<(), Self> {
        match width {
            0 => Err(Self::Empty),
            _ if width % 2 == 1 => Err(Self::OddWidth(width)),
            _ => Ok(()),
        }
    }

    /// Refuses `samples`, in rows of `width`, for the first one that `depth` cannot hold.
    pub(crate) fn check(width: usize, depth: BitDepth, samples: &[u16]) -> Result<(), Self> {
        samples.chunks(width).enumerate().try_for_each(|(row, samples)| Self::check_row(row, depth, samples))
    }

    /// Refuses `samples`, those of row `row`, for the first one that `depth` cannot hold.
    ///
    /// # Errors
    /// [`FrameError::TooBright`] for that sample.
    pub fn check_row(row: usize, depth: BitDepth, samples: &[u16]) -> Result<(), Self> {
        let max = depth.max();
        // The check is vectorised. Only a row that is refused is searched sample by sample.
        if bits_of(samples) <= max {
            return Ok(());
        }
        let bright = samples.iter().enumerate().find(|&(_, &sample)| sample > max);
        bright.map_or(Ok(()), |(column, &value)| {
            Err(Self::TooBright { row, column, value, max, bits: depth.bits() })
        })
    }
}

impl Frame {
    /// A frame of `samples`, row after row, each row `width` samples.
    ///
    /// # Errors
    /// [`FrameError`] when the width is odd or zero, rows are incomplete, or a sample exceeds `depth`. The limits of the
    /// datapath (64 ≤ W ≤ 2592, H ≤ 2048) are checked by the geometry.
    pub fn new(width: usize, depth: BitDepth, phase: Phase, samples: Vec<u16>) -> Result<Self, FrameError> {
        if samples.is_empty() {
            return Err(FrameError::Empty);
        }
        FrameError::check_width(width)?;
        if !samples.len().is_multiple_of(width) {
            return Err(FrameError::Ragged { samples: samples.len(), width });
        }
        FrameError::check(width, depth, &samples)?;
        Ok(Self { width, depth, phase, samples })
    }

    /// A frame of the same size, depth and phase, with samples that are known to fit.
    pub(crate) fn with_samples(&self, samples: Vec<u16>) -> Self {
        assert_eq!(samples.len(), self.samples.len());
        Self { samples, ..*self }
    }

    /// A frame of `geometry`, with samples that are known to fit.
    pub(crate) fn of_geometry(geometry: &Geometry, phase: Phase, samples: Vec<u16>) -> Self {
        assert_eq!(samples.len(), geometry.width() * geometry.height());
        Self { width: geometry.width(), depth: geometry.depth(), phase, samples }
    }

    /// Columns.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.samples.len() / self.width
    }

    /// Bits of a sample.
    #[must_use]
    pub fn depth(&self) -> BitDepth {
        self.depth
    }

    /// The arrangement of the colours.
    #[must_use]
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// All samples, row after row.
    #[must_use]
    pub fn samples(&self) -> &[u16] {
        &self.samples
    }

    /// Consumes the frame and returns all its samples, row after row, without copying.
    #[must_use]
    pub fn into_samples(self) -> Vec<u16> {
        self.samples
    }

    /// The samples of row `index`.
    ///
    /// # Panics
    /// When `index` is not below [`Self::height`].
    #[must_use]
    pub fn row(&self, index: usize) -> &[u16] {
        &self.samples[index * self.width..][..self.width]
    }

    /// The rows from the top.
    pub fn rows(&self) -> std::slice::ChunksExact<'_, u16> {
        self.samples.chunks_exact(self.width)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_frame_is_refused_with_its_place() {
        let new = |width, samples: &[u16]| Frame::new(width, BitDepth::Eight, Phase::Grbg, samples.to_vec());
        assert_eq!(new(0, &[1, 2]), Err(FrameError::Empty));
        assert_eq!(new(2, &[]), Err(FrameError::Empty));
        assert_eq!(new(3, &[1, 2, 3]), Err(FrameError::OddWidth(3)));
        assert_eq!(new(2, &[1, 2, 3]), Err(FrameError::Ragged { samples: 3, width: 2 }));
        let too_bright = FrameError::TooBright { row: 1, column: 0, value: 256, max: 255, bits: 8 };
        assert_eq!(new(2, &[1, 255, 256, 0]), Err(too_bright));
        let frame = new(2, &[1, 2, 3, 255]).unwrap();
        assert_eq!((frame.height(), frame.row(1)), (2, &[3, 255][..]));
    }
}
