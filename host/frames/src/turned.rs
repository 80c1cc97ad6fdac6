//! Pictures turned by a quarter.

use super::preview::RgbImage;

/// `image`, turned a quarter clockwise if it is higher than wide.
#[must_use]
pub fn landscape(image: RgbImage) -> RgbImage {
    if image.height > image.width { turned_clockwise(&image) } else { image }
}

/// A quarter turn clockwise: the left column becomes the top row, read upwards.
fn turned_clockwise(image: &RgbImage) -> RgbImage {
    let (width, height) = (image.height, image.width);
    let pixel = |row, column| {
        let start = 3 * ((width - 1 - column) * image.width + row);
        image.data.get(start..start + 3).unwrap_or_default()
    };
    let places = (0..height).flat_map(|row| (0..width).map(move |column| (row, column)));
    let data = places.flat_map(|(row, column)| pixel(row, column)).copied().collect();
    RgbImage { width, height, data }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: 1 2 / 3 4 / 5 6 becomes 5 3 1 / 6 4 2.
    #[test]
    fn a_standing_picture_is_turned_clockwise() {
        let grey = |values: &[u8]| values.iter().flat_map(|&value| [value; 3]).collect();
        let standing = RgbImage { width: 2, height: 3, data: grey(&[1, 2, 3, 4, 5, 6]) };
        let landscape = RgbImage { width: 3, height: 2, data: grey(&[5, 3, 1, 6, 4, 2]) };
        assert_eq!(turned_clockwise(&standing), landscape);
    }
}
