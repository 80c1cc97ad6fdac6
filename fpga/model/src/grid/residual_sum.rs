//! Amounts by which samples are in wrong places, added up.

/// An amount in columns that can be seen.
const VISIBLE: f64 = 0.05;

/// Columns by which outputs are taken from wrong places, of one part of the frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GridResidual {
    /// The mean amount; 0 of no output.
    pub mean: f64,
    /// The largest.
    pub max: f64,
    /// The share of outputs for which it is above 0.05, 0 to 1.
    pub share: f64,
}

/// Amounts, 0 and more, added up one after the other.
#[derive(Clone, Copy, Debug, Default)]
pub struct ResidualSum {
    count: usize,
    sum: f64,
    max: f64,
    visible: usize,
}

impl ResidualSum {
    /// Adds `amount`.
    pub fn add(&mut self, amount: f64) {
        self.count += 1;
        self.sum += amount;
        self.max = self.max.max(amount);
        self.visible += usize::from(amount > VISIBLE);
    }

    /// These and those of `other`.
    #[must_use]
    pub fn and(&self, other: &Self) -> Self {
        Self {
            count: self.count + other.count,
            sum: self.sum + other.sum,
            max: self.max.max(other.max),
            visible: self.visible + other.visible,
        }
    }

    /// How many there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// Their mean, the largest, and the share of those that can be seen.
    #[must_use]
    pub fn residual(&self) -> GridResidual {
        let count = self.count.max(1) as f64;
        GridResidual { mean: self.sum / count, max: self.max, share: self.visible as f64 / count }
    }
}
