//! What a built-in frame is made for: size and depth, colours, and the lens that it is seen through.

use halfrow_model::{Equidistant, Frame, FrameError, Geometry, Phase};

use super::parallel;

/// What a built-in frame is made for. The default is the paper's: 1920 x 1080, 12 bits, GRBG, and its lens.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Scene {
    /// Width, height, depth and the column of the optical centre.
    pub geometry: Geometry,
    /// The row of the optical centre, counted from 0, which may be any finite number; the middle of the frame when not given.
    pub centre_y: Option<f64>,
    /// The arrangement of the colours.
    pub phase: Phase,
    /// The lens; only the street is seen through it.
    pub lens: Equidistant,
    /// The seed of random samples: the same seed gives the same frame.
    pub seed: u64,
}

impl Scene {
    /// The frame whose sample at each row and column is what `sample` returns, called row by row.
    ///
    /// # Errors
    /// [`FrameError::TooBright`] when a sample exceeds the depth.
    pub(super) fn frame(&self, mut sample: impl FnMut(usize, usize) -> u16) -> Result<Frame, FrameError> {
        let (width, height) = (self.geometry.width(), self.geometry.height());
        let mut samples = Vec::with_capacity(width * height);
        for row in 0..height {
            samples.extend((0..width).map(|column| sample(row, column)));
        }
        Frame::new(width, self.geometry.depth(), self.phase, samples)
    }

    /// The frame whose rows `fill` fills, several at a time.
    ///
    /// # Errors
    /// [`FrameError::TooBright`] when a sample exceeds the depth.
    pub(super) fn frame_of_rows(&self, fill: impl Fn(usize, &mut [u16]) + Sync) -> Result<Frame, FrameError> {
        let width = self.geometry.width();
        let mut samples = vec![0; width * self.geometry.height()];
        parallel::fill_rows(&mut samples, width, fill);
        Frame::new(width, self.geometry.depth(), self.phase, samples)
    }

    /// The largest sample, 2^B − 1.
    pub(super) fn max(&self) -> u16 {
        self.geometry.depth().max()
    }

    /// The column of the optical centre, cx = C/2.
    pub(super) fn centre_x(&self) -> f64 {
        f64::from(self.geometry.centre2()) / 2.0
    }

    /// y of `row`: its distance below the optical centre, in rows.
    pub(super) fn y(&self, row: usize) -> f64 {
        self.geometry.row_offset(row, self.centre_y)
    }
}
