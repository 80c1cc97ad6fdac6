//! Rows that hold the samples of another place.

use std::collections::{BTreeMap, BTreeSet};

use halfrow_protocol::samples::{pack, unpack};

use crate::diagnosis::Case;
use crate::diagnosis::hypothesis::{Hypothesis, Prediction};
use crate::diagnosis::witnesses::{Witness, Witnesses};
use crate::result::{Defect, RowSource};

/// Rows whose source is searched for.
const ROWS: usize = 96;
/// How many row banks a board may plausibly confuse, and by how many columns a row may plausibly be shifted.
const NEAR: isize = 8;

/// Rows exchanged, shifted sideways, packed the other way round, or lost.
pub(super) fn propose<'a>(witnesses: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    let shifts = (1..=NEAR).flat_map(|columns| [shifted(-columns), shifted(columns)]);
    let packed = [false, true].map(pair_bytes_reversed);
    shifts
        .chain([pairs_exchanged()])
        .chain(packed)
        .chain(lost(witnesses))
        .chain(exchanged(witnesses))
        .collect()
}

fn exchanged<'a>(witnesses: &Witnesses<'a>) -> Option<Hypothesis<'a>> {
    let case = witnesses.case;
    let mut places: BTreeMap<RowSource, usize> = BTreeMap::new();
    for row in witnesses.differing.iter().take(ROWS) {
        if let Some(place) = place(&case, row) {
            *places.entry(place).or_default() += 1;
        }
    }
    let (&commonest, _) = places.iter().max_by_key(|(_, count)| **count)?;
    let defect = Defect::RowsExchanged { source: commonest, mostly: places.len() > 1 };
    // A row is found as a whole or not at all, so its place predicts what was found.
    Some(Hypothesis::new(defect, move |row| place(&case, row).map(|_| row.found.to_vec().into())))
}

/// Where the samples of a differing row come from, the nearest place first. A uniform row may come from anywhere, so it has no
/// place.
fn place(case: &Case<'_>, row: &Witness<'_>) -> Option<RowSource> {
    let uniform = row.found.windows(2).all(|pair| pair.first() == pair.last());
    if row.differences == 0 || uniform {
        return None;
    }
    let near = (1..=NEAR).flat_map(|distance| [-distance, distance]);
    in_frame(case, row, row.frame).or_else(|| near.into_iter().find_map(|rows| of_input(row, rows))).or_else(
        || {
            let frames = case.evidence.iter().map(|evidence| evidence.index);
            frames.filter(|&frame| frame != row.frame).find_map(|frame| in_frame(case, row, frame))
        },
    )
}

/// The nearest row of the reference's frame that the board gave instead.
fn in_frame(case: &Case<'_>, row: &Witness<'_>, frame: usize) -> Option<RowSource> {
    let evidence = case.evidence.iter().find(|evidence| evidence.index == frame)?;
    let rows = evidence.expected.rows().enumerate();
    let same = rows.filter(|(_, samples)| *samples == row.found).map(|(index, _)| index);
    let nearest = same.min_by_key(|index| index.abs_diff(row.row))?;
    let distance = |to: usize, from: usize| to as isize - from as isize;
    Some(RowSource::Output { frames: distance(frame, row.frame), rows: distance(nearest, row.row) })
}

fn of_input(row: &Witness<'_>, rows: isize) -> Option<RowSource> {
    (row.tables().corrected(row.samples_at(rows)?) == row.found).then_some(RowSource::Input { rows })
}

/// Every row shifted sideways. What comes in at its end is not known.
fn shifted<'a>(columns: isize) -> Hypothesis<'a> {
    Hypothesis::new(Defect::RowShifted { columns }, move |row| {
        let width = row.expected.len();
        let sample =
            |column: usize| column.checked_add_signed(-columns).and_then(|from| row.expected.get(from));
        let samples = (0..width).map(|column| sample(column).copied().unwrap_or_default()).collect();
        let lost = columns.unsigned_abs().min(width);
        let known = if columns < 0 { 0..width - lost } else { lost..width };
        Some(Prediction::partly(samples, known))
    })
}

fn pairs_exchanged<'a>() -> Hypothesis<'a> {
    Hypothesis::new(Defect::ColumnPairsExchanged {}, |row| {
        let exchanged = |pair: &[u16]| pair.iter().rev().copied().collect::<Vec<_>>();
        Some(row.expected.chunks(2).flat_map(exchanged).collect::<Vec<_>>().into())
    })
}

/// Pairs of outputs of which the highest byte is packed first.
fn pair_bytes_reversed<'a>(first_in_front: bool) -> Hypothesis<'a> {
    Hypothesis::new(Defect::PairBytesReversed { first_in_front }, move |row| {
        let mut samples = row.expected.to_vec();
        if first_in_front {
            samples.chunks_exact_mut(2).for_each(<[u16]>::reverse);
        }
        let mut packed = Vec::new();
        pack(&samples, &mut packed);
        packed.chunks_exact_mut(3).for_each(<[u8]>::reverse);
        unpack(&packed, &mut samples);
        Some(samples.into())
    })
}

/// Rows that came back black. Which rows are lost does not follow from the defect.
fn lost<'a>(witnesses: &Witnesses<'a>) -> Option<Hypothesis<'a>> {
    let black: BTreeSet<_> =
        witnesses.differing.iter().filter(|row| is_lost(row)).map(|row| row.row).collect();
    let defect = Defect::RowsLost { rows: black.len(), first: *black.first()? };
    Some(Hypothesis::new(defect, |row| is_lost(row).then(|| row.found.to_vec().into())))
}

fn is_lost(row: &Witness<'_>) -> bool {
    row.differences > 0 && row.found.iter().all(|&sample| sample == 0)
}
