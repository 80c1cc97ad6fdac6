//! Files in which a frame's rows follow one another uncompressed, and so can be read row by row.

use halfrow_model::{BitDepth, Frame, FrameError};

use super::{DecodeError, RawLayout, ReadOptions, narrow, size};

/// Where a frame's rows are in a file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Raster {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Bytes before the first row.
    pub(super) start: usize,
    pub(super) lines: Lines,
}

/// How the samples of a row are laid out in bytes.
#[derive(Clone, Copy, Debug)]
pub(super) enum Lines {
    /// One byte per sample up to a maxval of 255, otherwise two, the high one first.
    Pgm {
        maxval: u16,
    },
    Raw(RawLayout),
}

impl Raster {
    /// Bytes of a row.
    pub(super) fn line_bytes(&self) -> usize {
        match self.lines {
            Lines::Pgm { maxval } if maxval <= u16::from(u8::MAX) => self.width,
            Lines::Pgm { .. } => 2 * self.width,
            Lines::Raw(layout) => layout.line_bytes(self.width),
        }
    }

    /// Checks that a file of `length` bytes ends with the last row.
    ///
    /// # Errors
    /// [`DecodeError`] when it does not.
    pub(super) fn check_length(&self, length: usize) -> Result<(), DecodeError> {
        let samples = self.line_bytes() * self.height;
        match size::exact(length.saturating_sub(self.start), samples) {
            Err(DecodeError::Trailing { extra, .. })
                if matches!(self.lines, Lines::Raw(_)) && extra < samples && extra % self.height == 0 =>
            {
                Err(DecodeError::Trailing { extra, padding: Some(extra / self.height) })
            }
            checked => checked,
        }
    }

    /// The largest sample that the file can hold.
    pub(super) fn full(&self) -> u16 {
        match self.lines {
            Lines::Pgm { maxval } => maxval,
            Lines::Raw(layout) => u16::MAX >> (u16::BITS - layout.bits()),
        }
    }

    /// Unpacks the bytes of row `index` into `samples`.
    ///
    /// # Errors
    /// [`DecodeError`] when a sample exceeds the header's maxval or `depth`.
    pub(super) fn unpack(
        &self,
        index: usize,
        line: &[u8],
        depth: BitDepth,
        samples: &mut [u16],
    ) -> Result<(), DecodeError> {
        let (row, max) = (index, depth.max());
        let maxval = match self.lines {
            Lines::Pgm { maxval } => {
                unpack_pgm(line, samples);
                maxval
            }
            Lines::Raw(layout) => {
                layout.unpack(line, samples);
                u16::MAX
            }
        };
        match above(samples, max.min(maxval)) {
            None => Ok(()),
            Some((column, value)) if value > maxval => {
                Err(DecodeError::AboveMaxval { row, column, value, maxval })
            }
            Some((column, value)) => {
                Err(FrameError::TooBright { row, column, value, max, bits: depth.bits() }.into())
            }
        }
    }

    /// The frame in `bytes`, which are a whole file.
    ///
    /// # Errors
    /// [`DecodeError`] when the length is not exactly that of the rows, or a sample is too large.
    pub(super) fn decode(&self, bytes: &[u8], how: &ReadOptions) -> Result<Frame, DecodeError> {
        self.check_length(bytes.len())?;
        narrow::note(self.full(), how.depth);
        let mut samples = vec![0; self.width * self.height];
        if samples.is_empty() {
            return Err(FrameError::Empty.into());
        }
        let lines = bytes[self.start..].chunks_exact(self.line_bytes());
        for ((index, row), line) in samples.chunks_exact_mut(self.width).enumerate().zip(lines) {
            self.unpack(index, line, how.depth, row)?;
        }
        Ok(Frame::new(self.width, how.depth, how.phase, samples)?)
    }
}

fn unpack_pgm(line: &[u8], row: &mut [u16]) {
    if line.len() == row.len() {
        RawLayout::U8.unpack(line, row);
    } else {
        let pairs = line.as_chunks().0;
        row.iter_mut().zip(pairs).for_each(|(sample, &pair)| *sample = u16::from_be_bytes(pair));
    }
}

/// The column and value of the first sample above `max`, if there is one.
fn above(row: &[u16], max: u16) -> Option<(usize, u16)> {
    // No sample is greater than the OR of all, which is quick to compute and almost always decides.
    if row.iter().fold(0, |bits, &sample| bits | sample) <= max {
        return None;
    }
    row.iter().copied().enumerate().find(|&(_, sample)| sample > max)
}
