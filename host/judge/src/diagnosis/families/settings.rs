//! A setting of CONFIGURE that the board does not apply.

use halfrow_model::{BitDepth, Geometry};

use crate::diagnosis::datapath::{RowTables, Stretch};
use crate::diagnosis::hypothesis::{Hypothesis, Prediction};
use crate::diagnosis::witnesses::{Witness, Witnesses};
use crate::diagnosis::{Case, Uploaded};
use crate::result::{Defect, Instead};

/// The optical centre and the depth, each with the values that the board may use instead.
pub(super) fn propose<'a>(witnesses: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    let case = witnesses.case;
    [Instead::Usual, Instead::FirstFrame, Instead::FrameBefore]
        .into_iter()
        .flat_map(|instead| [centre(case, instead), depth(case, instead)])
        .collect()
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
    let geometry = Geometry::new(own.width(), own.height(), depth, centre2).ok()?;
    if geometry == *own {
        return None;
    }
    let Uploaded { tables, kernel, .. } = witness.uploaded;
    let stretch = Stretch::of(tables, &geometry, witness.row)?;
    let tables = RowTables { geometry: &geometry, stretch, kernel };
    Some(Prediction::partly(tables.corrected(witness.samples()), tables.foretold(case.ring)))
}
