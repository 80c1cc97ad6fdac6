//! Whether a share is as it always was: a p-chart with exact limits.

use serde::Serialize;

use super::rate::Rate;

/// The chance that a group lies beyond one limit though nothing has changed: that of three standard deviations on one side.
const BEYOND: f64 = 0.001_349_898_031_630_1;

/// What a share may be if nothing has changed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Limits {
    /// The share of all groups together, 0 to 1.
    pub mean: f64,
    /// The least and the greatest share of this group, which depend on its size.
    pub limits: [f64; 2],
    /// Whether the group's share is beyond them.
    pub is_beyond: bool,
}

/// The limits of each group among all of them; none of a group of nobody.
///
/// They are those of the binomial distribution itself, which few units and shares close to 1 need: W. H. Woodall, Journal of Quality
/// Technology 29 (1997), p. 172. Beyond each lies a group by chance as often as beyond three standard deviations.
#[must_use]
pub fn limits(groups: &[Rate]) -> Vec<Option<Limits>> {
    let (count, of) = groups.iter().fold((0, 0), |(count, of), group| (count + group.count, of + group.of));
    let mean = if of == 0 { 0.0 } else { count as f64 / of as f64 };
    groups.iter().map(|group| (group.of > 0).then(|| Limits::of(group, mean))).collect()
}

impl Limits {
    /// Those of a group of somebody where all together have the share `mean`.
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

/// The least number of cases among `of`, each of the chance `mean`, below which there are fewer only with [`BEYOND`].
fn least(of: u64, mean: f64) -> u64 {
    if mean <= 0.0 {
        return 0;
    }
    if mean >= 1.0 {
        return of;
    }
    // The chance of none underflows for many; its logarithm does not.
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
