//! Yield: how many units are judged good, at first and in the end.
//!
//! A unit belongs to the lane and the day of its first judgement, so that both yields are of the same units.
//!
//! | run | where it counts |
//! |---|---|
//! | PASS, FAIL | the first one of a unit in the first pass, the last one in the final yield |
//! | ERROR, crashes and refusals among them | only in the rate of errors: the unit was not judged |
//! | open, or of a unit that checks a shift | nowhere |
//! | FAIL with a waiver | as the FAIL that it is; if it is the unit's last judgement, the unit counts as waived, too |

use std::collections::BTreeMap;
use std::ops::Range;

use clap::ValueEnum;
use halfrow::Verdict;
use jiff::civil::Date;
use jiff::{SignedDuration, Timestamp, tz};
use serde::Serialize;

use super::control::{Limits, limits};
use super::rate::Rate;
use super::{Period, PlanName, count, plans};
use crate::clock::DAY_MS;
use crate::store::{DatabaseError, Found, Snapshot, StoreError, statements, values};

/// What the lines of a yield are about, beside product and plan.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum By {
    /// Plan
    #[default]
    Plan,
    /// Day, UTC
    Day,
    /// Week, UTC, from Monday on
    Week,
    /// Lane
    Lane,
    /// Station
    Station,
}

/// Which units are wanted; all of them by default.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Wanted {
    /// Of this product.
    pub product: Option<String>,
    /// Under plans of this name.
    pub plan: Option<String>,
    /// At this station.
    pub station: Option<String>,
    /// In this lane.
    pub lane: Option<String>,
    /// First judged in this period; for errors, begun in it.
    pub period: Period,
}

impl Wanted {
    fn is_wanted(&self, cell: &DayCell) -> bool {
        self.product.as_ref().is_none_or(|product| *product == cell.plan.product)
            && self.plan.as_ref().is_none_or(|plan| *plan == cell.plan.plan)
            && self.station.as_ref().is_none_or(|station| *station == cell.station)
            && self.lane.as_ref().is_none_or(|lane| *lane == cell.lane)
    }
}

/// The yield of one line.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Yield {
    /// Product and plan.
    #[serde(flatten)]
    pub plan: PlanName,
    /// The day, UTC, in a yield by day.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub day: Option<Date>,
    /// The Monday of the week, UTC, in a yield by week.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub week: Option<Date>,
    /// The station, in a yield by lane or by station.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub station: Option<String>,
    /// The lane, in a yield by lane.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lane: Option<String>,
    /// Units whose first judgement is PASS, of those that were judged.
    pub first_pass: Rate,
    /// What the first-pass yield of a day or a week may be if nothing has changed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limits: Option<Limits>,
    /// Units whose last judgement is PASS, of the same units.
    pub last: Rate,
    /// Units whose last judgement is a FAIL with a waiver.
    pub waived: u64,
    /// Units that failed at first and passed in the end.
    pub flipped: u64,
    /// Runs that are ERROR, of all that are over.
    pub errors: Rate,
    /// Those of them whose cause is `crash`: the lane, the program or the computer did not survive the run.
    pub crashes: u64,
}

/// A unit that failed at first and passed in the end.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Flip {
    /// Product and plan.
    #[serde(flatten)]
    pub plan: PlanName,
    /// The serial number.
    pub serial: String,
    /// The run that failed.
    pub failed: String,
    /// When it began, in milliseconds since 1970, UTC.
    pub failed_ms: i64,
    /// The run that passed, the last judgement.
    pub passed: String,
    /// When it began.
    pub passed_ms: i64,
    /// Judgements from the first to the last.
    pub judgements: u64,
}

/// What came of the units that are wanted.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Yields {
    /// A line for each group.
    pub lines: Vec<Yield>,
    /// Every unit that flipped from FAIL to PASS.
    pub flips: Vec<Flip>,
}

/// The yield of the units that are wanted, by plan and by what `by` says.
///
/// # Errors
/// [`StoreError`] when the database cannot be read.
pub fn yields(of: &Snapshot, wanted: &Wanted, by: By) -> Result<Yields, StoreError> {
    let plans = plans(of)?;
    let mut cells = cells(of, wanted, &plans)?;
    let again = again(of, wanted.period, &plans)?;
    let waived = waived(of, &plans)?;
    let mut flips = Vec::new();
    for unit in &again {
        if let Some(counts) = cells.get_mut(&unit.cell).filter(|_| wanted.is_wanted(&unit.cell)) {
            counts.adjust(unit.first_passed, unit.last_passed);
            counts.waived += u64::from(waived.contains_key(&unit.last));
            if unit.is_flip() {
                flips.push(unit.flip());
            }
        }
    }
    for (cell, started_ms, _) in waived.values().filter(|(.., is_only)| *is_only) {
        let is_wanted = wanted.is_wanted(cell) && wanted.period.holds(*started_ms);
        if let Some(counts) = cells.get_mut(cell).filter(|_| is_wanted) {
            counts.waived += 1;
        }
    }
    flips.sort();
    Ok(Yields { lines: lines(&cells, by), flips })
}

/// The judged runs that are wanted, by product; no product of which none was judged.
pub(super) fn judged(of: &Snapshot, wanted: &Wanted) -> Result<BTreeMap<String, u64>, StoreError> {
    let mut products = BTreeMap::<_, u64>::new();
    for (cell, counts) in cells(of, wanted, &plans(of)?)? {
        *products.entry(cell.plan.product).or_default() += counts.runs.saturating_sub(counts.errors);
    }
    products.retain(|_, judged| *judged > 0);
    Ok(products)
}

/// What is counted together.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct DayCell {
    plan: PlanName,
    station: String,
    lane: String,
    day: i64,
}

#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    runs: u64,
    errors: u64,
    crashes: u64,
    units: u64,
    first: u64,
    last: u64,
    waived: u64,
    flipped: u64,
}

impl Counts {
    fn add(&mut self, other: &Self) {
        self.runs += other.runs;
        self.errors += other.errors;
        self.crashes += other.crashes;
        self.units += other.units;
        self.first += other.first;
        self.last += other.last;
        self.waived += other.waived;
        self.flipped += other.flipped;
    }

    /// Corrects the counts for a unit that was counted by its first judgement, and has been judged since.
    fn adjust(&mut self, first_passed: bool, last_passed: bool) {
        match (first_passed, last_passed) {
            (false, true) => {
                self.last += 1;
                self.flipped += 1;
            }
            // In a database that `check` complains about there may be none.
            (true, false) => self.last = self.last.saturating_sub(1),
            _ => {}
        }
    }
}

/// Every cell, with its units as of their first judgement: whole days as they were counted when their runs ended, and
/// parts of days from the runs.
fn cells(
    of: &Snapshot,
    wanted: &Wanted,
    plans: &BTreeMap<String, PlanName>,
) -> Result<BTreeMap<DayCell, Counts>, StoreError> {
    let (days, rest) = in_days(wanted.period);
    let mut parts = vec![(statements::YIELD_DAYS, [days.start, days.end])];
    parts.extend(rest.map(|part| (statements::YIELD_HOURS, [part.from_ms, part.until_ms])));
    let mut cells = BTreeMap::<_, Counts>::new();
    for (text, [from, until]) in parts.into_iter().filter(|(_, [from, until])| from < until) {
        let counted = |row: &Found<'_>| counted(row, plans);
        for (cell, counts) in of.rows("to be counted", text, values![from, until], counted)? {
            if wanted.is_wanted(&cell) {
                cells.entry(cell).or_default().add(&counts);
            }
        }
    }
    Ok(cells)
}

/// The whole days of a period, and its parts before and after them.
fn in_days(Period { from_ms, until_ms }: Period) -> (Range<i64>, [Period; 2]) {
    let first = from_ms.div_euclid(DAY_MS) + i64::from(from_ms.rem_euclid(DAY_MS) > 0);
    // A period without an end has no part of a day after it.
    let end = if until_ms == i64::MAX { i64::MAX } else { until_ms.div_euclid(DAY_MS) };
    if first >= end {
        return (0..0, [Period { from_ms, until_ms }, Period { from_ms: 0, until_ms: 0 }]);
    }
    let after = end.saturating_mul(DAY_MS);
    (first..end, [Period { from_ms, until_ms: first * DAY_MS }, Period { from_ms: after, until_ms }])
}

/// The cell of a row, and what was counted there.
fn counted(row: &Found<'_>, plans: &BTreeMap<String, PlanName>) -> Result<(DayCell, Counts), DatabaseError> {
    let plan = plans.get(row.text(0)?).cloned().ok_or(DatabaseError::Dangling { what: "a plan" })?;
    let cell = DayCell { plan, station: row.get(1)?, lane: row.get(2)?, day: row.get(3)? };
    let [runs, errors, crashes, units, first] = [4, 5, 6, 7, 8].map(|column| count(row, column));
    let (first, rest) = (first?, Counts::default());
    let (runs, errors, crashes, units) = (runs?, errors?, crashes?, units?);
    let counts = Counts { runs, errors, crashes, units, first, last: first, ..rest };
    Ok((cell, counts))
}

/// A unit that was judged more than once.
struct Again {
    cell: DayCell,
    serial: String,
    first: String,
    first_ms: i64,
    first_passed: bool,
    last: String,
    last_ms: i64,
    last_passed: bool,
    judgements: u64,
}

impl Again {
    fn is_flip(&self) -> bool {
        !self.first_passed && self.last_passed
    }

    fn flip(&self) -> Flip {
        Flip {
            plan: self.cell.plan.clone(),
            serial: self.serial.clone(),
            failed: self.first.clone(),
            failed_ms: self.first_ms,
            passed: self.last.clone(),
            passed_ms: self.last_ms,
            judgements: self.judgements,
        }
    }
}

/// The units that were judged more than once, for the first time in this period.
fn again(
    of: &Snapshot,
    Period { from_ms, until_ms }: Period,
    plans: &BTreeMap<String, PlanName>,
) -> Result<Vec<Again>, StoreError> {
    let period = values![from_ms, until_ms];
    let rows = of.rows("to tell what was judged again", statements::RETESTS, period, |row| {
        let (hash, first_ms): (String, i64) = (row.get(1)?, row.get(6)?);
        let plan = plans.get(&hash).cloned().ok_or(DatabaseError::Dangling { what: "a plan" })?;
        let cell = DayCell { plan, station: row.get(2)?, lane: row.get(3)?, day: first_ms / DAY_MS };
        Ok(Again {
            cell,
            serial: row.get(0)?,
            judgements: count(row, 4)?,
            first: row.get(5)?,
            first_ms,
            first_passed: row.get::<Verdict>(7)? == Verdict::Pass,
            last: row.get(8)?,
            last_ms: row.get(9)?,
            last_passed: row.get::<Verdict>(10)? == Verdict::Pass,
        })
    })?;
    Ok(rows)
}

/// Every waived FAIL with its cell, when it began, and whether its unit was judged only once.
fn waived(
    of: &Snapshot,
    plans: &BTreeMap<String, PlanName>,
) -> Result<BTreeMap<String, (DayCell, i64, bool)>, StoreError> {
    let rows = of.rows("to tell its waivers", statements::WAIVED, &[], |row| {
        let (hash, started_ms): (String, i64) = (row.get(1)?, row.get(4)?);
        let plan = plans.get(&hash).cloned().ok_or(DatabaseError::Dangling { what: "a plan" })?;
        let cell = DayCell { plan, station: row.get(2)?, lane: row.get(3)?, day: started_ms / DAY_MS };
        Ok((row.get(0)?, (cell, started_ms, row.get(5)?)))
    })?;
    Ok(rows.into_iter().collect())
}

/// What a line is for, in addition to the plan: the first day of its time, its station, and its lane there.
type Group = (Option<i64>, Option<String>, Option<String>);

/// Adds the cells up to lines.
fn lines(cells: &BTreeMap<DayCell, Counts>, by: By) -> Vec<Yield> {
    let mut groups = BTreeMap::<(PlanName, Group), Counts>::new();
    for (cell, counts) in cells {
        groups.entry((cell.plan.clone(), group(cell, by))).or_default().add(counts);
    }
    let mut lines: Vec<_> = groups.into_iter().map(|(key, counts)| line(key, &counts, by)).collect();
    if matches!(by, By::Day | By::Week) {
        for of_plan in lines.chunk_by_mut(|one, other| one.plan == other.plan) {
            let rates: Vec<_> = of_plan.iter().map(|line| line.first_pass).collect();
            for (line, limits) in of_plan.iter_mut().zip(limits(&rates)) {
                line.limits = limits;
            }
        }
    }
    lines
}

fn group(cell: &DayCell, by: By) -> Group {
    match by {
        By::Plan => (None, None, None),
        By::Day => (Some(cell.day), None, None),
        // 1 January 1970 was a Thursday.
        By::Week => (Some(cell.day - (cell.day + 3).rem_euclid(7)), None, None),
        By::Lane => (None, Some(cell.station.clone()), Some(cell.lane.clone())),
        By::Station => (None, Some(cell.station.clone()), None),
    }
}

fn line((plan, (day, station, lane)): (PlanName, Group), counts: &Counts, by: By) -> Yield {
    let day = day.and_then(date);
    Yield {
        plan,
        day: day.filter(|_| by == By::Day),
        week: day.filter(|_| by == By::Week),
        station,
        lane,
        first_pass: Rate::new(counts.first, counts.units),
        limits: None,
        last: Rate::new(counts.last, counts.units),
        waived: counts.waived,
        flipped: counts.flipped,
        errors: Rate::new(counts.errors, counts.runs),
        crashes: counts.crashes,
    }
}

/// The date that is `day` days after 1 January 1970.
fn date(day: i64) -> Option<Date> {
    let begun = Timestamp::UNIX_EPOCH.checked_add(SignedDuration::from_hours(24 * day)).ok()?;
    Some(begun.to_zoned(tz::TimeZone::UTC).date())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As in a database whose retests and counts contradict each other.
    #[test]
    fn of_no_units_none_are_left_when_one_fails_after_its_pass() {
        let mut counts = Counts::default();
        counts.adjust(true, false);
        assert_eq!(counts.last, 0);
    }
}
