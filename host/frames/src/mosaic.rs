//! From the pixels of a picture to the samples of a Bayer frame.

use halfrow_model::{BitDepth, Colour, Frame, FrameError, Phase};

use image::{DynamicImage, ImageBuffer};

use super::preview::RgbImage;
use super::{DecodeError, Decoded, Fitting, Orientation, ReadOptions, narrow};

/// A decoded picture: `channels` interleaved samples per pixel, row after row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Picture {
    /// Pixels in a row.
    pub(super) width: usize,
    /// 1: grey; 2: grey and alpha; 3: red, green and blue; 4: red, green, blue and alpha.
    pub(super) channels: usize,
    /// The sample of full brightness: 255 or 65535.
    pub(super) full: u16,
    /// The samples.
    pub(super) samples: Vec<u16>,
    /// How a viewer must turn it.
    pub(super) orientation: Orientation,
}

impl Picture {
    /// A picture in colour turned upright, by its orientation. Raw samples stay as they are.
    pub(super) fn turned(self) -> Self {
        let Self { width, channels, orientation, .. } = self;
        if channels < 3 || orientation == Orientation::default() {
            return self;
        }
        let side = |length| u32::try_from(length).unwrap_or(u32::MAX);
        let (columns, rows) = (side(width), side(self.samples.len() / (channels * width.max(1))));
        let (full, samples) = (self.full, self.samples);
        let mut image = if channels == 3 {
            DynamicImage::ImageRgb16(ImageBuffer::from_raw(columns, rows, samples).unwrap_or_default())
        } else {
            DynamicImage::ImageRgba16(ImageBuffer::from_raw(columns, rows, samples).unwrap_or_default())
        };
        image.apply_orientation(orientation.turn());
        let width = image.width() as usize;
        let samples = match image {
            DynamicImage::ImageRgb16(image) => image.into_raw(),
            DynamicImage::ImageRgba16(image) => image.into_raw(),
            _ => Vec::new(),
        };
        Self { width, channels, full, samples, orientation: Orientation::default() }
    }

    /// The frame that the picture represents. Grey is taken as a raw Bayer frame. A picture in colour may be fitted; each sample
    /// keeps the colour of its place, scaled to the depth by [`scaled`], without gamma. Alpha is ignored.
    ///
    /// # Errors
    /// [`DecodeError`] when the samples are not a frame of `how.depth`, or colour does not have the size that `how` asks for.
    pub(super) fn into_frame(self, how: &ReadOptions) -> Result<Decoded, DecodeError> {
        let Self { width, channels, full, samples, orientation } = self;
        if channels < 3 {
            narrow::note(full, how.depth);
            let samples = if channels == 1 { samples } else { samples.into_iter().step_by(2).collect() };
            let frame = Frame::new(width, how.depth, how.phase, samples)?;
            return Ok(Decoded { camera: orientation.into(), ..frame.into() });
        }
        let height = samples.len() / (channels * width.max(1));
        let fitting = how.size.fitting((width, height))?;
        let (width, channels, samples) = match fitting {
            None => (width, channels, samples),
            Some(fitting) => fitted(&fitting, (width, height), channels, &samples, full),
        };
        let mosaic = mosaicked(&samples, channels, width.max(1), how.phase);
        let samples = mosaic.map(|sample| scaled(sample, full, how.depth)).collect();
        let frame = Frame::new(width, how.depth, how.phase, samples)?;
        Ok(Decoded { fitting, ..frame.into() })
    }

    /// Red, green and blue, unchanged; none if the picture is grey or has more than 8 bits.
    pub(super) fn into_rgb(self) -> Option<RgbImage> {
        let Self { width, channels, full, samples, .. } = self;
        if channels < 3 || full > u8::MAX.into() {
            return None;
        }
        let height = samples.len() / (channels * width.max(1));
        let colours = samples.chunks_exact(channels).flat_map(|pixel| &pixel[..3]);
        let data = colours.map(|&sample| u8::try_from(sample).unwrap_or(u8::MAX)).collect();
        Some(RgbImage { width, height, data })
    }
}

/// The raw frame of 8 bits that a filter array of `phase` leaves of `image`.
///
/// # Errors
/// [`FrameError`] when the width is odd or there are no pixels.
pub fn mosaic(image: &RgbImage, phase: Phase) -> Result<Frame, FrameError> {
    of_rgb(image, &ReadOptions { depth: BitDepth::Eight, phase, ..ReadOptions::default() })
}

/// The frame of `how.depth` that a filter array of `how.phase` leaves of `image`.
///
/// # Errors
/// Like [`mosaic`].
pub(super) fn of_rgb(image: &RgbImage, how: &ReadOptions) -> Result<Frame, FrameError> {
    let mosaic = mosaicked(&image.data, 3, image.width.max(1), how.phase);
    let samples = mosaic.map(|sample| scaled(sample, u8::MAX.into(), how.depth)).collect();
    Frame::new(image.width, how.depth, how.phase, samples)
}

/// The colours of a picture of `size`, with samples up to `full`, fitted: the new width, channels and samples.
fn fitted(
    fitting: &Fitting,
    size: (usize, usize),
    channels: usize,
    samples: &[u16],
    full: u16,
) -> (usize, usize, Vec<u16>) {
    let side = |length| u32::try_from(length).unwrap_or(u32::MAX);
    let colours = samples.chunks_exact(channels).flat_map(|pixel| &pixel[..3]).copied().collect();
    let image = ImageBuffer::from_raw(side(size.0), side(size.1), colours).unwrap_or_default();
    let fitted = fitting.apply(&image);
    // Catmull-Rom overshoots at edges, limited only to the range of `u16`.
    let within = |sample: u16| sample.min(full);
    (fitted.width() as usize, 3, fitted.into_raw().into_iter().map(within).collect())
}

/// The sample of each place's own colour, from three or more channels per pixel.
fn mosaicked<Sample: Copy + Into<u16>>(
    samples: &[Sample],
    channels: usize,
    width: usize,
    phase: Phase,
) -> impl Iterator<Item = u16> {
    samples
        .chunks_exact(channels)
        .enumerate()
        .map(move |(place, pixel)| pixel[channel(phase, place / width, place % width)].into())
}

/// The index of green in a pixel.
pub(super) const GREEN: usize = 1;

/// The index of a place's colour in a pixel of red, green and blue.
pub(super) fn channel(phase: Phase, row: usize, column: usize) -> usize {
    match phase.colour(row, column) {
        Colour::Red => 0,
        Colour::Green => GREEN,
        Colour::Blue => 2,
    }
}

/// `sample · (2^B − 1) / full`, rounded half up.
#[must_use]
fn scaled(sample: u16, full: u16, depth: BitDepth) -> u16 {
    let full = u32::from(full.max(1));
    let product = u32::from(sample) * u32::from(depth.max());
    u16::try_from((product + full / 2) / full).unwrap_or(u16::MAX)
}
