//! A rate, never without the interval that its number of cases allows.

use serde::Serialize;

/// The 97.5 % point of the normal distribution.
const Z: f64 = 1.959_963_984_540_054;

/// How many of a total.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Rate {
    /// How many cases.
    pub count: u64,
    /// The total.
    pub of: u64,
    /// The share, 0 to 1; `None` if the total is 0.
    pub share: Option<f64>,
    /// The ends of its 95 % interval; `None` if the total is 0.
    pub interval: Option<[f64; 2]>,
}

impl Rate {
    /// The rate of `count` cases among `of`.
    #[must_use]
    pub fn new(count: u64, of: u64) -> Self {
        let is_any = of > 0;
        let share = is_any.then(|| count as f64 / of as f64);
        Self { count, of, share, interval: is_any.then(|| wilson(count, of)) }
    }

    /// The share in per cent with its interval, for people.
    #[must_use]
    pub fn text(&self) -> String {
        let Some((share, [low, high])) = self.share.zip(self.interval) else { return "–".to_owned() };
        format!("{:.1} % ({:.1}–{:.1})", 100.0 * share, 100.0 * low, 100.0 * high)
    }
}

/// The ends of Wilson's score interval at 95 %: E. B. Wilson, J. Amer. Statist. Assoc. 22 (1927), p. 209. `of` is not 0.
fn wilson(count: u64, of: u64) -> [f64; 2] {
    let (n, share) = (of as f64, count as f64 / of as f64);
    let scale = 1.0 + Z * Z / n;
    let centre = (share + Z * Z / (2.0 * n)) / scale;
    let half = Z / scale * (share * (1.0 - share) / n + Z * Z / (4.0 * n * n)).sqrt();
    // For no cases and for all of them, rounding must not move the ends beyond 0 and 1.
    let low = if count == 0 { 0.0 } else { centre - half };
    let high = if count == of { 1.0 } else { centre + half };
    [low, high]
}
