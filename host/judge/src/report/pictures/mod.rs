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

/// The frame as a picture of at most `max_width` columns and `most_bytes` bytes, as large as that allows; none if not even
/// [`MIN_WIDTH`] columns fit.
///
/// # Errors
/// The PNG encoder's.
pub(super) fn preview(
    frame: &Frame,
    max_width: usize,
    most_bytes: usize,
) -> Result<Option<Picture>, EncodingError> {
    let mut side = frame.width().div_ceil(max_width);
    loop {
        let picture = Picture::new(&preview::thumbnail(frame, frame.width().div_ceil(side)))?;
        if picture.len() <= most_bytes {
            return Ok(Some(picture));
        }
        if picture.width <= MIN_WIDTH {
            return Ok(None);
        }
        // The bytes fall with the square of the side.
        let excess = picture.len() as f64 / most_bytes.max(1) as f64;
        side = (side + 1).max((side as f64 * excess.sqrt()) as usize);
    }
}
