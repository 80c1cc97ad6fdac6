//! The normal equations of the tensor spline: symmetric and banded.

/// The lower half of a symmetric band matrix, entry (i, i − d) at i · (`band` + 1) + d, and the right side.
pub(super) struct Normal {
    band: usize,
    entries: Vec<f64>,
    right: Vec<f64>,
}

impl Normal {
    /// For `count` unknowns. Those that meet in an equation are at most `band` apart. `damping` keeps each near 0.
    pub(super) fn new(count: usize, band: usize, damping: f64) -> Self {
        let mut entries = vec![0.0; count * (band + 1)];
        entries.iter_mut().step_by(band + 1).for_each(|diagonal| *diagonal = damping);
        Self { band, entries, right: vec![0.0; count] }
    }

    /// Adds the equation that these unknowns, in rising order, times these factors add up to `value`, with the weight `weight`.
    pub(super) fn add(&mut self, terms: &[(usize, f64)], value: f64, weight: f64) {
        for (place, &(row, factor)) in terms.iter().enumerate() {
            let weighted = weight * factor;
            self.right[row] += weighted * value;
            for &(column, other) in &terms[..=place] {
                self.entries[row * (self.band + 1) + row - column] += weighted * other;
            }
        }
    }

    /// Solves for the unknowns.
    pub(super) fn solved(mut self) -> Vec<f64> {
        let right = std::mem::take(&mut self.right);
        self.factored().solved(right)
    }

    /// The Cholesky factor L of the matrix.
    pub(super) fn factored(mut self) -> Factor {
        for row in 0..self.entries.len() / (self.band + 1) {
            self.factor_row(row);
        }
        Factor { band: self.band, l: self.entries }
    }

    /// Computes a row of L from those above it.
    fn factor_row(&mut self, row: usize) {
        let stride = self.band + 1;
        for back in (0..=row.min(self.band)).rev() {
            let column = row - back;
            // How much of both rows lies left of the column and within the band of this row.
            let reach = (self.band - back).min(column);
            let own = &self.entries[row * stride + back + 1..][..reach];
            let above = &self.entries[column * stride + 1..][..reach];
            let known: f64 = own.iter().zip(above).map(|(own, above)| own * above).sum();
            let rest = self.entries[row * stride + back] - known;
            let diagonal = self.entries[column * stride];
            self.entries[row * stride + back] =
                if back == 0 { rest.max(f64::MIN_POSITIVE).sqrt() } else { rest / diagonal };
        }
    }
}

/// L of a matrix L·Lᵀ, entry (i, i − d) at i · (`band` + 1) + d.
pub(super) struct Factor {
    band: usize,
    l: Vec<f64>,
}

impl Factor {
    /// The number of unknowns.
    pub(super) fn count(&self) -> usize {
        self.l.len() / (self.band + 1)
    }

    /// The unknowns for the right side `x`.
    pub(super) fn solved(&self, mut x: Vec<f64>) -> Vec<f64> {
        let (stride, l) = (self.band + 1, &self.l);
        for row in 0..x.len() {
            let reach = row.min(self.band);
            let known: f64 = (1..=reach).map(|back| l[row * stride + back] * x[row - back]).sum();
            x[row] = (x[row] - known) / l[row * stride];
        }
        for row in (0..x.len()).rev() {
            x[row] /= l[row * stride];
            for back in 1..=row.min(self.band) {
                x[row - back] -= l[row * stride + back] * x[row];
            }
        }
        x
    }
}
