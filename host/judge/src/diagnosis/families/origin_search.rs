//! A stuck address line in a ring whose count is not known to have begun with the run.

use super::memory_address::{self, BrokenRing, Origin};
use crate::diagnosis::hypothesis::{Hypothesis, Score};
use crate::diagnosis::witnesses::{Witness, Witnesses};
use crate::result::Counting;

/// The share of a row that the right count must explain.
const ENOUGH: f64 = 0.95;
/// Rows by which a count is weighed. A single row may not do: one that is stretched much reads few columns, so many counts give
/// it equally.
const ROWS: usize = 8;

/// Each address line with the count that best explains the rows that differ most, if there is such a count.
pub(super) fn propose<'a>(witnesses: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    let rows = rows_that_differ_most(witnesses);
    memory_address::rings(witnesses)
        .filter_map(|ring| {
            let first = best_count(ring, &rows)?;
            Some(memory_address::hypothesis(ring, Origin::Run(first), Counting::Before))
        })
        .collect()
}

/// The rows that differ most in the outputs that depend only on the row itself, in descending order.
fn rows_that_differ_most<'w, 'a>(witnesses: &'w Witnesses<'a>) -> Vec<&'w Witness<'a>> {
    let differences = |row: &Witness<'_>| {
        let sure = memory_address::sure(row.found.len());
        row.differing_columns().filter(|column| sure.contains(column)).count()
    };
    let mut rows: Vec<_> = witnesses.differing.iter().map(|row| (differences(row), row)).collect();
    rows.sort_by_key(|(differences, _)| std::cmp::Reverse(*differences));
    rows.into_iter().take(ROWS).map(|(_, row)| row).collect()
}

/// The count at the run's first sample that explains the first of `rows` and, of those that do, explains all of them best. Which
/// addresses share a cell repeats with twice the distance between the two.
fn best_count(ring: BrokenRing, rows: &[&Witness<'_>]) -> Option<usize> {
    let share = |first, row: &Witness<'_>| {
        let base = Origin::Run(first).base(row);
        Score::of_row(&ring.before_next_row(row, base), row).share()
    };
    let foremost = rows.first()?;
    let likely = (0..2 << ring.bit).filter(|&first| share(first, foremost) >= ENOUGH);
    let weighed = likely.map(|first| (first, rows.iter().map(|row| share(first, row)).sum::<f64>()));
    weighed.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(first, _)| first)
}
