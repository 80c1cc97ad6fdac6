//! What fails most.

use std::collections::BTreeMap;

use clap::ValueEnum;
use serde::Serialize;

use super::plans_asked;
use super::rate::Rate;
use super::yields::{Wanted, judged};
use crate::store::{Snapshot, StoreError, Value, statements};

/// What failures are counted by. A run has one part or none, and may have several checks: limits that blame the board, and
/// steps that failed by more than their limits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Of {
    /// The part that is suspected first
    #[default]
    Part,
    /// The limit or the step that failed; a run counts with each
    Check,
}

/// One cause of failures.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bar {
    /// The part, the measurement or the step; empty where no part is suspected.
    pub name: String,
    /// Runs that failed with it, of all failed runs.
    pub runs: Rate,
    /// Units among them.
    pub units: u64,
}

/// The failures of the runs that are wanted.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Pareto {
    /// The products of the runs that were judged.
    pub products: Vec<String>,
    /// Runs that were judged: that passed or failed.
    pub judged: u64,
    /// Those of them that failed.
    pub failed: u64,
    /// Units among them.
    pub units: u64,
    /// The most frequent cause first; equally frequent ones by name.
    pub bars: Vec<Bar>,
}

/// What failed in the runs that are wanted.
///
/// # Errors
/// [`StoreError`] when the database cannot be read.
pub fn pareto(of: &Snapshot, wanted: &Wanted, by: Of) -> Result<Pareto, StoreError> {
    let plans = plans_asked(of, wanted.product.as_deref(), wanted.plan.as_deref())?;
    let period = wanted.period;
    let kind = match by {
        Of::Part => "part",
        Of::Check => "check",
    };
    let mut values: Vec<Value<'_>> = vec![kind.into(), period.from_ms.into(), period.until_ms.into()];
    let filters = filters(wanted, plans.as_deref(), &mut values);
    let mut counted = Counted::default();
    let text = statements::FAILURES.replace("{filters}", &filters);
    of.rows("to tell its failures", &text, &values, |row| {
        counted.add(row.text(0)?, row.text(1)?, row.text(2)?);
        Ok(())
    })?;
    Ok(counted.pareto(judged(of, wanted)?))
}

/// The conditions for what is wanted apart from its time, with plans by their hashes. Their values are appended to
/// `values`.
fn filters<'a>(wanted: &'a Wanted, plans: Option<&'a [String]>, values: &mut Vec<Value<'a>>) -> String {
    let mut filters = String::new();
    if let Some(lane) = &wanted.lane {
        values.push(lane.into());
        filters.push_str(&format!(" AND lane = ${}", values.len()));
    }
    if let Some(station) = &wanted.station {
        values.push(station.into());
        // A failure has the lane of its run, and not the station.
        filters.push_str(&format!(
            " AND EXISTS (SELECT 1 FROM run WHERE run.id = failure.run_id AND run.station = ${})",
            values.len()
        ));
    }
    if let Some(plans) = plans {
        let named: Vec<_> =
            plans.iter().zip(values.len() + 1..).map(|(_, place)| format!("${place}")).collect();
        values.extend(plans.iter().map(Value::from));
        // If there is no such plan, no run matches.
        let named = if named.is_empty() { "NULL".to_owned() } else { named.join(", ") };
        filters.push_str(&format!(" AND plan_sha256 IN ({named})"));
    }
    filters
}

/// What was counted so far. Failures come unit by unit, and within a unit run by run.
#[derive(Default)]
struct Counted {
    failed: u64,
    units: u64,
    unit: String,
    run: String,
    /// By name: runs, units, and the number of the last unit.
    names: BTreeMap<String, (u64, u64, u64)>,
}

impl Counted {
    fn add(&mut self, unit: &str, run: &str, name: &str) {
        if self.unit != unit {
            self.units += 1;
            unit.clone_into(&mut self.unit);
        }
        if self.run != run {
            self.failed += 1;
            run.clone_into(&mut self.run);
        }
        if !self.names.contains_key(name) {
            self.names.insert(name.to_owned(), (0, 0, 0));
        }
        if let Some((runs, units, last)) = self.names.get_mut(name) {
            *runs += 1;
            *units += u64::from(*last != self.units);
            *last = self.units;
        }
    }

    fn pareto(self, judged: BTreeMap<String, u64>) -> Pareto {
        let Self { failed, units, names, .. } = self;
        let bar = |(name, (runs, units, _))| Bar { name, runs: Rate::new(runs, failed), units };
        let mut bars: Vec<_> = names.into_iter().map(bar).collect();
        bars.sort_by(|one, other| {
            other.runs.count.cmp(&one.runs.count).then_with(|| one.name.cmp(&other.name))
        });
        let all = judged.values().sum();
        Pareto { products: judged.into_keys().collect(), judged: all, failed, units, bars }
    }
}
