//! The rows that a hypothesis must explain.

use std::collections::BTreeSet;

use halfrow_model::{Frame, Geometry};

use super::Case;
use super::datapath::{RowTables, Stretch};
use crate::result::Evidence;
use crate::tables::Generation;

/// 2^64 divided by the golden ratio. Its multiples modulo 2^64 are spread evenly.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// If more rows than this differ, they are not explained entry by entry.
const FEW_ROWS: usize = 8;

/// A row that was kept: its input, the output, and the output of the reference.
#[derive(Clone, Copy, Debug)]
pub(super) struct Witness<'a> {
    /// The place of its frame in streaming order.
    pub(super) frame: usize,
    /// The row of the frame.
    pub(super) row: usize,
    /// The tables and kernel that its frame must be made with.
    pub(super) uploaded: &'a Generation,
    /// The whole input frame.
    pub(super) input: &'a Frame,
    /// The row that went in after it, of this frame or the next, if it was kept.
    pub(super) next: Option<&'a [u16]>,
    /// The board's output.
    pub(super) found: &'a [u16],
    /// The reference's output.
    pub(super) expected: &'a [u16],
    /// Samples that differ.
    pub(super) differences: usize,
}

impl<'a> Witness<'a> {
    /// Size, depth and centre.
    pub(super) fn geometry(&self) -> &'a Geometry {
        self.uploaded.tables.geometry()
    }

    /// The row's input samples.
    pub(super) fn samples(&self) -> &'a [u16] {
        self.input.row(self.row)
    }

    /// The input samples of the row that is `distance` rows further down, if the frame has it.
    pub(super) fn samples_at(&self, distance: isize) -> Option<&'a [u16]> {
        let row = self.row.checked_add_signed(distance).filter(|&row| row < self.input.height())?;
        Some(self.input.row(row))
    }

    /// What the row must be made with.
    pub(super) fn tables(&self) -> RowTables<'a> {
        let Generation { tables, kernel, .. } = self.uploaded;
        let geometry = tables.geometry();
        let stretch = Stretch::of(tables, geometry, self.row).unwrap_or(Stretch::Factor(0));
        RowTables { geometry, centre2: geometry.centre2(), stretch, kernel }
    }

    /// Its position in the run.
    pub(super) fn place(&self) -> (usize, usize) {
        (self.frame, self.row)
    }

    /// The columns that differ.
    pub(super) fn differing_columns(&self) -> impl Iterator<Item = usize> {
        self.found
            .iter()
            .zip(self.expected)
            .enumerate()
            .filter_map(|(column, (found, expected))| (found != expected).then_some(column))
    }
}

/// All rows that were kept, ordered so that the first ones of any number are spread over frames and rows.
#[derive(Debug)]
pub(super) struct Witnesses<'a> {
    /// What is known.
    pub(super) case: Case<'a>,
    /// Rows with differences.
    pub(super) differing: Vec<Witness<'a>>,
    /// Rows without differences, from the first difference of the run on.
    equal: Vec<Witness<'a>>,
    /// Rows without differences before it.
    before: Vec<Witness<'a>>,
    /// The rows that differ in any frame, kept or not, in ascending order.
    pub(super) rows: Vec<usize>,
}

impl<'a> Witnesses<'a> {
    /// The rows of those kept frames whose tables are known.
    pub(super) fn of(case: &Case<'a>) -> Self {
        let all: Vec<_> = case.evidence.iter().flat_map(|evidence| rows(case, evidence)).collect();
        let (differing, equal): (Vec<_>, Vec<_>) = all.into_iter().partition(|row| row.differences > 0);
        let counted = case.frames.iter().flat_map(|frame| frame.comparison.differing_rows());
        let differ: BTreeSet<_> = counted.chain(differing.iter().map(|row| row.row)).collect();
        let first = differing.iter().map(Witness::place).min();
        let (before, equal): (Vec<_>, Vec<_>) = equal.into_iter().partition(|row| Some(row.place()) < first);
        Self {
            case: *case,
            differing: spread(differing),
            equal: telling(equal, &differ),
            before: telling(before, &differ),
            rows: differ.into_iter().collect(),
        }
    }

    /// The rows that differ, if they are few enough to be explained one by one; otherwise none.
    pub(super) fn few_rows(&self) -> &[usize] {
        if self.rows.len() <= FEW_ROWS { &self.rows } else { &[] }
    }

    /// At most `count` differing rows, and as many equal rows that come after the first difference.
    pub(super) fn sample(&self, count: usize) -> impl Iterator<Item = &Witness<'a>> {
        self.differing.iter().take(count).chain(self.equal.iter().take(count))
    }

    /// At most `count` rows from before the first difference.
    pub(super) fn sample_before(&self, count: usize) -> impl Iterator<Item = &Witness<'a>> {
        self.before.iter().take(count)
    }

    /// The size, depth and centre of all frames; none if there are no rows to explain.
    pub(super) fn geometry(&self) -> Option<&'a Geometry> {
        self.differing.first().map(Witness::geometry)
    }

    /// What was uploaded for any of the kept frames, each generation once.
    pub(super) fn generations(&self) -> Vec<&'a Generation> {
        let used: BTreeSet<_> = self
            .case
            .evidence
            .iter()
            .filter_map(|evidence| Some(self.case.frames.get(evidence.index)?.generation))
            .collect();
        used.into_iter().filter_map(|generation| self.case.uploaded_as(generation)).collect()
    }
}

/// The rows of one frame that came back. It may have only its first rows. A frame that does not fit its tables gives none.
fn rows<'a>(case: &Case<'a>, evidence: &'a Evidence) -> Vec<Witness<'a>> {
    let uploaded = case.frames.get(evidence.index).and_then(|frame| case.uploaded_as(frame.generation));
    let Some(uploaded) = uploaded.filter(|uploaded| fits(evidence, uploaded.tables.geometry())) else {
        return Vec::new();
    };
    let input = &evidence.input;
    let following = case.evidence.iter().find(|other| other.index == evidence.index + 1);
    let next_frame =
        following.filter(|next| next.input.width() == input.width()).map(|next| next.input.row(0));
    let witness = |(row, expected, found): (usize, &'a [u16], &'a [u16])| {
        let differences =
            if found == expected { 0 } else { found.iter().zip(expected).filter(|(f, e)| f != e).count() };
        let frame = evidence.index;
        let next = if row + 1 < input.height() { Some(input.row(row + 1)) } else { next_frame };
        Witness { frame, row, uploaded, input, next, found, expected, differences }
    };
    evidence.returned().map(witness).collect()
}

/// Rows without differences, alternately one that differs in another frame and one that differs in none. Both kinds are spread.
fn telling<'a>(equal: Vec<Witness<'a>>, differ: &BTreeSet<usize>) -> Vec<Witness<'a>> {
    let (here, everywhere): (Vec<_>, Vec<_>) = equal.into_iter().partition(|row| differ.contains(&row.row));
    let (mut here, mut everywhere) = (spread(here).into_iter(), spread(everywhere).into_iter());
    let mut mixed = Vec::new();
    loop {
        let pair: Vec<_> = here.next().into_iter().chain(everywhere.next()).collect();
        if pair.is_empty() {
            return mixed;
        }
        mixed.extend(pair);
    }
}

fn fits(evidence: &Evidence, geometry: &Geometry) -> bool {
    let rows = evidence.input.height();
    [&evidence.input, &evidence.found, &evidence.expected]
        .iter()
        .all(|frame| frame.width() == geometry.width() && frame.height() == rows && rows <= geometry.height())
}

/// The rows ordered so that the first ones of any number are spread evenly over the whole, without a period.
fn spread(rows: Vec<Witness<'_>>) -> Vec<Witness<'_>> {
    let mut ordered: Vec<_> = rows.into_iter().enumerate().collect();
    ordered.sort_unstable_by_key(|(index, _)| (*index as u64).wrapping_mul(GOLDEN));
    ordered.into_iter().map(|(_, row)| row).collect()
}
