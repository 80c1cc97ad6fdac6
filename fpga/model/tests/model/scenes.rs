//! Frames to correct.

use halfrow_model::{BitDepth, Frame, Geometry, Phase};

/// The samples of DATAPATH.md's golden frame, 12 bits. They have no structure, so they are the hardest content for an
/// interpolant.
pub(crate) fn golden_samples(geometry: &Geometry) -> Vec<u16> {
    let samples = (geometry.width() * geometry.height()) as u32;
    (0..samples).map(|index| (index.wrapping_mul(2_654_435_761) >> 20) as u16).collect()
}

/// A 12-bit frame of `geometry` with `samples`.
pub(crate) fn frame(geometry: &Geometry, samples: Vec<u16>) -> Frame {
    Frame::new(geometry.width(), BitDepth::Twelve, Phase::Grbg, samples).unwrap()
}

/// A 12-bit frame of smooth shading and fine gratings, as a lens would image it.
pub(crate) fn natural(geometry: &Geometry) -> Frame {
    let sample = |row: usize, column: usize| {
        let (x, y) = (column as f64, row as f64);
        let shading = (x / 311.0 + y / 97.0).sin();
        let grating = (x / 3.1 + y / 5.3).sin() * (x / 211.0).cos();
        let tint = if (row + column).is_multiple_of(2) { 1.0 } else { 0.8 };
        (tint * (1900.0 + 1100.0 * shading + 600.0 * grating)) as u16
    };
    let rows = 0..geometry.height();
    frame(
        geometry,
        rows.flat_map(|row| (0..geometry.width()).map(move |column| sample(row, column))).collect(),
    )
}
