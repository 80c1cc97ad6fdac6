//! A setting of CONFIGURE that the board does not apply.

use halfrow_model::{BitDepth, Geometry};

use super::StuckLine;
use crate::diagnosis::Case;
use crate::diagnosis::datapath::{RowTables, Stretch};
use crate::diagnosis::hypothesis::{Hypothesis, Prediction};
use crate::diagnosis::witnesses::{Witness, Witnesses};
use crate::result::{Defect, Instead};
use crate::tables::Generation;

/// Bits of C.
const CENTRE_BITS: u32 = 13;
/// How far beside the centre that was set another is tried, in half columns.
const OFF: [i32; 2] = [-1, 1];

/// The optical centre and the depth, each with the values that the board may use instead, and the centre with a bit
/// stuck or beside the one that was set.
pub(super) fn propose<'a>(witnesses: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    let case = witnesses.case;
    [Instead::Usual, Instead::FirstFrame, Instead::FrameBefore]
        .into_iter()
        .flat_map(|instead| [centre(case, instead), depth(case, instead)])
        .chain(StuckLine::all(CENTRE_BITS).map(|line| centre_bit(case, line)))
        .chain(OFF.map(|halves| centre_off(case, halves)))
        .collect()
}

fn centre_bit(case: Case<'_>, line: StuckLine) -> Hypothesis<'_> {
    Hypothesis::new(Defect::CentreBitStuck { bit: line.bit, value: line.value() }, move |witness| {
        let own = witness.geometry();
        made_by(&case, witness, own.depth(), line.carry(own.centre2()))
    })
}

fn centre(case: Case<'_>, instead: Instead) -> Hypothesis<'_> {
    Hypothesis::new(Defect::CentreIgnored { instead }, move |witness| {
        let own = witness.geometry();
        let centre2 = match instead {
            Instead::Usual => own.width() as u32 - 1,
            Instead::FirstFrame => made_for(&case, 0)?.centre2(),
            Instead::FrameBefore => made_for(&case, witness.frame.checked_sub(1)?)?.centre2(),
        };
        made_by(&case, witness, own.depth(), centre2)
    })
}

fn centre_off(case: Case<'_>, halves: i32) -> Hypothesis<'_> {
    Hypothesis::new(Defect::CentreOff { halves }, move |witness| {
        let own = witness.geometry();
        made_by(&case, witness, own.depth(), own.centre2().checked_add_signed(halves)?)
    })
}

fn depth(case: Case<'_>, instead: Instead) -> Hypothesis<'_> {
    Hypothesis::new(Defect::DepthIgnored { instead }, move |witness| {
        let depth = match instead {
            Instead::Usual => BitDepth::Twelve,
            Instead::FirstFrame => made_for(&case, 0)?.depth(),
            Instead::FrameBefore => made_for(&case, witness.frame.checked_sub(1)?)?.depth(),
        };
        made_by(&case, witness, depth, witness.geometry().centre2())
    })
}

/// Size, depth and centre of the frame at `index`.
fn made_for<'a>(case: &Case<'a>, index: usize) -> Option<&'a Geometry> {
    let generation = case.frames.get(index)?.generation;
    Some(case.uploaded_as(generation)?.tables.geometry())
}

/// The row with these settings; none if they are its own.
fn made_by(case: &Case<'_>, witness: &Witness<'_>, depth: BitDepth, centre2: u32) -> Option<Prediction> {
    let own = witness.geometry();
    if (depth, centre2) == (own.depth(), own.centre2()) {
        return None;
    }
    let geometry = Geometry::new(own.width(), own.height(), depth, own.centre2()).ok()?;
    let Generation { tables, kernel, .. } = witness.uploaded;
    let stretch = Stretch::about(tables, centre2, witness.row)?;
    let tables = RowTables { geometry: &geometry, centre2, stretch, kernel };
    Some(Prediction::partly(tables.corrected(witness.samples()), tables.foretold(case.ring)))
}
