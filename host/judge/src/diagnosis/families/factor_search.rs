//! A row's table entry with any value: found from the row itself.

use std::ops::RangeInclusive;

use halfrow_model::{RowFactor, source_by_entry};

use super::first_where;
use super::row_factor::{FEW_ROWS, with_entry};
use crate::diagnosis::datapath::{RowTables, Stretch};
use crate::diagnosis::hypothesis::Hypothesis;
use crate::diagnosis::witnesses::{Witness, Witnesses};
use crate::result::Defect;

/// Outputs that may be simulated for one row before the search is given up.
const BUDGET: usize = 1_000_000;
/// Frames whose row must agree.
const FRAMES: usize = 32;

/// The factors that rows were really made with, when few rows differ. Those that are one bit off were tried before.
pub(super) fn propose<'a>(witnesses: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    let rows = if witnesses.rows.len() <= FEW_ROWS { &witnesses.rows[..] } else { &[] };
    rows.iter().filter_map(|&row| any_value(witnesses, row)).collect()
}

fn any_value<'a>(witnesses: &Witnesses<'a>, row: usize) -> Option<Hypothesis<'a>> {
    let mut seen: Vec<_> = witnesses.sample(usize::MAX).filter(|witness| witness.row == row).collect();
    seen.sort_by_key(|witness| std::cmp::Reverse(witness.differences));
    let generation = seen.first()?.uploaded.generation;
    let uploaded = seen.first()?.uploaded.tables.row_factor(row)?.get();
    seen.retain(|witness| witness.uploaded.generation == generation);
    seen.truncate(FRAMES);
    let factors = matching_factors(&seen)?;
    let one_bit = |bit: u32| factors.iter().any(|range| range.contains(&(uploaded ^ (1_u32 << bit))));
    if (0..RowFactor::BITS).any(one_bit) {
        return None;
    }
    let (&least, &most) = (factors.first()?.start(), factors.last()?.end());
    let ring = witnesses.case.ring;
    let defect = Defect::RowFactorWrong { row, generation, least, most, uploaded };
    Some(Hypothesis::new(defect, move |witness| {
        let mine = witness.row == row && witness.uploaded.generation == generation;
        mine.then(|| with_entry(witness, least, ring))
    }))
}

/// The factors that give every sample of the row, in ascending ranges; none if there is none or too many are possible.
///
/// The farther an output is from the optical centre, the finer its source depends on the factor. So ranges of factors that
/// give the samples next to the centre are divided, output by output, and those that give another sample are dropped.
fn matching_factors(seen: &[&Witness<'_>]) -> Option<Vec<RangeInclusive<u32>>> {
    let first = seen.first()?;
    let geometry = first.geometry();
    let distance = |column: &usize| (2 * *column as i64 - i64::from(geometry.centre2())).unsigned_abs();
    let mut columns: Vec<_> = (0..geometry.width()).filter(|column| distance(column) > 0).collect();
    columns.sort_by_key(distance);
    let mut ranges = vec![RowFactor::RANGE];
    let mut budget = BUDGET;
    for column in columns {
        let mut kept: Vec<RangeInclusive<u32>> = Vec::new();
        for range in ranges {
            let mut start = *range.start();
            while start <= *range.end() {
                budget = budget.checked_sub(1)?;
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

/// The largest factor up to `limit` that takes `column` from the same source as `factor`: the source moves one way with the
/// factor.
fn last_alike(row: &Witness<'_>, factor: u32, column: usize, limit: u32) -> u32 {
    let source = |factor| source_by_entry(row.geometry(), factor, column);
    let here = source(factor);
    first_where(factor.into()..i64::from(limit) + 1, |other| source(other as u32) != here) as u32 - 1
}

fn gives(row: &Witness<'_>, entry: u32, column: usize) -> bool {
    let tables = RowTables { stretch: Stretch::Factor(entry), ..row.tables() };
    row.found.get(column) == Some(&tables.output(row.samples(), column))
}

/// Adds a range behind the others, joined with the last if it touches it.
fn join(ranges: &mut Vec<RangeInclusive<u32>>, range: RangeInclusive<u32>) {
    match ranges.last_mut() {
        Some(last) if last.end() + 1 == *range.start() => *last = *last.start()..=*range.end(),
        _ => ranges.push(range),
    }
}
