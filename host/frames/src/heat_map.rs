//! Amounts shown as a picture.

use super::preview::RgbImage;

/// From dark to bright, in even steps of lightness.
const COLOURS: [[f64; 3]; 5] = [
    [23.0, 23.0, 32.0],
    [131.0, 38.0, 129.0],
    [220.0, 70.0, 106.0],
    [254.0, 154.0, 108.0],
    [252.0, 253.0, 191.0],
];

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
        (low[channel] + (high[channel] - low[channel]) * (place - below as f64) + 0.5) as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

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
