//! How a lens distorts the photographs that a kernel is fitted to or measured on.

use halfrow_model::{BitDepth, Equidistant, Geometry, Phase, TableSet};

use super::{TrainingError, Warped};
use crate::paper;
use halfrow::frames::mosaic;
use halfrow::frames::preview::RgbImage;

/// Pixels that the band-limited warp uses on each side.
const REACH: i32 = 8;

/// How the brightness between two pixels of a photograph is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Warp {
    /// Linear interpolation, truncated, as in the paper's experiment. It blurs what it distorts.
    Linear,
    /// A sinc under Lanczos' window, eight pixels to each side, rounded half up. It treats the pixels as samples of a
    /// band-limited picture.
    BandLimited,
}

/// A lens and a warp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Model {
    /// The lens's R as a multiple of half the picture's height.
    pub radius: f64,
    /// The warp.
    pub warp: Warp,
}

impl Warp {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Linear, Self::BandLimited];

    /// Its name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::BandLimited => "band-limited",
        }
    }

    fn distorted(self, image: &RgbImage, lens: &Equidistant) -> RgbImage {
        match self {
            Self::Linear => paper::distorted(image, lens),
            Self::BandLimited => paper::distorted_by(image, lens, lanczos),
        }
    }
}

impl Model {
    /// The models that kernels are fitted to. In the paper's experiment R is 1.5 times half the height.
    pub const ALL: [Self; 4] = [
        Self { radius: 1.5, warp: Warp::Linear },
        Self { radius: 2.0, warp: Warp::Linear },
        Self { radius: 1.5, warp: Warp::BandLimited },
        Self { radius: 2.0, warp: Warp::BandLimited },
    ];

    fn lens(self, height: usize) -> Result<Equidistant, TrainingError> {
        Ok(Equidistant::from_radius(self.radius * height as f64 / 2.0)?)
    }

    /// The row factors for photographs of this size.
    ///
    /// # Errors
    /// [`TrainingError`] when no frame can have this size.
    pub fn tables(self, width: usize, height: usize) -> Result<TableSet, TrainingError> {
        let geometry = Geometry::centred(width, height, BitDepth::Eight)?;
        Ok(TableSet::from_lens(geometry, &self.lens(height)?, None)?)
    }

    /// `image` under this model. An odd last column is left out.
    ///
    /// # Errors
    /// [`TrainingError`] when no frame can have its size.
    pub(crate) fn warped(self, image: &RgbImage) -> Result<Warped, TrainingError> {
        // This also refuses a picture without pixels, so it comes first.
        let tables = self.tables(image.width & !1, image.height)?;
        let image = &even(image);
        let lens = self.lens(image.height)?;
        Ok(Warped {
            tables,
            reference: mosaic(image, Phase::Grbg)?,
            distorted: mosaic(&self.warp.distorted(image, &lens), Phase::Grbg)?,
        })
    }
}

/// The same without an odd last column.
pub(super) fn even(image: &RgbImage) -> RgbImage {
    let width = image.width & !1;
    let rows = image.data.chunks_exact(3 * image.width);
    let data = rows.flat_map(|row| &row[..3 * width]).copied().collect();
    RgbImage { width, height: image.height, data }
}

/// Red, green and blue at the position `x` of a row whose brightness is band-limited.
fn lanczos(row: &[u8], x: f64) -> [u8; 3] {
    let left = x.floor();
    let last = row.len() as i64 / 3 - 1;
    let (mut sums, mut total) = ([0.0; 3], 0.0);
    for offset in 1 - REACH..=REACH {
        let distance = x - left - f64::from(offset);
        let weight = sinc(distance) * sinc(distance / f64::from(REACH));
        let pixel = (left as i64 + i64::from(offset)).clamp(0, last) as usize;
        for (sum, &value) in sums.iter_mut().zip(&row[3 * pixel..]) {
            *sum += weight * f64::from(value);
        }
        total += weight;
    }
    sums.map(|sum| (sum / total + 0.5).clamp(0.0, 255.0) as u8)
}

/// The sinc function: 1 at 0, and 0 at every other whole number.
fn sinc(x: f64) -> f64 {
    let angle = std::f64::consts::PI * x;
    if angle == 0.0 { 1.0 } else { angle.sin() / angle }
}
