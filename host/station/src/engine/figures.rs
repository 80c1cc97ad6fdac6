//! What is counted since the engine began, for whoever monitors stations from afar.

use std::collections::BTreeMap;
use std::time::Instant;

use parking_lot::Mutex;

use super::logged::reasons;
use crate::plan::PlanName;
use crate::record::Record;
use crate::settings::{LaneSettings, Settings};

/// The bounds by which the times of runs are counted, in seconds: from a frame over a fast link to a soak over a slow one.
const RUNS: [f64; 11] = [1.0, 2.0, 5.0, 10.0, 20.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1800.0];
/// The same for the times of saving: a healthy disk needs some milliseconds.
const COMMITS: [f64; 11] = [0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0];

/// A histogram of times.
#[derive(Clone, Debug, PartialEq)]
pub struct Histogram {
    bounds: [f64; 11],
    /// For each bound, how many are within it and beyond the one before; the last count is of those beyond all bounds.
    counts: [u64; 12],
    sum: f64,
}

impl Histogram {
    const fn new(bounds: [f64; 11]) -> Self {
        Self { bounds, counts: [0; 12], sum: 0.0 }
    }

    fn add(&mut self, seconds: f64) {
        let place = self.bounds.iter().take_while(|bound| seconds > **bound).count();
        if let Some(count) = self.counts.get_mut(place) {
            *count += 1;
        }
        self.sum += seconds;
    }

    /// Each bound, in seconds, with how many took no longer.
    pub fn up_to(&self) -> impl Iterator<Item = (f64, u64)> {
        let so_far = self.counts.iter().scan(0, |sum, count| {
            *sum += count;
            Some(*sum)
        });
        self.bounds.iter().copied().zip(so_far)
    }

    /// How many there were.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.counts.iter().sum()
    }

    /// How long they took together, in seconds.
    #[must_use]
    pub const fn sum(&self) -> f64 {
        self.sum
    }
}

/// What was counted since the engine began.
#[derive(Clone, Debug, PartialEq)]
pub struct Figures {
    /// How long the runs of each plan took, by lane; without those of what checks a shift.
    pub runs: BTreeMap<(PlanName, String), Histogram>,
    /// How long it took to save a result, from the end of its lane until it was read back.
    pub commits: Histogram,
    /// How often the process of each lane had to be killed.
    pub kills: BTreeMap<String, u64>,
    /// How often the station itself began no run, by its reason.
    pub refusals: BTreeMap<&'static str, u64>,
}

impl Figures {
    /// Zeros for every plan and lane of these settings.
    fn of(settings: &Settings) -> Self {
        let plans = |lane: &LaneSettings| {
            let name = lane.name.clone();
            let plans = settings.plans_of(lane).map(|plan| PlanName::from(&plan.plan));
            plans.map(move |plan| ((plan, name.clone()), Histogram::new(RUNS))).collect::<Vec<_>>()
        };
        Self {
            runs: settings.lanes.iter().flat_map(plans).collect(),
            commits: Histogram::new(COMMITS),
            kills: settings.lanes.iter().map(|lane| (lane.name.clone(), 0)).collect(),
            refusals: reasons().map(|reason| (reason, 0)).collect(),
        }
    }
}

/// Figures that several lanes add to.
#[derive(Debug)]
pub(super) struct Counter {
    figures: Mutex<Figures>,
    /// The runs whose results are not saved yet, and when their lanes ended.
    unsaved: Mutex<BTreeMap<String, Instant>>,
}

impl Counter {
    pub(super) fn of(settings: &Settings) -> Self {
        Self { figures: Mutex::new(Figures::of(settings)), unsaved: Mutex::default() }
    }

    pub(super) fn now(&self) -> Figures {
        self.with(|figures| figures.clone())
    }

    /// Counts that the process of `lane` had to be killed.
    pub(super) fn killed(&self, lane: &str) {
        self.with(|figures| *figures.kills.entry(lane.to_owned()).or_default() += 1);
    }

    /// Counts that no run was begun for this reason.
    pub(super) fn refused(&self, reason: &'static str) {
        self.with(|figures| *figures.refusals.entry(reason).or_default() += 1);
    }

    /// Takes note that the lane of a run has ended.
    pub(super) fn ended(&self, run: &str) {
        self.unsaved.lock().insert(run.to_owned(), Instant::now());
    }

    /// Counts a run that is saved, however late; one whose verdict still waits for the plant is not counted again.
    pub(super) fn saved(&self, record: &Record) {
        let Record { seconds, run, plan, .. } = record;
        let Some(ended) = self.unsaved.lock().remove(&run.id) else { return };
        let took = ended.elapsed().as_secs_f64();
        self.with(|figures| {
            figures.commits.add(took);
            // Yields leave out what checks shifts, too.
            if let Some(seconds) = seconds.filter(|_| !record.is_of_reference()) {
                let plan = PlanName { product: run.product.clone(), plan: plan.name.clone() };
                let of = (plan, run.lane.clone());
                figures.runs.entry(of).or_insert(Histogram::new(RUNS)).add(seconds);
            }
        });
    }

    fn with<T>(&self, act: impl FnOnce(&mut Figures) -> T) -> T {
        act(&mut self.figures.lock())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_takes_just_a_bound_is_not_beyond_it() {
        let mut runs = Histogram::new(RUNS);
        for seconds in [0.0, 1.0, 1.001, 1800.0, 1801.0] {
            runs.add(seconds);
        }
        let up_to: Vec<_> = runs.up_to().collect();
        assert_eq!(up_to[..2], [(1.0, 2), (2.0, 3)]);
        assert_eq!((up_to[10], runs.count(), runs.sum()), ((1800.0, 4), 5, 3603.001));
    }
}
