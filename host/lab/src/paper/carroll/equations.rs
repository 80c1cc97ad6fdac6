//! Linear equations that are to be fulfilled as well as possible together.

use nalgebra::DVector;
use nalgebra_sparse::{CooMatrix, CscMatrix};

/// The number of an unknown, and its factor.
pub(super) type Unknown = (usize, f64);

/// Equations, each with the weight of its error.
pub(super) struct Equations {
    unknowns: usize,
    places: Vec<(usize, usize, f64)>,
    right: Vec<f64>,
}

impl Equations {
    /// No equations yet, with this many unknowns.
    pub(super) fn new(unknowns: usize) -> Self {
        Self { unknowns, places: Vec::new(), right: Vec::new() }
    }

    /// Adds the equation that the sum of `terms` is `value`. The square of its error counts `weight` times.
    pub(super) fn add(&mut self, weight: f64, terms: &[Unknown], value: f64) {
        let (row, scale) = (self.right.len(), weight.sqrt());
        self.places.extend(terms.iter().map(|&(unknown, factor)| (row, unknown, scale * factor)));
        self.right.push(scale * value);
    }

    /// The normal equations. Their solution has the least sum of squares.
    pub(super) fn normal(self) -> (CscMatrix<f64>, DVector<f64>) {
        let mut all = CooMatrix::new(self.right.len(), self.unknowns);
        for (row, unknown, factor) in self.places {
            all.push(row, unknown, factor);
        }
        let all = CscMatrix::from(&all);
        let turned = all.transpose();
        let right = &turned * &DVector::from_vec(self.right);
        (&turned * &all, right)
    }
}
