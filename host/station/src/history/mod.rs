//! What was judged. These functions read and change nothing; commands and pages call the same ones.
//!
//! ```text
//!  runs     pages of runs, by filters and by the last key of the page before
//!  unit     a serial number with all that is known of it
//!  yields   first-pass and final yield, with their intervals
//!  control  whether a yield is still what it has always been
//!  drift    whether a station judges differently from the others
//!  pareto   what fails most, by part and by check
//!  stations those of a plant, as it last heard from them
//!  mismatch what two stations of a plant bound differently
//!  counts   runs by verdict, for callers that ask every few seconds
//!  paced    what is not found anew at each of their questions
//! ```
//!
//! Each takes a [`Snapshot`], so everything that one page shows is of the same moment.

pub mod control;
pub mod counts;
pub mod drift;
pub mod mismatch;
pub mod paced;
pub mod pareto;
pub mod rate;
pub mod runs;
pub mod stations;
pub mod unit;
pub mod yields;

use std::collections::{BTreeMap, BTreeSet};

use jiff::civil::Date;
use jiff::{Timestamp, ToSpan as _, tz::TimeZone};

use crate::plan::PlanName;
use crate::store::{DatabaseError, Found, Snapshot, StoreError, statements};

/// The time in which runs began, in milliseconds since 1970, UTC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Period {
    /// The first moment.
    pub from_ms: i64,
    /// The first moment after it.
    pub until_ms: i64,
}

impl Default for Period {
    fn default() -> Self {
        Self { from_ms: 0, until_ms: i64::MAX }
    }
}

impl Period {
    fn holds(self, ms: i64) -> bool {
        (self.from_ms..self.until_ms).contains(&ms)
    }
}

/// Milliseconds since 1970 of a moment or, for a date, of the midnight UTC that begins the day `days` after it.
pub(crate) fn moment(text: &str, days: i64) -> Option<i64> {
    let midnight = |date: Date| date.checked_add(days.days()).and_then(|date| date.to_zoned(TimeZone::UTC));
    // A time without an offset is no moment, and must not be taken for its date.
    let date = || Date::strptime("%Y-%m-%d", text).and_then(midnight).map(|zoned| zoned.timestamp());
    let moment = text.parse::<Timestamp>().or_else(|_| date());
    moment.map(Timestamp::as_millisecond).ok().filter(|ms| *ms >= 0)
}

/// The plans of the station, by their hashes.
fn plans(of: &Snapshot) -> Result<BTreeMap<String, PlanName>, StoreError> {
    let plans = of.rows("to tell its plans", statements::PLANS, &[], |row| {
        Ok((row.get(0)?, PlanName { product: row.get(1)?, plan: row.get(2)? }))
    })?;
    Ok(plans.into_iter().collect())
}

/// What is compared at this station, each once, in order.
pub(crate) fn plan_names(of: &Snapshot) -> Result<BTreeSet<PlanName>, StoreError> {
    Ok(plans(of)?.into_values().collect())
}

/// The hashes of the plans of this product and of this name; `None` if neither is asked for.
fn plans_asked(
    of: &Snapshot,
    product: Option<&str>,
    name: Option<&str>,
) -> Result<Option<Vec<String>>, StoreError> {
    if product.is_none() && name.is_none() {
        return Ok(None);
    }
    let is_asked = |plan: &PlanName| {
        product.is_none_or(|product| product == plan.product) && name.is_none_or(|name| name == plan.plan)
    };
    Ok(Some(plans(of)?.into_iter().filter(|(_, plan)| is_asked(plan)).map(|(hash, _)| hash).collect()))
}

/// A number of things, which is never negative.
fn count(row: &Found<'_>, column: usize) -> Result<u64, DatabaseError> {
    row.get::<i64>(column).map(i64::unsigned_abs)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_last_day_is_among_what_is_wanted_and_a_moment_is_the_first_after() {
        // 22 November 2026, midnight UTC.
        let day = 1_795_305_600_000;
        assert_eq!((moment("2026-11-22", 0), moment("2026-11-22", 1)), (Some(day), Some(day + 86_400_000)));
        assert_eq!(moment("2026-11-22T01:00:00+01:00", 1), Some(day));
        for wrong in ["", "yesterday", "2026-13-01", "1969-01-01", "2026-11-22T06:00:00"] {
            assert_eq!(moment(wrong, 0), None, "{wrong}");
        }
    }
}
