//! What tables leave of a lens's distortion.

use halfrow_model::{Camera, GridResidual, ResidualSum, TableSet, VISIBLE};
use serde::Serialize;

/// Mean and largest amount, in pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Amounts {
    /// The mean; 0 if there are none.
    pub mean: f64,
    /// The largest.
    pub max: f64,
}

impl From<GridResidual> for Amounts {
    fn from(GridResidual { mean, max, .. }: GridResidual) -> Self {
        Self { mean, max }
    }
}

// A key of results names it.
const _: () = assert!(VISIBLE == 0.05);

/// The amounts, in columns, in one part of the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Part {
    /// Mean and largest.
    #[serde(flatten)]
    pub amounts: Amounts,
    /// The share of its samples whose amount is above 0.05, which can be seen: 0 to 1.
    #[serde(rename = "share_above_0.05")]
    pub visible: f64,
}

impl From<GridResidual> for Part {
    fn from(residual: GridResidual) -> Self {
        Self { amounts: residual.into(), visible: residual.share }
    }
}

/// How far the samples of a frame are from where the exact projection of the lens puts them, in pixels of the corrected frame.
///
/// As in Fig. 5, this is measured at every sample of the fisheye frame inside the image circle. Samples that the exact projection
/// puts outside the corrected frame do not count.
#[derive(Clone, Debug, PartialEq)]
pub struct Residuals {
    /// How many samples count.
    pub samples: usize,
    /// The amounts in columns, which is what the tables leave.
    pub circle: Part,
    /// The same for the inner part: up to 85 degrees off the axis, and within 0.9 of the height of the circle of 180 degrees.
    pub inner: Part,
    /// The same for the rest: the rim and what is next to the poles.
    pub rim: Part,
    /// The amounts in rows, which no table can change: how far each sample is from the row at which the lens images its latitude
    /// above or below the axis.
    pub vertical: Amounts,
    /// The amount in columns at every sample, row after row; 0 where the sample does not count.
    pub map: Vec<Vec<f64>>,
}

impl Residuals {
    /// What `tables` leave in frames of `camera`.
    #[must_use]
    pub fn of(camera: &Camera, tables: &TableSet) -> Self {
        let [mut inner, mut rim, mut vertical] = [ResidualSum::default(); 3];
        let mut row_of_map = |row| {
            let mut amounts = vec![0.0; camera.geometry().width()];
            for (target, residual) in camera.residuals(tables, row) {
                let amount = residual.columns.abs();
                amounts[target.column] = amount;
                if target.is_inner { &mut inner } else { &mut rim }.add(amount);
                vertical.add(residual.rows.abs());
            }
            amounts
        };
        let map = (0..camera.geometry().height()).map(&mut row_of_map).collect();
        let circle = inner.and(&rim);
        Self {
            samples: circle.count(),
            circle: circle.residual().into(),
            inner: inner.residual().into(),
            rim: rim.residual().into(),
            vertical: vertical.residual().into(),
            map,
        }
    }
}
