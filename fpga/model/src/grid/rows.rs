//! Least squares with the B-spline down the rows.

use super::spline;
use crate::{Geometry, GridShape};

/// What keeps an entry that next to no row depends on from growing, in parts of a row.
const DAMPING: f64 = 1e-3;

/// The normal equations of all rows of a frame, factored: L·Lᵀ with two diagonals below the main one.
pub(super) struct RowSpline {
    shape: GridShape,
    /// Of each row of L: its last three entries, the diagonal's first.
    factored: Vec<[f64; 3]>,
}

impl RowSpline {
    pub(super) fn new(shape: GridShape, geometry: &Geometry) -> Self {
        let mut normal = vec![[DAMPING, 0.0, 0.0]; shape.rows(geometry)];
        for row in 0..geometry.height() {
            let (first, weights) = fractions(shape, row);
            for (index, weight) in weights.into_iter().enumerate() {
                for back in 0..=index {
                    normal[first + index][back] += weight * weights[index - back];
                }
            }
        }
        Self { shape, factored: factored(normal) }
    }

    /// The entries whose spline is nearest to `values`, one a row from the top.
    pub(super) fn fitted(&self, values: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut sides = vec![0.0; self.factored.len()];
        for (row, value) in values.enumerate() {
            let (first, weights) = fractions(self.shape, row);
            for (side, weight) in sides[first..].iter_mut().zip(weights) {
                *side += weight * value;
            }
        }
        self.solved(sides)
    }

    fn solved(&self, mut x: Vec<f64>) -> Vec<f64> {
        let l = &self.factored;
        for row in 0..x.len() {
            let known: f64 = (1..=row.min(2)).map(|back| l[row][back] * x[row - back]).sum();
            x[row] = (x[row] - known) / l[row][0];
        }
        for row in (0..x.len()).rev() {
            let known: f64 = (1..=2)
                .filter(|below| row + below < l.len())
                .map(|below| l[row + below][below] * x[row + below])
                .sum();
            x[row] = (x[row] - known) / l[row][0];
        }
        x
    }
}

/// The weights of a row as fractions.
pub(super) fn fractions(shape: GridShape, row: usize) -> (usize, [f64; 3]) {
    let (first, weights) = spline(shape, row);
    (first, weights.map(|weight| f64::from(weight) / 8192.0))
}

/// Cholesky's factor.
fn factored(mut matrix: Vec<[f64; 3]>) -> Vec<[f64; 3]> {
    for row in 0..matrix.len() {
        if row >= 2 {
            matrix[row][2] /= matrix[row - 2][0];
        }
        if row >= 1 {
            matrix[row][1] = (matrix[row][1] - matrix[row][2] * matrix[row - 1][1]) / matrix[row - 1][0];
        }
        matrix[row][0] = (matrix[row][0] - matrix[row][1].powi(2) - matrix[row][2].powi(2)).sqrt();
    }
    matrix
}
