//! An address line stuck in a ring whose count is not known to have begun with the run.

use super::memory_address::{self, BrokenRing, Origin};
use crate::diagnosis::hypothesis::{Hypothesis, Score};
use crate::diagnosis::witnesses::{Witness, Witnesses};
use crate::result::Counting;

/// The share of a row that the right count must explain.
const ENOUGH: f64 = 0.95;

/// The address line and the count that explain the row that differs most, when there are such.
pub(super) fn propose<'a>(witnesses: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    let Some(row) = witnesses.differing.iter().max_by_key(|row| row.differences) else { return Vec::new() };
    memory_address::rings(witnesses)
        .filter_map(|ring| {
            Some(memory_address::hypothesis(ring, Origin::Run(best_count(ring, row)?), Counting::Before))
        })
        .collect()
}

/// The count at the run's first sample that explains `row` best. Which addresses share a cell repeats with twice the
/// distance of the two.
fn best_count(ring: BrokenRing, row: &Witness<'_>) -> Option<usize> {
    let period = 2 << ring.bit;
    let share = |first| {
        let base = Origin::Run(first).base(row);
        Score::of_row(&ring.before_next_row(row, base), row).share()
    };
    let likely = (0..period).map(|first| (first, share(first))).filter(|(_, share)| *share >= ENOUGH);
    likely.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(first, _)| first)
}
