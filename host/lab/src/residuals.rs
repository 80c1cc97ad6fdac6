//! What tables leave of a lens's distortion.

use halfrow_model::{Camera, TableSet};
use serde::Serialize;

/// Mean and largest amount, in pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    /// The mean; 0 of nothing.
    pub mean: f64,
    /// The largest.
    pub max: f64,
}

/// How far the samples of a frame are from where the exact projection of the lens puts them, in pixels of the corrected
/// frame.
///
/// Like Fig. 5 it is taken at every sample of the fisheye frame that lies in the image circle; samples that the exact
/// projection puts outside the corrected frame count for nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct Residuals {
    /// The samples that count.
    pub samples: usize,
    /// The amounts in columns: what the tables leave.
    pub horizontal: Spread,
    /// The amounts in rows, which no table changes: how far each sample is from the row at which the lens images its
    /// latitude above or below the axis.
    pub vertical: Spread,
    /// The amount in columns at every sample, row after row; 0 where none counts.
    pub map: Vec<Vec<f64>>,
}

impl Residuals {
    /// What `tables` leave in frames of `camera`.
    #[must_use]
    pub fn of(camera: &Camera, tables: &TableSet) -> Self {
        let (mut horizontal, mut vertical) = (Sum::default(), Sum::default());
        let mut row_of_map = |row| {
            let mut amounts = vec![0.0; camera.geometry().width()];
            for (target, residual) in camera.residuals(tables, row) {
                amounts[target.column] = residual.columns.abs();
                horizontal.add(residual.columns.abs());
                vertical.add(residual.rows.abs());
            }
            amounts
        };
        let map = (0..camera.geometry().height()).map(&mut row_of_map).collect();
        Self { samples: horizontal.count, horizontal: horizontal.spread(), vertical: vertical.spread(), map }
    }
}

#[derive(Default)]
struct Sum {
    count: usize,
    sum: f64,
    max: f64,
}

impl Sum {
    fn add(&mut self, amount: f64) {
        self.count += 1;
        self.sum += amount;
        self.max = self.max.max(amount);
    }

    fn spread(&self) -> Spread {
        Spread { mean: self.sum / self.count.max(1) as f64, max: self.max }
    }
}
