//! Rows that hold the samples of another place.

use std::collections::{BTreeMap, BTreeSet};

use crate::diagnosis::Case;
use crate::diagnosis::hypothesis::{Cause, Hypothesis, Prediction};
use crate::diagnosis::witnesses::{Witness, Witnesses};

/// Rows that are searched for.
const ROWS: usize = 96;
/// Row banks that a board may plausibly confuse, and columns that a row may plausibly be shifted by.
const NEAR: isize = 8;

/// Rows exchanged, shifted along themselves, or lost.
pub(super) fn propose<'a>(witnesses: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    let shifts = (1..=NEAR).flat_map(|columns| [shifted(-columns), shifted(columns)]);
    shifts.chain([pairs_exchanged()]).chain(lost(witnesses)).chain(exchanged(witnesses)).collect()
}

/// Where a row's samples come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Place {
    /// The corrected row so many rows below, in the frame so many later.
    Output { frames: isize, rows: isize },
    /// The row that went in so many rows below, made with this row's factor.
    Input { rows: isize },
}

fn exchanged<'a>(witnesses: &Witnesses<'a>) -> Option<Hypothesis<'a>> {
    let case = witnesses.case;
    let mut places: BTreeMap<Place, usize> = BTreeMap::new();
    for row in witnesses.differing.iter().take(ROWS) {
        if let Some(place) = place(&case, row) {
            *places.entry(place).or_default() += 1;
        }
    }
    let (&commonest, _) = places.iter().max_by_key(|(_, count)| **count)?;
    let cause = Cause {
        part: "row bank",
        place: "the row banks".to_owned(),
        defect: commonest.describe(places.len() > 1),
        next_step: "Check the numbers of the row banks that are filled, played and fetched.".to_owned(),
    };
    // A row is found whole or not at all, so its place predicts what was found.
    Some(Hypothesis::new(cause, move |row| place(&case, row).map(|_| row.found.to_vec().into())))
}

/// Where the samples of a row that differs come from, the nearest place first. A uniform row may come from anywhere.
fn place(case: &Case<'_>, row: &Witness<'_>) -> Option<Place> {
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

/// The row of the reference's frame that the board gave instead.
fn in_frame(case: &Case<'_>, row: &Witness<'_>, frame: usize) -> Option<Place> {
    let evidence = case.evidence.iter().find(|evidence| evidence.index == frame)?;
    let rows = evidence.expected.rows().enumerate();
    let same = rows.filter(|(_, samples)| *samples == row.found).map(|(index, _)| index);
    let nearest = same.min_by_key(|index| index.abs_diff(row.row))?;
    let distance = |to: usize, from: usize| to as isize - from as isize;
    Some(Place::Output { frames: distance(frame, row.frame), rows: distance(nearest, row.row) })
}

fn of_input(row: &Witness<'_>, rows: isize) -> Option<Place> {
    (row.tables().corrected(row.samples_at(rows)?) == row.found).then_some(Place::Input { rows })
}

impl Place {
    fn describe(self, among_others: bool) -> String {
        let name = |rows: isize| match rows {
            0 => "the same row".to_owned(),
            -1 => "the row above".to_owned(),
            1 => "the row below".to_owned(),
            rows if rows < 0 => format!("the row {} above", -rows),
            rows => format!("the row {rows} below"),
        };
        let most = if among_others { "rows holding other rows, mostly" } else { "rows holding" };
        match self {
            Self::Output { frames: 0, rows } => format!("{most} {},", name(rows)),
            Self::Output { frames, rows } => {
                let when = if frames < 0 { "earlier" } else { "later" };
                format!("{most} {} of the frame {} {when},", name(rows), frames.abs())
            }
            Self::Input { rows } => format!("{most} {}, made with their own factor,", name(rows)),
        }
    }
}

/// Every row moved along itself. What comes in at its end is not known.
fn shifted<'a>(columns: isize) -> Hypothesis<'a> {
    let side = if columns < 0 { "left" } else { "right" };
    let cause = Cause {
        part: "row shift",
        place: format!("the corrected row's first sample, {} to the {side}", columns.abs()),
        defect: "every row moved by as many columns".to_owned(),
        next_step: "Check on which pixel clock the capture of a corrected row begins.".to_owned(),
    };
    Hypothesis::new(cause, move |row| {
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
    let cause = Cause {
        part: "colour",
        place: "the pairs of columns".to_owned(),
        defect: "the two outputs of every pair of columns exchanged".to_owned(),
        next_step: "Check the order in which samples are packed and unpacked.".to_owned(),
    };
    Hypothesis::new(cause, |row| {
        let exchanged = |pair: &[u16]| pair.iter().rev().copied().collect::<Vec<_>>();
        Some(row.expected.chunks(2).flat_map(exchanged).collect::<Vec<_>>().into())
    })
}

/// Rows that came back black or not at all. Which rows those are does not follow from the defect.
fn lost<'a>(witnesses: &Witnesses<'a>) -> Option<Hypothesis<'a>> {
    let black: BTreeSet<_> =
        witnesses.differing.iter().filter(|row| is_lost(row)).map(|row| row.row).collect();
    let place = match black.len() {
        0 => return None,
        1 => format!("row {} on its way out", black.first()?),
        count => format!("{count} rows on their way out, the first row {}", black.first()?),
    };
    let cause = Cause {
        part: "lost rows",
        place,
        defect: "losing whole rows, which stay black,".to_owned(),
        next_step: "Check that every row's samples reach their bank before it is fetched.".to_owned(),
    };
    Some(Hypothesis::new(cause, |row| is_lost(row).then(|| row.found.to_vec().into())))
}

fn is_lost(row: &Witness<'_>) -> bool {
    row.differences > 0 && row.found.iter().all(|&sample| sample == 0)
}
