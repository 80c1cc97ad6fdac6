//! What all benchmarks work on: the paper's lens at 1920 x 1080, 12 bits.

use std::error::Error;

use halfrow_model::{BitDepth, Camera, Equidistant, Frame, Geometry, GridShape, Phase, TableSet};

/// Radius of the image circle, in pixels (DATAPATH.md, "Golden values").
const RADIUS: f64 = 1106.697;

/// Rows of a whole frame.
pub(crate) const HEIGHT: usize = 1080;

/// The tables of the paper's lens for frames of `height` rows.
pub(crate) fn tables(height: usize) -> Result<TableSet, Box<dyn Error>> {
    let geometry = Geometry::centred(1920, height, BitDepth::Twelve)?;
    Ok(TableSet::from_lens(geometry, &Equidistant::from_radius(RADIUS)?, None)?)
}

/// The grid of the paper's lens for frames of `height` rows, by the formula that DATAPATH.md applies to 1080.
pub(crate) fn grid(height: usize) -> Result<TableSet, Box<dyn Error>> {
    let geometry = Geometry::centred(1920, height, BitDepth::Twelve)?;
    let centre = (959.5, (height - 1) as f64 / 2.0);
    let camera = Camera::new(geometry, Equidistant::from_radius(RADIUS)?.into(), centre, 180.0)?;
    Ok(camera.grid_by_formula(GridShape::new(5, 6)?))
}

/// Frames of a batch: with their outputs twice what a cache of 64 MiB holds.
const BATCH: u32 = 16;

/// The frames of a batch.
pub(crate) fn batch() -> Result<Vec<Frame>, Box<dyn Error>> {
    (0..BATCH).map(|first| frame(HEIGHT, first)).collect()
}

/// The golden frame of `height` rows, or with `first` > 0 one that starts later in its sequence.
pub(crate) fn frame(height: usize, first: u32) -> Result<Frame, Box<dyn Error>> {
    let places = first..first + 1920 * height as u32;
    let samples = places.map(|place| (place.wrapping_mul(2_654_435_761) >> 20) as u16).collect();
    Ok(Frame::new(1920, BitDepth::Twelve, Phase::Grbg, samples)?)
}
