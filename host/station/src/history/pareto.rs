//! What fails most.

use rusqlite::ToSql;
use serde::Serialize;

use super::rate::Rate;
use super::yields::Wanted;
use super::{count, plans_named};
use crate::store::{Snapshot, StoreError, statements};

/// What failures are counted by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Of {
    /// The part that is suspected first. A run has one or none.
    Part,
    /// What failed: a limit that blames the board, or a step by more than its limits. A run may have several.
    Check,
}

/// One cause of failures.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bar {
    /// The part, the measurement or the step; empty where no part is suspected.
    pub name: String,
    /// Runs that failed with it, of all that failed.
    pub runs: Rate,
    /// Units among them.
    pub units: u64,
}

/// The failures of the runs that are wanted.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Pareto {
    /// Runs that failed.
    pub failed: u64,
    /// Units among them.
    pub units: u64,
    /// The most frequent cause first; of two that are as frequent, by name.
    pub bars: Vec<Bar>,
}

/// What failed in the runs that are wanted.
///
/// # Errors
/// [`StoreError`] when the database cannot be read.
pub fn pareto(of: &Snapshot, wanted: &Wanted, by: Of) -> Result<Pareto, StoreError> {
    let plans = wanted.plan.as_deref().map(|name| plans_named(of, name)).transpose()?;
    let period = wanted.period;
    let mut values: Vec<&dyn ToSql> = vec![&period.from_ms, &period.until_ms];
    let mut filters = String::new();
    if let Some(lane) = &wanted.lane {
        values.push(lane);
        filters.push_str(&format!("AND run.lane = ${}", values.len()));
    }
    if let Some(plans) = &plans {
        let named: Vec<_> =
            plans.iter().zip(values.len() + 1..).map(|(_, place)| format!("${place}")).collect();
        values.extend(plans.iter().map(|plan| plan as &dyn ToSql));
        // No plan of this name has no run.
        let named = if named.is_empty() { "NULL".to_owned() } else { named.join(", ") };
        filters.push_str(&format!(" AND run.plan_sha256 IN ({named})"));
    }
    let bars = match by {
        Of::Part => statements::PARETO_PARTS,
        Of::Check => statements::PARETO_CHECKS,
    };
    let doing = "to tell its failures";
    let of_all = |row: &rusqlite::Row<'_>| Ok((count(row, 0)?, count(row, 1)?));
    let all = of.rows(doing, &statements::FAILED.replace("{filters}", &filters), &values, of_all)?;
    let (failed, units) = all.into_iter().next().unwrap_or_default();
    let mut bars = of.rows(doing, &bars.replace("{filters}", &filters), &values, |row| {
        Ok(Bar { name: row.get(0)?, runs: Rate::new(count(row, 1)?, failed), units: count(row, 2)? })
    })?;
    bars.sort_by(|one, other| other.runs.count.cmp(&one.runs.count).then_with(|| one.name.cmp(&other.name)));
    Ok(Pareto { failed, units, bars })
}
