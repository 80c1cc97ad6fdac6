//! Whether a share is still what it has always been: a p-chart with exact limits.

use serde::Serialize;

use super::rate::Rate;

/// The chance that a group lies beyond one limit although nothing has changed: that of three standard deviations,
/// one-sided.
const BEYOND: f64 = 0.001_349_898_031_630_1;

/// What a share may be if nothing has changed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Limits {
    /// The share of all groups together, 0 to 1.
    pub mean: f64,
    /// The limits of this group's share, the lower first. They depend on the group's size.
    pub limits: [f64; 2],
    /// Whether the group's share is beyond them.
    pub is_beyond: bool,
}

/// The limits of each group, from all of them together; `None` for an empty group.
///
/// They are those of the binomial distribution itself, because units may be few and shares close to 1: W. H. Woodall,
/// Journal of Quality Technology 29 (1997), p. 172. By chance a group lies beyond each of them as often as beyond
/// three standard deviations.
#[must_use]
pub fn limits(groups: &[Rate]) -> Vec<Option<Limits>> {
    let (count, of) = groups.iter().fold((0, 0), |(count, of), group| (count + group.count, of + group.of));
    let mean = if of == 0 { 0.0 } else { count as f64 / of as f64 };
    groups.iter().map(|group| (group.of > 0).then(|| Limits::of(group, mean))).collect()
}

impl Limits {
    /// The limits of a group that is not empty, where all groups together have the share `mean`.
    #[must_use]
    pub fn of(group: &Rate, mean: f64) -> Self {
        let (low, high) = (least(group.of, mean), group.of - least(group.of, 1.0 - mean));
        Self {
            mean,
            limits: [low, high].map(|count| count as f64 / group.of as f64),
            is_beyond: !(low..=high).contains(&group.count),
        }
    }
}

/// The largest number, among `of` cases with the chance `mean` each, such that fewer occur with a chance below [`BEYOND`].
fn least(of: u64, mean: f64) -> u64 {
    if mean <= 0.0 {
        return 0;
    }
    if mean >= 1.0 {
        return of;
    }
    // With many cases the chance of none underflows; its logarithm does not.
    let mut logarithm = of as f64 * (-mean).ln_1p();
    let odds = (mean / (1.0 - mean)).ln();
    let mut below = 0.0;
    for count in 0..of {
        below += logarithm.exp();
        if below >= BEYOND {
            return count;
        }
        logarithm += odds + ((of - count) as f64 / (count + 1) as f64).ln();
    }
    of
}
