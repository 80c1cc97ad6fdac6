//! The correction in double precision: what the integer datapath approximates.

use crate::corrector::{base_column, check_frame, taps};
use crate::projection::shrink_factor;
use crate::{CorrectError, Equidistant, Frame, FrameError, Geometry, Interpolant};

/// The corrected samples as real numbers, row after row, neither rounded nor clamped.
///
/// The source coordinate and the stretch factor of Eq. 9 are not quantised and the interpolant is continuous. The
/// optical centre is the geometry's, column C/2 and row `centre_y` (by default the middle); base column and edges follow
/// the datapath's rules.
///
/// # Errors
/// [`CorrectError`] when the frame has another size or depth than the geometry.
pub fn correct_real(
    geometry: &Geometry,
    lens: &Equidistant,
    centre_y: Option<f64>,
    interpolant: Interpolant,
    frame: &Frame,
) -> Result<Vec<f64>, CorrectError> {
    check_frame(geometry, frame)?;
    let mut samples = Vec::with_capacity(frame.samples().len());
    for (index, row) in frame.rows().enumerate() {
        let shrink = shrink_factor(lens.radius(), geometry.row_offset(index, centre_y));
        samples.extend((0..row.len()).map(|column| real_sample(geometry, shrink, interpolant, row, column)));
    }
    Ok(samples)
}

/// The output at `column` of a row with 1/k = `shrink`.
fn real_sample(
    geometry: &Geometry,
    shrink: f64,
    interpolant: Interpolant,
    row: &[u16],
    column: usize,
) -> f64 {
    let centre = f64::from(geometry.centre2()) / 2.0;
    let source = centre + (column as f64 - centre) * shrink;
    let base = base_column(source.floor() as i64, column);
    let weights = interpolant.weights(source - base as f64);
    taps(geometry, row, base)
        .into_iter()
        .zip(weights)
        .map(|(sample, weight)| f64::from(sample) * weight)
        .sum()
}

/// Real samples as a frame of the width, depth and phase of `like`: rounded half up and clamped to the depth.
///
/// # Errors
/// [`FrameError`] when the samples do not fill whole rows.
pub fn round_to_frame(samples: &[f64], like: &Frame) -> Result<Frame, FrameError> {
    let max = f64::from(like.depth().max());
    let rounded = samples.iter().map(|sample| (sample + 0.5).floor().clamp(0.0, max) as u16).collect();
    Frame::new(like.width(), like.depth(), like.phase(), rounded)
}
