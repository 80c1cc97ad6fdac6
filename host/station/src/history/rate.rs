//! A rate, never without the interval that its number of cases allows.

use serde::Serialize;

/// The 97.5 % point of the normal distribution.
const Z: f64 = 1.959_963_984_540_054;
/// More digits of a percentage than a share differs from 0 or 1 in.
const DIGITS: usize = 17;

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

    /// The share and the ends of its interval in per cent, for people; `None` if the total is 0.
    pub(crate) fn per_cent(&self) -> Option<[String; 3]> {
        let (share, [low, high]) = self.share.zip(self.interval)?;
        Some([share, low, high].map(per_cent))
    }

    /// The share in per cent with its interval, for people.
    #[must_use]
    pub fn text(&self) -> String {
        let Some([share, low, high]) = self.per_cent() else { return "–".to_owned() };
        format!("{share} % ({low}–{high})")
    }

    /// The same, and the two counts.
    pub(crate) fn counted(&self) -> String {
        format!("{} {}/{}", self.text(), self.count, self.of)
    }
}

/// A share from 0 to 1 in per cent: to a tenth, and with as many more digits as it takes for only all to be 100 and only none to be 0.
pub(crate) fn per_cent(share: f64) -> String {
    let is_between = 0.0 < share && share < 1.0;
    let rounded = |digits: usize| format!("{:.digits$}", 100.0 * share);
    let is_told = |text: &String| text.parse().is_ok_and(|told: f64| 0.0 < told && told < 100.0);
    (1..DIGITS).map(rounded).find(|text| !is_between || is_told(text)).unwrap_or_else(|| rounded(DIGITS))
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
