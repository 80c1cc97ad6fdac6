//! A stuck address line of the line memory, for writing and for reading.
//!
//! Two addresses that differ only in this line share a cell, and a read gives what was written last. Which of the two that is
//! depends on when the sample is read, so the row is read output by output. The level at which the line is stuck makes no
//! difference: either way the same addresses share a cell.

use std::ops::Range;

use crate::diagnosis::datapath::{LOOK_AHEAD, Wiring};
use crate::diagnosis::hypothesis::{Hypothesis, Prediction};
use crate::diagnosis::witnesses::{Witness, Witnesses};
use crate::result::{Counting, Defect};

/// Where the count of the ring's addresses begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Origin {
    /// With this count at the first sample of the run, modulo M.
    Run(usize),
    /// At the first sample of each frame.
    Frame,
    /// At the first sample of each row.
    Row,
}

impl Origin {
    /// The address of the row's first sample.
    pub(super) fn base(self, witness: &Witness<'_>) -> usize {
        let (width, height) = (witness.geometry().width(), witness.geometry().height());
        match self {
            Self::Run(first) => first + (witness.frame * height + witness.row) * width,
            Self::Frame => witness.row * width,
            Self::Row => 0,
        }
    }
}

/// A ring of `size` samples with address line `bit` stuck.
#[derive(Clone, Copy, Debug)]
pub(super) struct BrokenRing {
    /// M, a power of two.
    pub(super) size: usize,
    /// The line, below log2 M.
    pub(super) bit: u32,
}

/// Every address line, for each way in which a board may count addresses.
pub(super) fn propose<'a>(witnesses: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    let origins =
        [(Origin::Run(0), Counting::Run), (Origin::Frame, Counting::Frame), (Origin::Row, Counting::Row)];
    rings(witnesses)
        .flat_map(|ring| origins.map(|(origin, counting)| hypothesis(ring, origin, counting)))
        .collect()
}

/// The ring with each of its address lines stuck.
pub(super) fn rings(witnesses: &Witnesses<'_>) -> impl Iterator<Item = BrokenRing> + use<> {
    let size = witnesses.case.ring;
    let lines = if size.is_power_of_two() { size.ilog2() } else { 0 };
    (0..lines).map(move |bit| BrokenRing { size, bit })
}

/// Line `ring.bit` as a suspect; `counting` says under which condition.
pub(super) fn hypothesis<'a>(ring: BrokenRing, origin: Origin, counting: Counting) -> Hypothesis<'a> {
    let defect = Defect::LineMemoryAddressStuck { bit: ring.bit, counting };
    Hypothesis::new(defect, move |witness| Some(ring.corrected(witness, origin.base(witness))))
}

impl BrokenRing {
    /// The row as the board gives it if its first sample has the address `base`.
    ///
    /// It is unknown how many clocks pass before the next row, whose samples may replace this one's, and with gaps that number
    /// differs from row to row. So the number that fits is taken. It is also unknown whether another frame follows at once. If
    /// one seems to follow but was not kept, only the outputs that do not depend on it are predicted. If the half that depends on
    /// the row alone is wrong already, no number is searched for.
    fn corrected(self, witness: &Witness<'_>, base: usize) -> Prediction {
        let undisturbed = self.read_row(witness, base, None);
        let sure = sure(undisturbed.len());
        if undisturbed == witness.found || undisturbed.get(sure.clone()) != witness.found.get(sure) {
            return undisturbed.into();
        }
        match witness.next {
            Some(next) => self.followed_by(next, witness, base, &undisturbed).into(),
            None => before_next_row(undisturbed),
        }
    }

    /// The row with the blanking after it that fits best. The longer the blanking, the fewer samples are replaced in time.
    fn followed_by(self, next: &[u16], witness: &Witness<'_>, base: usize, undisturbed: &[u16]) -> Vec<u16> {
        let with = |blanking| self.read_row(witness, base, Some((next, blanking)));
        let at_once = with(0);
        if at_once == witness.found || at_once == undisturbed {
            return at_once;
        }
        let longest = (next.len() / 2 + LOOK_AHEAD + 1) as i64;
        let enough =
            |blanking: i64| !is_too_short(&with(blanking as usize), witness.found, &at_once, undisturbed);
        with(super::first_where(0..longest, enough) as usize)
    }

    /// The outputs that depend only on the row itself.
    pub(super) fn before_next_row(self, witness: &Witness<'_>, base: usize) -> Prediction {
        before_next_row(self.read_row(witness, base, None))
    }

    /// The row if the given next row follows it, after the given number of clocks.
    fn read_row(self, witness: &Witness<'_>, base: usize, next: Option<(&[u16], usize)>) -> Vec<u16> {
        let tables = witness.tables();
        let samples = witness.samples();
        tables.run(&Wiring::default(), |column, output| {
            let column = tables.geometry.sample_column(column);
            let newest = newest(samples.len(), output, next);
            let stored =
                Some(self.replaced_by(base, column)).filter(|&later| later <= newest).unwrap_or(column);
            let of_next = || next.and_then(|(next, _)| next.get(stored - samples.len()));
            samples.get(stored).or_else(of_next).copied().unwrap_or_default()
        })
    }

    /// The sample that next overwrites the cell of `column`, counted in columns from the row's start.
    fn replaced_by(self, base: usize, column: usize) -> usize {
        let distance = 1 << self.bit;
        if (base + column) & distance == 0 { column + distance } else { column + self.size - distance }
    }
}

/// The newest sample at the time an output is read, counted in columns from the row's start.
fn newest(width: usize, output: usize, next: Option<(&[u16], usize)>) -> usize {
    let clock = output + width / 2 + LOOK_AHEAD;
    let beyond = next.map_or(0, |(_, blanking)| (clock + 1).saturating_sub(width + blanking));
    clock.min(width - 1) + beyond
}

/// Whether `row` has samples of the next row where the board still has its own.
fn is_too_short(row: &[u16], found: &[u16], at_once: &[u16], undisturbed: &[u16]) -> bool {
    let (mut own, mut next) = (0, 0);
    for (((row, found), at_once), undisturbed) in row.iter().zip(found).zip(at_once).zip(undisturbed) {
        if row != found && at_once != undisturbed {
            own += usize::from(found == undisturbed);
            next += usize::from(found == at_once);
        }
    }
    own > next
}

/// The outputs of a row that are made before the next row can begin.
pub(super) fn sure(width: usize) -> Range<usize> {
    0..width / 2 - LOOK_AHEAD
}

fn before_next_row(row: Vec<u16>) -> Prediction {
    let known = sure(row.len());
    Prediction::partly(row, known)
}
