//! The normal equations of a kernel's nodes: 65 nodes with the five stored weights each.

use halfrow_model::{Interpolant, Kernel, NODES, Taps, WEIGHT_ONE};
use nalgebra::{DMatrix, DVector};

use super::{TrainingError, Warped};

/// Weights stored in a node.
const STORED: usize = 5;

/// Number of unknowns.
const SIZE: usize = NODES * STORED;

/// How strongly the nodes are held to Hermite's, as a share of the mean of the matrix's diagonal: enough for nodes that no sample
/// is near, too little to move the others.
pub const RIDGE: f64 = 1e-5;

/// A weighted sum of the squared errors of a kernel, as a function of its nodes.
#[derive(Clone, Debug)]
pub struct Equations {
    /// Row after row, symmetric.
    matrix: Vec<f64>,
    right: Vec<f64>,
    /// The sum for a kernel of zeros, whose outputs are G2.
    constant: f64,
    samples: f64,
}

impl Default for Equations {
    fn default() -> Self {
        Self::new()
    }
}

impl Equations {
    /// The sum over no samples.
    #[must_use]
    pub fn new() -> Self {
        Self { matrix: vec![0.0; SIZE * SIZE], right: vec![0.0; SIZE], constant: 0.0, samples: 0.0 }
    }

    /// Adds every sample of a frame, and its mirror image: light has no preferred direction.
    pub(crate) fn observe(&mut self, warped: &Warped) {
        let geometry = warped.tables.geometry();
        let rows = warped.distorted.rows().zip(warped.reference.rows()).enumerate();
        let rows = rows.filter_map(|(index, rows)| Some((warped.tables.values(index)?, rows)));
        for (values, (row, wanted)) in rows {
            for (column, &wanted) in wanted.iter().enumerate() {
                let source = values.source(column);
                let mut taps: [f64; 7] = std::array::from_fn(|tap| {
                    row[geometry.sample_column(source.base - 2 + tap as i64)].into()
                });
                let toward = f64::from(source.fraction) / 256.0;
                self.sample(source.node, toward, taps, wanted.into());
                taps.reverse();
                self.sample(NODES - 2 - source.node, 1.0 - toward, taps, wanted.into());
            }
        }
    }

    /// Adds a sample that should be `wanted`. It lies between `node` and the next one, at the share `toward` of the way.
    ///
    /// # Panics
    /// When `node` has no next one: only 0 to [`NODES`] − 2 have.
    pub fn sample(&mut self, node: usize, toward: f64, taps: [f64; 7], wanted: f64) {
        let [g0, r1, g2, r3, g4, r5, g6] = taps;
        let differences = [g0 - g2, r1 - r3, g4 - g2, r5 - r3, g6 - g2];
        let mut factors = [0.0; 2 * STORED];
        for (place, difference) in differences.into_iter().enumerate() {
            factors[place] = difference * (1.0 - toward);
            factors[place + STORED] = difference * toward;
        }
        let rest = wanted - g2;
        let first = node * STORED;
        for (row, factor) in factors.into_iter().enumerate() {
            let line = &mut self.matrix[(first + row) * SIZE + first..][..2 * STORED];
            for (entry, other) in line.iter_mut().zip(factors) {
                *entry += factor * other;
            }
            self.right[first + row] += factor * rest;
        }
        self.constant += rest * rest;
        self.samples += 1.0;
    }

    /// The sum divided by the number of samples.
    #[must_use]
    pub(crate) fn per_sample(&self) -> Self {
        let mut scaled = Self::new();
        scaled.add(self, 1.0 / self.samples.max(1.0));
        scaled
    }

    /// Adds `other` times `weight`.
    pub fn add(&mut self, other: &Self, weight: f64) {
        for (sum, value) in self.matrix.iter_mut().zip(&other.matrix) {
            *sum += weight * value;
        }
        for (sum, value) in self.right.iter_mut().zip(&other.right) {
            *sum += weight * value;
        }
        self.constant += weight * other.constant;
        self.samples += weight * other.samples;
    }

    /// The sum of the squared errors of `kernel`, before its outputs are rounded.
    #[must_use]
    pub fn error(&self, kernel: &Kernel) -> f64 {
        let stored = kernel.nodes().iter().flatten();
        let weights: Vec<f64> = stored.map(|&weight| f64::from(weight) / f64::from(WEIGHT_ONE)).collect();
        let product = |row: &[f64]| -> f64 { row.iter().zip(&weights).map(|(a, b)| a * b).sum() };
        let lines = self.matrix.chunks_exact(SIZE).zip(&self.right).zip(&weights);
        self.constant
            + lines.map(|((line, right), weight)| weight * (product(line) - 2.0 * right)).sum::<f64>()
    }

    /// The kernel with the least error; for five taps g0 = g6 = 0.
    ///
    /// # Errors
    /// [`TrainingError::Singular`] when no sample had detail, [`TrainingError::Kernel`] when a weight does not fit into 16 bits.
    pub fn kernel(&self, taps: Taps) -> Result<Kernel, TrainingError> {
        let tap_is_free = |place: &usize| taps == Taps::Seven || !matches!(place % STORED, 0 | 4);
        let free: Vec<usize> = (0..SIZE).filter(tap_is_free).collect();
        let trace: f64 = (0..SIZE).map(|place| self.matrix[place * SIZE + place]).sum();
        let ridge = RIDGE * trace / SIZE as f64;
        let hermite = |place: usize| {
            let weights = Interpolant::Hermite.weights((place / STORED) as f64 / 32.0);
            halfrow::kernels::stored(weights)[place % STORED]
        };
        let entry = |row: usize, column: usize| {
            self.matrix[row * SIZE + column] + if row == column { ridge } else { 0.0 }
        };
        let matrix = DMatrix::from_fn(free.len(), free.len(), |row, column| entry(free[row], free[column]));
        let right = free.iter().map(|&row| self.right[row] + ridge * hermite(row));
        let right = DVector::from_iterator(free.len(), right);
        let solution = matrix.cholesky().ok_or(TrainingError::Singular)?.solve(&right);
        let mut weights = vec![[0.0; STORED]; NODES];
        for (place, &weight) in free.into_iter().zip(&solution) {
            weights[place / STORED][place % STORED] = weight;
        }
        Ok(Kernel::from_weights(&weights)?)
    }
}
