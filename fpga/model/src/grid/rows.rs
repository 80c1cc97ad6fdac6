//! Least squares with the B-spline down the rows.

use super::normal::{Factor, Normal};
use super::spline;
use crate::{Geometry, GridShape};

/// Keeps an entry that hardly any row depends on from growing; relative to the weight of one row.
const DAMPING: f64 = 1e-3;

/// The normal equations of all rows of a frame, factored.
pub(super) struct RowSpline {
    shape: GridShape,
    factor: Factor,
}

impl RowSpline {
    pub(super) fn new(shape: GridShape, geometry: &Geometry) -> Self {
        let mut normal = Normal::new(shape.rows(geometry), 2, DAMPING);
        for row in 0..geometry.height() {
            let (first, weights) = fractions(shape, row);
            let terms: [_; 3] = std::array::from_fn(|term| (first + term, weights[term]));
            normal.add(&terms, 0.0, 1.0);
        }
        Self { shape, factor: normal.factored() }
    }

    /// The entries whose spline is nearest to `values`, one per row from the top.
    pub(super) fn fitted(&self, values: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut sides = vec![0.0; self.factor.count()];
        for (row, value) in values.enumerate() {
            let (first, weights) = fractions(self.shape, row);
            for (side, weight) in sides[first..].iter_mut().zip(weights) {
                *side += weight * value;
            }
        }
        self.factor.solved(sides)
    }
}

/// The first grid row of a row, and its weights as fractions.
pub(super) fn fractions(shape: GridShape, row: usize) -> (usize, [f64; 3]) {
    let (first, weights) = spline(shape, row);
    (first, weights.map(|weight| f64::from(weight) / 8192.0))
}
