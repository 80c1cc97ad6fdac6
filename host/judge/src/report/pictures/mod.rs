//! Pictures for the page: small frames, and maps and crops of their differences.

mod crop;
mod map;
mod scale;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use halfrow_model::Frame;
use png::EncodingError;

use crate::frames::preview::{self, RgbImage};
use crate::result::MissingRows;

pub(super) use crop::{Window, windows};
pub(super) use map::difference_map;
pub use map::side;
pub use scale::{MISSING, Step, steps_up_to};

/// The width of the narrowest preview that still shows something.
const MIN_WIDTH: usize = 64;

/// A picture as a PNG.
#[derive(Clone, Debug)]
pub(super) struct Picture {
    /// Pixels in a row.
    pub(super) width: usize,
    /// Rows.
    pub(super) height: usize,
    png: Vec<u8>,
}

impl Picture {
    fn new(image: &RgbImage) -> Result<Self, EncodingError> {
        let mut png = Vec::new();
        preview::encode_png_rgb(image, &mut png)?;
        Ok(Self { width: image.width, height: image.height, png })
    }

    /// The length of the PNG in bytes.
    pub(super) fn len(&self) -> usize {
        self.png.len()
    }

    /// The PNG as a `data:` URI, four characters for every three bytes.
    pub(super) fn data_uri(&self) -> String {
        format!("data:image/png;base64,{}", STANDARD.encode(&self.png))
    }
}

/// A PNG of a frame developed for the screen, at most `max_width` columns wide.
///
/// # Errors
/// The PNG encoder's.
pub fn developed(frame: &Frame, max_width: usize) -> Result<Vec<u8>, EncodingError> {
    Ok(Picture::new(&preview::thumbnail(frame, max_width))?.png)
}

/// A PNG that maps where and by how much two frames of one size differ: one pixel for each square of [`side`] by [`side`]
/// samples, in the colours of [`steps_up_to`] the largest difference, or in [`MISSING`] where rows that are `missing` say nothing.
///
/// # Errors
/// The PNG encoder's.
pub fn differences(expected: &Frame, found: &Frame, missing: &MissingRows) -> Result<Vec<u8>, EncodingError> {
    Ok(difference_map(expected, found, missing)?.png)
}

/// The frame as a picture of at most `max_width` columns and `most_bytes` bytes, about as large as that allows; none if not
/// even [`MIN_WIDTH`] columns fit.
///
/// # Errors
/// The PNG encoder's.
pub(super) fn preview(
    frame: &Frame,
    max_width: usize,
    most_bytes: usize,
) -> Result<Option<Picture>, EncodingError> {
    let most = frame.width() / MIN_WIDTH;
    let mut side = frame.width().div_ceil(max_width);
    loop {
        let picture = Picture::new(&preview::thumbnail(frame, frame.width().div_ceil(side)))?;
        if picture.len() <= most_bytes {
            return Ok(Some(picture));
        }
        if side >= most {
            return Ok(None);
        }
        // The bytes fall with the square of the side.
        let excess = picture.len() as f64 / most_bytes.max(1) as f64;
        side = (side + 1).max((side as f64 * excess.sqrt()) as usize).min(most);
    }
}

#[cfg(test)]
mod tests {
    use halfrow_model::{BitDepth, Phase};
    use rand_core::Rng;
    use rand_pcg::Pcg64Mcg;

    use super::*;

    /// Noise whose neighbours cancel out where a pixel is the mean of several: the bytes fall faster than with the square of
    /// the side.
    #[test]
    fn a_preview_is_not_narrower_than_what_still_shows_something() {
        let mut draws = Pcg64Mcg::new(1);
        let four = |_| {
            let drawn = draws.next_u32();
            let [one, other] = [drawn & 4095, drawn >> 16 & 4095].map(|sample| sample as u16);
            [one, other, 4095 - one, 4095 - other]
        };
        let samples = (0..512 * 256 / 4).flat_map(four).collect();
        let frame = Frame::new(512, BitDepth::Twelve, Phase::Grbg, samples).unwrap();
        let narrowest = developed(&frame, 64).unwrap().len();
        let width = |most_bytes| preview(&frame, 512, most_bytes).unwrap().map(|picture| picture.width);
        assert_eq!(width(narrowest), Some(64));
        assert_eq!(width(narrowest - 1), None);
    }
}
