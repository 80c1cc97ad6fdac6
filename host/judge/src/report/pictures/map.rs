//! The map of differences.

use halfrow_model::Frame;
use png::EncodingError;

use super::Picture;
use super::scale::colour;
use crate::frames::preview::RgbImage;

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
/// samples.
///
/// # Errors
/// The PNG encoder's.
pub(in crate::report) fn difference_map(expected: &Frame, found: &Frame) -> Result<Picture, EncodingError> {
    let side = side(expected.samples().len());
    let (width, height) = (expected.width().div_ceil(side), expected.height().div_ceil(side));
    let mut largest = vec![0_u16; width * height];
    for (row, (expected, found)) in expected.rows().zip(found.rows()).enumerate() {
        let line = largest.iter_mut().skip(row / side * width).take(width);
        for (most, (expected, found)) in line.zip(expected.chunks(side).zip(found.chunks(side))) {
            *most = expected.iter().zip(found).fold(*most, |most, (e, f)| most.max(e.abs_diff(*f)));
        }
    }
    let data = largest.into_iter().flat_map(colour).collect();
    Picture::new(&RgbImage { width, height, data })
}
