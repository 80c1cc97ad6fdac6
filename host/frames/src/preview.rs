//! Looking at frames: a simple development of raw samples into a picture for the screen.

use std::io::Write;

use halfrow_model::{Colour, Frame};
use png::{BitDepth, ColorType, EncodingError};

/// A picture of 8 bits in red, green and blue, coded for the screen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RgbImage {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Red, green and blue of each pixel, row after row: 3 · width · height bytes.
    pub data: Vec<u8>,
}

/// The frame as a picture: each missing colour is the mean of its neighbours of that colour (bilinear), and linear light
/// is coded as sRGB. Neither black level nor white balance is touched.
#[must_use]
pub fn demosaic(frame: &Frame) -> RgbImage {
    thumbnail(frame, frame.width())
}

/// [`demosaic`] of samples that are coded for the screen already, as those of a photograph are: brought to 8 bits, rounded half
/// up, and no more.
#[must_use]
pub fn demosaic_coded(frame: &Frame) -> RgbImage {
    let (width, height) = (frame.width(), frame.height());
    let full = u32::from(frame.depth().max());
    let places = (0..height).flat_map(|row| (0..width).map(move |column| (row, column)));
    let data = places
        .flat_map(|(row, column)| pixel(frame, row, column))
        .map(|sample| u8::try_from((u32::from(sample) * 255 + full / 2) / full).unwrap_or(u8::MAX))
        .collect();
    RgbImage { width, height, data }
}

/// [`demosaic`], at most `max_width` pixels wide: squares of pixels become their mean, taken in linear light.
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
            for column in 0..frame.width() {
                let place = column / side * 3;
                for (mean, sample) in line[place..].iter_mut().zip(pixel(frame, row, column)) {
                    mean.add(sample);
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
/// The encoder's, or whatever `out` answers.
pub fn encode_png_rgb(image: &RgbImage, out: &mut impl Write) -> Result<(), EncodingError> {
    super::png::write(out, (image.width, image.height), (ColorType::Rgb, BitDepth::Eight), &image.data)
}

/// Writes a PNG of `width` x `height` grey pixels of one byte.
///
/// # Errors
/// The encoder's, when `data` has another length among them, or whatever `out` answers.
pub fn encode_png_grey(
    width: usize,
    height: usize,
    data: &[u8],
    out: &mut impl Write,
) -> Result<(), EncodingError> {
    super::png::write(out, (width, height), (ColorType::Grayscale, BitDepth::Eight), data)
}

/// Red, green and blue at `row` and `column`: the sample itself for its own colour, and for the others the mean of those
/// of its eight neighbours that have the colour.
fn pixel(frame: &Frame, row: usize, column: usize) -> [u16; 3] {
    let channel = |row, column| match frame.phase().colour(row, column) {
        Colour::Red => 0,
        Colour::Green => 1,
        Colour::Blue => 2,
    };
    let mut means = [Mean::default(); 3];
    let first = column.saturating_sub(1);
    for y in row.saturating_sub(1)..=(row + 1).min(frame.height() - 1) {
        for (x, &sample) in frame.row(y).iter().enumerate().skip(first).take(column + 2 - first) {
            means[channel(y, x)].add(sample);
        }
    }
    let own = channel(row, column);
    means[own] = Mean { sum: frame.row(row)[column].into(), count: 1 };
    means.map(Mean::rounded)
}

/// A mean of samples.
#[derive(Clone, Copy, Default)]
struct Mean {
    sum: u32,
    count: u32,
}

impl Mean {
    fn add(&mut self, sample: u16) {
        self.sum += u32::from(sample);
        self.count += 1;
    }

    /// The mean, rounded half up; 0 of nothing.
    fn rounded(self) -> u16 {
        u16::try_from((self.sum + self.count / 2) / self.count.max(1)).unwrap_or(u16::MAX)
    }
}

/// The bytes of all samples on a screen.
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
