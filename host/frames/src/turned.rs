//! Pictures turned by a quarter.

use super::orientation::Orientation;
use super::preview::RgbImage;

/// The value of the tag `Orientation` of a picture that must be turned a quarter clockwise to be upright.
const CLOCKWISE: u32 = 6;

/// `image`, turned a quarter clockwise if it is higher than wide.
#[must_use]
pub fn landscape(image: RgbImage) -> RgbImage {
    if image.height > image.width { image.turned(Orientation::of_tag(CLOCKWISE)) } else { image }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: 1 2 / 3 4 / 5 6 becomes 5 3 1 / 6 4 2.
    #[test]
    fn a_standing_picture_is_turned_clockwise() {
        let grey = |values: &[u8]| values.iter().flat_map(|&value| [value; 3]).collect();
        let standing = RgbImage { width: 2, height: 3, data: grey(&[1, 2, 3, 4, 5, 6]) };
        let lying = RgbImage { width: 3, height: 2, data: grey(&[5, 3, 1, 6, 4, 2]) };
        assert_eq!(landscape(standing), lying);
    }
}
