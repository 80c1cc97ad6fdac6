//! Runs by verdict, for callers that ask every few seconds.
//!
//! Runs and errors are counted when they end. FAIL is counted here, day by day; a day is counted again only when it
//! has another number of runs than at its last count. A verdict never changes, so only then can a day's FAIL change.
//! Where even the rest takes long, everything is counted less often.

use std::collections::BTreeMap;

use parking_lot::Mutex;

use super::paced::Paced;
use super::{PlanName, count, plans};
use crate::clock::DAY_MS;
use crate::store::{DatabaseError, Snapshot, StoreError, statements, values};

/// What is counted together.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Cell {
    /// Product and plan.
    pub plan: PlanName,
    /// The station.
    pub station: String,
    /// The lane; empty where all lanes of a station are counted together.
    pub lane: String,
}

/// Runs that are over, as yields count them, and the units that they judged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// Runs that are PASS.
    pub passed: u64,
    /// Runs that are FAIL.
    pub failed: u64,
    /// Runs that are ERROR.
    pub errors: u64,
    /// Units that were judged.
    pub units: u64,
    /// Those of them whose first judgement is PASS.
    pub first_passed: u64,
}

impl Count {
    /// Adds the counts of another one.
    pub fn add(&mut self, other: &Self) {
        self.passed += other.passed;
        self.failed += other.failed;
        self.errors += other.errors;
        self.units += other.units;
        self.first_passed += other.first_passed;
    }
}

/// What was counted so far.
#[derive(Debug)]
pub struct Tally {
    by_lane: bool,
    days: Mutex<BTreeMap<i64, Day>>,
    last: Paced<BTreeMap<Cell, Count>>,
}

/// A day, as last counted.
#[derive(Debug, Default)]
struct Day {
    runs: u64,
    failed: BTreeMap<Cell, u64>,
}

impl Tally {
    /// Nothing counted yet. With `by_lane` the lanes of a station are told apart. After each count it pauses `rests`
    /// times as long as that took, a minute at most, and returns the same result meanwhile.
    #[must_use]
    pub fn new(by_lane: bool, rests: u32) -> Self {
        Self { by_lane, days: Mutex::default(), last: Paced::new(rests) }
    }

    /// Counts every run that is over, except those of what checks a shift.
    ///
    /// # Errors
    /// [`StoreError`] when the database cannot be read.
    pub fn counts(&self, of: &Snapshot) -> Result<BTreeMap<Cell, Count>, StoreError> {
        self.last.get(|| self.now(&mut self.days.lock(), of))
    }

    fn now(&self, days: &mut BTreeMap<i64, Day>, of: &Snapshot) -> Result<BTreeMap<Cell, Count>, StoreError> {
        let plans = plans(of)?;
        let mut counts = BTreeMap::<Cell, Count>::new();
        for (cell, [runs, errors, units, first_passed]) in self.all(of, &plans)? {
            // What is not yet known to be FAIL is taken for PASS.
            let passed = runs.saturating_sub(errors);
            counts.entry(cell).or_default().add(&Count { passed, failed: 0, errors, units, first_passed });
        }
        self.count_anew(days, of, &plans)?;
        for (cell, failed) in days.values().flat_map(|day| &day.failed) {
            if let Some(count) = counts.get_mut(cell) {
                count.failed += failed;
                count.passed = count.passed.saturating_sub(*failed);
            }
        }
        Ok(counts)
    }

    /// Runs, errors, units and those that passed at first, by plan and lane.
    fn all(
        &self,
        of: &Snapshot,
        plans: &BTreeMap<String, PlanName>,
    ) -> Result<Vec<(Cell, [u64; 4])>, StoreError> {
        of.rows("to be counted", statements::COUNTS, &[], |row| {
            let cell = self.cell(plans, row.text(0)?, row.get(1)?, row.get(2)?)?;
            Ok((cell, [count(row, 3)?, count(row, 4)?, count(row, 5)?, count(row, 6)?]))
        })
    }

    /// Counts FAIL anew from the first to the last day whose number of runs has changed since it was counted.
    fn count_anew(
        &self,
        days: &mut BTreeMap<i64, Day>,
        of: &Snapshot,
        plans: &BTreeMap<String, PlanName>,
    ) -> Result<(), StoreError> {
        let now =
            of.rows("to be counted", statements::DAY_RUNS, &[], |row| Ok((row.get(0)?, count(row, 1)?)))?;
        let now: BTreeMap<i64, u64> = now.into_iter().collect();
        days.retain(|day, _| now.contains_key(day));
        let changed = |(day, runs): &(&i64, &u64)| days.get(*day).is_none_or(|known| known.runs != **runs);
        let mut changed = now.iter().filter(changed).map(|(day, _)| *day);
        let Some(first) = changed.next() else { return Ok(()) };
        let last = changed.next_back().unwrap_or(first);
        let between = values![first.saturating_mul(DAY_MS), last.saturating_add(1).saturating_mul(DAY_MS)];
        let failed = of.rows("to be counted", statements::FAILED_RUNS, between, |row| {
            let cell = self.cell(plans, row.text(0)?, row.get(1)?, row.get(2)?)?;
            Ok((row.get::<i64>(3)?, cell, count(row, 4)?))
        })?;
        days.extend(now.range(first..=last).map(|(day, &runs)| (*day, Day { runs, ..Day::default() })));
        for (day, cell, failed) in failed {
            *days.entry(day).or_default().failed.entry(cell).or_default() += failed;
        }
        Ok(())
    }

    fn cell(
        &self,
        plans: &BTreeMap<String, PlanName>,
        plan: &str,
        station: String,
        lane: String,
    ) -> Result<Cell, DatabaseError> {
        let plan = plans.get(plan).cloned().ok_or(DatabaseError::Dangling { what: "a plan" })?;
        Ok(Cell { plan, station, lane: if self.by_lane { lane } else { String::new() } })
    }
}
