//! Adds the distortion that the correction removes: the reciprocal of Eqs. 8 and 9 (Sect. 4.1, Fig. 11).

use halfrow_model::{Equidistant, stretch_factor};

use halfrow::frames::preview::RgbImage;

/// `image` with its rows distorted as by a lens with the image circle of `lens`: distorted(x_d, y) = image(k · x_d, y), in pixels
/// from the middle of the picture, with k of Eq. 9.
///
/// Each colour is interpolated linearly between two pixels, the last pixel of a row continues beyond its end, and the result is
/// truncated to 8 bits. The paper leaves all three open; these choices come nearest to its Table 1.
#[must_use]
pub fn distorted(image: &RgbImage, lens: &Equidistant) -> RgbImage {
    distorted_by(image, lens, between)
}

/// Like [`distorted`], with the colour that `sample` computes for a position in a row of bytes, 0 to its last column.
#[must_use]
pub(crate) fn distorted_by(
    image: &RgbImage,
    lens: &Equidistant,
    sample: impl Fn(&[u8], f64) -> [u8; 3],
) -> RgbImage {
    let (width, height) = (image.width, image.height);
    let centre = (width as f64 - 1.0) / 2.0;
    let mut data = Vec::with_capacity(image.data.len());
    for (index, row) in image.data.chunks_exact(3 * width).enumerate() {
        let y = index as f64 - (height as f64 - 1.0) / 2.0;
        let factor = stretch_factor(lens.radius(), y);
        for column in 0..width {
            let source = centre + factor * (column as f64 - centre);
            data.extend(sample(row, source.clamp(0.0, width as f64 - 1.0)));
        }
    }
    RgbImage { width, height, data }
}

/// Red, green and blue at the position `x` of a row, 0 to its last column, truncated.
fn between(row: &[u8], x: f64) -> [u8; 3] {
    let left = x as usize;
    let right = (left + 1).min(row.len() / 3 - 1);
    let share = x - left as f64;
    std::array::from_fn(|colour| {
        let (left, right) = (f64::from(row[3 * left + colour]), f64::from(row[3 * right + colour]));
        (left + (right - left) * share) as u8
    })
}
