//! A row's table entry with any value, found from the row itself.

use std::cmp::Reverse;
use std::ops::RangeInclusive;

use halfrow_model::{RowFactor, source_by_entry};

use super::first_where;
use super::row_factor::with_entry;
use super::table_word::{Word, changed};
use crate::diagnosis::datapath::{RowTables, Stretch};
use crate::diagnosis::hypothesis::Hypothesis;
use crate::diagnosis::witnesses::{Witness, Witnesses};
use crate::result::Defect;
use crate::tables::Generation;

/// Outputs that may be simulated for one row before the search is given up.
const BUDGET: usize = 1_000_000;
/// Frames in which the row must agree.
const FRAMES: usize = 32;

/// The factors that rows were really made with, if few rows differ. Each generation is searched separately: a cell that lost
/// several bits holds another value in each. Entries that are one bit off were tried before.
pub(super) fn propose<'a>(witnesses: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    witnesses.few_rows().iter().filter_map(|&row| any_value(witnesses, row)).collect()
}

/// What a row was made with instead of its entry in the tables of one generation.
struct Found {
    generation: u8,
    uploaded: u32,
    factors: Vec<RangeInclusive<u32>>,
}

fn any_value<'a>(witnesses: &Witnesses<'a>, row: usize) -> Option<Hypothesis<'a>> {
    let generations = witnesses.generations();
    let mut seen: Vec<_> = generations.iter().filter_map(|uploaded| seen(witnesses, uploaded, row)).collect();
    seen.sort_by_key(|rows| Reverse(rows.first().map(|row| row.differences)));
    let mut budget = BUDGET;
    let mut found: Vec<_> = seen.iter().filter_map(|rows| search(rows, &mut budget)).collect();
    found.sort_by_key(|found| found.generation);
    let is_off_by = |bit: u32| found.iter().all(|found| found.has(found.uploaded ^ (1_u32 << bit)));
    if (0..RowFactor::BITS).any(is_off_by) {
        return None;
    }
    let &Found { generation, uploaded, ref factors } = found.last()?;
    let (&least, &most) = (factors.first()?.start(), factors.last()?.end());
    let only = found.len() < generations.len();
    let defect = Defect::RowFactorWrong { row, generation, least, most, uploaded, only };
    let entry = |found: &Found| Some((found.generation, *found.factors.first()?.start()));
    let read: Vec<Word> = found.iter().filter_map(entry).collect();
    let ring = witnesses.case.ring;
    Some(Hypothesis::new(defect, move |witness| {
        let read = changed(&read, witness.uploaded).filter(|_| witness.row == row);
        read.map(|entry| with_entry(witness, entry, ring))
    }))
}

/// The row in the frames made with these tables, those that differ most first; none if it differs in none.
fn seen<'w, 'a>(
    witnesses: &'w Witnesses<'a>,
    uploaded: &Generation,
    row: usize,
) -> Option<Vec<&'w Witness<'a>>> {
    let is_seen = |witness: &&Witness<'_>| witness.row == row && witness.uploaded.number == uploaded.number;
    let mut seen: Vec<_> = witnesses.sample(usize::MAX).filter(is_seen).collect();
    seen.sort_by_key(|witness| Reverse(witness.differences));
    seen.truncate(FRAMES);
    seen.first().is_some_and(|witness| witness.differences > 0).then_some(seen)
}

fn search(seen: &[&Witness<'_>], budget: &mut usize) -> Option<Found> {
    let first = seen.first()?;
    let uploaded = first.uploaded.tables.row_factor(first.row)?.get();
    let factors = matching_factors(seen, budget).filter(|factors| !factors.is_empty())?;
    Some(Found { generation: first.uploaded.number, uploaded, factors })
}

impl Found {
    fn has(&self, factor: u32) -> bool {
        self.factors.iter().any(|range| range.contains(&factor))
    }
}

/// The factors that give every sample of the row, as ascending ranges; none if the search exceeds its budget.
///
/// The farther an output is from the optical centre, the more finely its source depends on the factor. So the search starts with
/// the ranges of factors that give the samples next to the centre, divides them output by output, and drops those that give
/// another sample.
fn matching_factors(seen: &[&Witness<'_>], budget: &mut usize) -> Option<Vec<RangeInclusive<u32>>> {
    let first = seen.first()?;
    let geometry = first.geometry();
    let distance = |column: &usize| (2 * *column as i64 - i64::from(geometry.centre2())).unsigned_abs();
    let mut columns: Vec<_> = (0..geometry.width()).filter(|column| distance(column) > 0).collect();
    columns.sort_by_key(distance);
    let mut ranges = vec![RowFactor::RANGE];
    for column in columns {
        let mut kept: Vec<RangeInclusive<u32>> = Vec::new();
        for range in ranges {
            let mut start = *range.start();
            while start <= *range.end() {
                *budget = budget.checked_sub(1)?;
                let end = last_alike(first, start, column, *range.end());
                if seen.iter().all(|row| gives(row, start, column)) {
                    join(&mut kept, start..=end);
                }
                start = end + 1;
            }
        }
        ranges = kept;
    }
    Some(ranges)
}

/// The largest factor up to `limit` that takes `column` from the same source as `factor` does. The source moves in one direction
/// as the factor grows.
fn last_alike(row: &Witness<'_>, factor: u32, column: usize, limit: u32) -> u32 {
    let source = |factor| source_by_entry(row.geometry().centre2(), factor, column);
    let here = source(factor);
    first_where(factor.into()..i64::from(limit) + 1, |other| source(other as u32) != here) as u32 - 1
}

fn gives(row: &Witness<'_>, entry: u32, column: usize) -> bool {
    let tables = RowTables { stretch: Stretch::Factor(entry), ..row.tables() };
    row.found.get(column) == Some(&tables.output(row.samples(), column))
}

/// Appends a range, joined with the last one if it touches that.
fn join(ranges: &mut Vec<RangeInclusive<u32>>, range: RangeInclusive<u32>) {
    match ranges.last_mut() {
        Some(last) if last.end() + 1 == *range.start() => *last = *last.start()..=*range.end(),
        _ => ranges.push(range),
    }
}
