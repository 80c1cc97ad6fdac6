//! The map of differences.

use halfrow_model::Frame;
use png::EncodingError;

use super::Picture;
use super::scale::{MISSING, colour};
use crate::frames::preview::RgbImage;
use crate::result::MissingRows;

/// The side of the square of samples that one pixel stands for in the map of a large frame. It keeps a single difference
/// visible when a whole frame is shown on a phone.
const BOX: usize = 8;
/// The most samples of a frame whose map has a pixel for each.
const SMALL: usize = 128 * 128;

/// The side of the square of samples that one pixel of the map stands for, for a frame of `samples` samples.
#[must_use]
pub fn side(samples: usize) -> usize {
    if samples <= SMALL { 1 } else { BOX }
}

/// A map of two frames of one size: each pixel has the colour of the largest difference in its square of [`side`] by [`side`]
/// samples. Where none is known and rows are `missing`, it has a colour that stands for these.
///
/// # Errors
/// The PNG encoder's.
pub(in crate::report) fn difference_map(
    expected: &Frame,
    found: &Frame,
    missing: &MissingRows,
) -> Result<Picture, EncodingError> {
    let side = side(expected.samples().len());
    let (width, height) = (expected.width().div_ceil(side), expected.height().div_ceil(side));
    let mut largest = vec![0_u16; width * height];
    let mut has_all = vec![true; height];
    for (row, (expected, found)) in expected.rows().zip(found.rows()).enumerate() {
        if missing.contains(row) {
            has_all[row / side] = false;
            continue;
        }
        let line = largest.iter_mut().skip(row / side * width).take(width);
        for (most, (expected, found)) in line.zip(expected.chunks(side).zip(found.chunks(side))) {
            *most = expected.iter().zip(found).fold(*most, |most, (e, f)| most.max(e.abs_diff(*f)));
        }
    }
    let shown = |(place, most): (usize, u16)| {
        if most > 0 || has_all[place / width] { colour(most) } else { MISSING }
    };
    let data = largest.into_iter().enumerate().flat_map(shown).collect();
    Picture::new(&RgbImage { width, height, data })
}
