//! The errors of the sources, added up.

/// The least error that can be seen, in columns.
pub const VISIBLE: f64 = 0.05;

/// How many columns away from the right place outputs are taken, for one part of the frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GridResidual {
    /// The mean error; 0 without outputs.
    pub mean: f64,
    /// The largest error.
    pub max: f64,
    /// The share of outputs with an error above [`VISIBLE`], 0 to 1.
    pub share: f64,
}

/// A running sum of errors, each 0 or more, in columns.
#[derive(Clone, Copy, Debug, Default)]
pub struct ResidualSum {
    count: usize,
    sum: f64,
    max: f64,
    visible: usize,
}

impl ResidualSum {
    /// Adds `amount`. One that is no number is as wrong as can be, and must not get lost in the largest.
    pub fn add(&mut self, amount: f64) {
        let amount = if amount.is_nan() { f64::INFINITY } else { amount };
        self.count += 1;
        self.sum += amount;
        self.max = self.max.max(amount);
        self.visible += usize::from(amount > VISIBLE);
    }

    /// The sum of these and those of `other`.
    #[must_use]
    pub fn and(&self, other: &Self) -> Self {
        Self {
            count: self.count + other.count,
            sum: self.sum + other.sum,
            max: self.max.max(other.max),
            visible: self.visible + other.visible,
        }
    }

    /// How many errors have been added.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// The mean, the largest, and the share of those that can be seen.
    #[must_use]
    pub fn residual(&self) -> GridResidual {
        let count = self.count.max(1) as f64;
        GridResidual { mean: self.sum / count, max: self.max, share: self.visible as f64 / count }
    }
}
