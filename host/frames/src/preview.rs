//! Viewing frames: a simple development of raw samples into a picture for the screen.

use std::io::Write;

use halfrow_model::{Frame, Phase};
use image::{DynamicImage, ImageBuffer};
use png::{BitDepth, ColorType, EncodingError};

use crate::mosaic::{GREEN, channel};
use crate::{DecodeError, Orientation, size};

/// A picture of 8 bits in red, green and blue, coded for the screen. [`Self::new`] checks the length of its data.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RgbImage {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Red, green and blue of each pixel, row after row: 3 · width · height bytes.
    pub data: Vec<u8>,
}

impl RgbImage {
    /// The picture with the pixels `data`, which must have exactly its length.
    ///
    /// # Errors
    /// [`DecodeError::Empty`] without a pixel, [`DecodeError::TooLarge`] when a side is above [`crate::MAX_SIDE`], or
    /// [`DecodeError::Truncated`] or [`DecodeError::Trailing`] when there are not 3 · width · height bytes.
    pub fn new(width: usize, height: usize, data: Vec<u8>) -> Result<Self, DecodeError> {
        if width == 0 || height == 0 {
            return Err(DecodeError::Empty);
        }
        size::checked(width as u64, height as u64)?;
        size::exact(data.len(), 3 * width * height)?;
        Ok(Self { width, height, data })
    }

    /// The picture of raw samples turned upright, by their orientation.
    #[must_use]
    pub fn turned(self, orientation: Orientation) -> Self {
        if orientation == Orientation::default() {
            return self;
        }
        let side = |length| u32::try_from(length).unwrap_or(u32::MAX);
        let pixels = ImageBuffer::from_raw(side(self.width), side(self.height), self.data);
        let mut image = DynamicImage::ImageRgb8(pixels.unwrap_or_default());
        image.apply_orientation(orientation.turn());
        Self {
            width: image.width() as usize,
            height: image.height() as usize,
            data: image.into_rgb8().into_raw(),
        }
    }
}

/// The frame as a picture: each missing colour is the mean of the neighbours of that colour (bilinear), and linear light
/// is coded as sRGB. Neither black level nor white balance is applied.
#[must_use]
pub fn demosaic(frame: &Frame) -> RgbImage {
    thumbnail(frame, frame.width())
}

/// Like [`demosaic`], for samples that are already coded for the screen, as those of a photograph are: they are only brought to
/// 8 bits, rounded half up.
#[must_use]
pub fn demosaic_coded(frame: &Frame) -> RgbImage {
    let full = u32::from(frame.depth().max());
    let data = (0..frame.height())
        .flat_map(|row| pixels(frame, row))
        .flatten()
        .map(|sample| u8::try_from((u32::from(sample) * 255 + full / 2) / full).unwrap_or(u8::MAX))
        .collect();
    RgbImage { width: frame.width(), height: frame.height(), data }
}

/// Like [`demosaic`], at most `max_width` pixels wide: each square of pixels becomes its mean, taken in linear light.
#[must_use]
pub fn thumbnail(frame: &Frame, max_width: usize) -> RgbImage {
    let side = frame.width().div_ceil(max_width.max(1));
    let (width, height) = (frame.width().div_ceil(side), frame.height().div_ceil(side));
    let code = Srgb::new(frame.depth().max());
    let mut data = Vec::with_capacity(3 * width * height);
    let mut line = vec![Mean::default(); 3 * width];
    for top in (0..frame.height()).step_by(side) {
        line.fill(Mean::default());
        for row in top..(top + side).min(frame.height()) {
            for (means, square) in line.chunks_exact_mut(3).zip(pixels(frame, row).chunks(side)) {
                for pixel in square {
                    means.iter_mut().zip(pixel).for_each(|(mean, &sample)| mean.add(sample));
                }
            }
        }
        data.extend(line.iter().map(|mean| code.byte(mean.rounded())));
    }
    RgbImage { width, height, data }
}

/// Writes `image` as a PNG.
///
/// # Errors
/// Those of the encoder, also when the data has another length, and those of `out`.
pub fn encode_png_rgb(image: &RgbImage, out: &mut impl Write) -> Result<(), EncodingError> {
    super::png::write(out, (image.width, image.height), (ColorType::Rgb, BitDepth::Eight), &image.data)
}

/// Red, green and blue of all places in `row`.
fn pixels(frame: &Frame, row: usize) -> Vec<[u16; 3]> {
    let last = frame.width() - 1;
    let edge = |column| pixel(frame, row, column);
    if row == 0 || row == frame.height() - 1 {
        return (0..=last).map(edge).collect();
    }
    let mut pixels = vec![[0; 3]; frame.width()];
    for first in [1, 2] {
        let site = Site::at(frame.phase(), row, first);
        let [above, here, below] =
            [row - 1, row, row + 1].map(|row| frame.row(row)[first - 1..].windows(3).step_by(2));
        let around = above.zip(here).zip(below);
        for (pixel, around) in pixels[first..].iter_mut().step_by(2).zip(around) {
            *pixel = site.pixel(around);
        }
    }
    for column in [0, last] {
        pixels[column] = edge(column);
    }
    pixels
}

/// [`pixel`] for places with all eight neighbours. They are most of a frame, so this must be fast.
#[derive(Clone, Copy)]
enum Site {
    /// Green, with the channel `beside` on its left and right and the channel `above` above and below.
    Green { beside: usize, above: usize },
    /// Red or blue, with the channel `corners` at the corners.
    Other { corners: usize },
}

impl Site {
    fn at(phase: Phase, row: usize, column: usize) -> Self {
        match channel(phase, row, column) {
            GREEN => Self::Green {
                beside: channel(phase, row, column + 1),
                above: channel(phase, row + 1, column),
            },
            _ => Self::Other { corners: channel(phase, row + 1, column + 1) },
        }
    }

    /// The pixel in the middle of three samples each of the row above, this row, and the row below.
    fn pixel(self, ((above, here), below): ((&[u16], &[u16]), &[u16])) -> [u16; 3] {
        let sample = |row: &[u16], column: usize| u64::from(row[column]);
        let beside = sample(here, 0) + sample(here, 2);
        let upright = sample(above, 1) + sample(below, 1);
        let mut pixel = [here[1]; 3];
        match self {
            Self::Green { beside: left_and_right, above: up_and_down } => {
                pixel[left_and_right] = Mean { sum: beside, count: 2 }.rounded();
                pixel[up_and_down] = Mean { sum: upright, count: 2 }.rounded();
            }
            Self::Other { corners } => {
                let sum = sample(above, 0) + sample(above, 2) + sample(below, 0) + sample(below, 2);
                pixel[GREEN] = Mean { sum: beside + upright, count: 4 }.rounded();
                pixel[corners] = Mean { sum, count: 4 }.rounded();
            }
        }
        pixel
    }
}

/// Red, green and blue at `row` and `column`: the sample itself for its own colour, and for each other colour the mean of
/// those of its eight neighbours that have it.
fn pixel(frame: &Frame, row: usize, column: usize) -> [u16; 3] {
    let mut means = [Mean::default(); 3];
    let first = column.saturating_sub(1);
    for y in row.saturating_sub(1)..=(row + 1).min(frame.height() - 1) {
        for (x, &sample) in frame.row(y).iter().enumerate().skip(first).take(column + 2 - first) {
            means[channel(frame.phase(), y, x)].add(sample);
        }
    }
    let own = channel(frame.phase(), row, column);
    means[own] = Mean { sum: frame.row(row)[column].into(), count: 1 };
    means.map(Mean::rounded)
}

/// A mean of samples.
#[derive(Clone, Copy, Default)]
struct Mean {
    sum: u64,
    count: u64,
}

impl Mean {
    fn add(&mut self, sample: u16) {
        self.sum += u64::from(sample);
        self.count += 1;
    }

    /// The mean, rounded half up; 0 of nothing.
    fn rounded(self) -> u16 {
        u16::try_from((self.sum + self.count / 2) / self.count.max(1)).unwrap_or(u16::MAX)
    }
}

/// The screen byte of each sample value.
struct Srgb(Vec<u8>);

impl Srgb {
    fn new(max: u16) -> Self {
        Self((0..=max).map(|sample| Self::coded(f64::from(sample) / f64::from(max))).collect())
    }

    /// The transfer function of IEC 61966-2-1.
    fn coded(light: f64) -> u8 {
        let coded = if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 };
        (coded * 255.0 + 0.5) as u8
    }

    fn byte(&self, sample: u16) -> u8 {
        self.0.get(usize::from(sample)).copied().unwrap_or(u8::MAX)
    }
}
