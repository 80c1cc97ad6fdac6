//! Amounts shown as a picture.

use super::preview::RgbImage;

/// Red, green and blue from nothing, which is nearly black, to the most: the brighter part of magma, whose lightness rises evenly, so
/// that the order also shows in grey and to colour-blind readers.
pub const MAGMA: [[u8; 3]; 8] = [
    [0x17, 0x17, 0x20],
    [0x83, 0x26, 0x81],
    [0xb0, 0x31, 0x7b],
    [0xdc, 0x46, 0x6a],
    [0xf4, 0x69, 0x5c],
    [0xfe, 0x9a, 0x6c],
    [0xfe, 0xca, 0x8d],
    [0xfc, 0xfd, 0xbf],
];

/// The colours of a picture, in even steps of lightness.
const COLOURS: [[u8; 3]; 5] = [MAGMA[0], MAGMA[1], MAGMA[3], MAGMA[5], MAGMA[7]];

/// A picture of amounts, from 0 (dark) to the largest (bright).
#[derive(Clone, Debug, PartialEq)]
pub struct HeatMap {
    /// A pixel for each amount.
    pub image: RgbImage,
    /// The amount that is shown brightest.
    pub most: f64,
}

impl HeatMap {
    /// The picture of `rows` of amounts. All rows are equally long, and all amounts at least 0.
    #[must_use]
    pub fn new(rows: &[Vec<f64>]) -> Self {
        Self::up_to(rows, rows.iter().flatten().copied().fold(0.0, f64::max))
    }

    /// Like [`Self::new`], with `most` as the brightest amount, for maps that share a scale.
    #[must_use]
    pub fn up_to(rows: &[Vec<f64>], most: f64) -> Self {
        // If all amounts are 0, any scale will do.
        let scale = if most > 0.0 { most } else { 1.0 };
        let data = rows.iter().flatten().flat_map(|&amount| colour(amount / scale)).collect();
        let width = rows.first().map_or(0, Vec::len);
        Self { image: RgbImage { width, height: rows.len(), data }, most }
    }
}

/// The colour of an amount, as a share of the largest: 0 to 1.
fn colour(share: f64) -> [u8; 3] {
    let place = share.clamp(0.0, 1.0) * (COLOURS.len() - 1) as f64;
    let below = (place as usize).min(COLOURS.len() - 2);
    let (low, high) = (COLOURS[below], COLOURS[below + 1]);
    std::array::from_fn(|channel| {
        let (low, high) = (f64::from(low[channel]), f64::from(high[channel]));
        (low + (high - low) * (place - below as f64) + 0.5) as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lightness_rises_with_the_amount() {
        let luma = |[red, green, blue]: [u8; 3]| 2 * u32::from(red) + 7 * u32::from(green) + u32::from(blue);
        let all = MAGMA.map(luma);
        assert!(all.is_sorted(), "{all:?}");
    }

    #[test]
    fn nothing_is_dark_and_the_largest_is_bright() {
        let map = HeatMap::new(&[vec![0.0, 2.0, 4.0], vec![1.0, 3.0, 0.0]]);
        assert_eq!((map.image.width, map.image.height, map.most), (3, 2, 4.0));
        let pixels: Vec<_> = map.image.data.chunks(3).collect();
        assert_eq!(pixels[0], [23, 23, 32]);
        assert_eq!((pixels[1], pixels[2]), (&[220, 70, 106][..], &[252, 253, 191][..]));
        assert_eq!(HeatMap::up_to(&[vec![0.0, 2.0]], 4.0).image.data[3..], [220, 70, 106]);
        assert!(HeatMap::new(&[vec![0.0; 2]]).image.data.chunks(3).all(|pixel| pixel == [23, 23, 32]));
    }
}
