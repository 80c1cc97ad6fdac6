//! Whether a station judges differently from all others under the same plan.

use std::collections::BTreeMap;

use serde::Serialize;

use super::PlanName;
use super::rate::Rate;
use super::yields::Yield;

/// The chance that any station under any of the plans is marked although all are alike.
const BY_CHANCE: f64 = 0.01;
/// The least number of cases to be expected in each of the four cells for the test to hold.
const LEAST: f64 = 5.0;

/// A station's first-pass yield next to that of all others.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Drift {
    /// Product and plan.
    #[serde(flatten)]
    pub plan: PlanName,
    /// The station.
    pub station: String,
    /// Its first-pass yield.
    pub here: Rate,
    /// That of all others.
    pub elsewhere: Rate,
    /// The chance of so great a difference between stations that are alike; `None` where too few units were judged to tell.
    pub chance: Option<f64>,
    /// Whether that is too small to be taken for chance, given how many stations can be compared under all plans.
    pub is_marked: bool,
}

/// Every station of every plan that more than one station has, from yields by station.
#[must_use]
pub fn drifts(lines: &[Yield]) -> Vec<Drift> {
    let mut plans = BTreeMap::<&PlanName, Vec<(&String, Rate)>>::new();
    for line in lines {
        if let Some(station) = &line.station {
            plans.entry(&line.plan).or_default().push((station, line.first_pass));
        }
    }
    plans.retain(|_, stations| stations.len() > 1);
    let mut drifts: Vec<_> =
        plans.into_iter().flat_map(|(plan, stations)| of_plan(plan, &stations)).collect();
    // What could not be marked anyway is no comparison.
    let comparisons = drifts.iter().filter(|drift| drift.chance.is_some()).count();
    for drift in &mut drifts {
        drift.is_marked = drift.chance.is_some_and(|chance| chance < BY_CHANCE / comparisons as f64);
    }
    drifts
}

/// The stations of this plan, none of them marked yet.
fn of_plan(plan: &PlanName, stations: &[(&String, Rate)]) -> Vec<Drift> {
    let all = stations.iter().fold((0, 0), |(count, of), (_, rate)| (count + rate.count, of + rate.of));
    let drift = |(station, here): &(&String, Rate)| {
        let elsewhere = Rate::new(all.0 - here.count, all.1 - here.of);
        let chance = chance(here, &elsewhere);
        Drift {
            plan: plan.clone(),
            station: (*station).clone(),
            here: *here,
            elsewhere,
            chance,
            is_marked: false,
        }
    };
    stations.iter().map(drift).collect()
}

/// The chance of two shares that differ this much although those of the whole populations do not: the two-sided test
/// of two proportions with a pooled variance (NIST/SEMATECH e-Handbook of Statistical Methods, 7.3.3).
fn chance(one: &Rate, other: &Rate) -> Option<f64> {
    let (n, m) = (one.of as f64, other.of as f64);
    let pooled = (one.count + other.count) as f64 / (n + m);
    let expected = n.min(m) * pooled.min(1.0 - pooled);
    if expected.is_nan() || expected < LEAST {
        return None;
    }
    let deviation = (pooled * (1.0 - pooled) * (1.0 / n + 1.0 / m)).sqrt();
    let z = (one.count as f64 / n - other.count as f64 / m) / deviation;
    Some(libm::erfc(z.abs() / std::f64::consts::SQRT_2))
}
