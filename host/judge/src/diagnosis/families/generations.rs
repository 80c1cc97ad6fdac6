//! Rows made with the tables of another generation, or with those at power-up.

use std::collections::BTreeMap;

use halfrow_model::{Kernel, NODES, RowFactor};

use crate::diagnosis::Case;
use crate::diagnosis::datapath::{RowTables, Stretch};
use crate::diagnosis::hypothesis::Hypothesis;
use crate::diagnosis::witnesses::{Witness, Witnesses};
use crate::result::{Defect, MadeWith, StaleFrames};

/// Rows that are tried to find out what frames were made with.
const ROWS: usize = 96;

/// The tables that rows were really made with, where these are not the ones committed for them.
pub(super) fn propose<'a>(witnesses: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    let case = witnesses.case;
    let Ok(blank) = Kernel::from_nodes(vec![[0; 5]; NODES]) else { return Vec::new() };
    let mut frames: BTreeMap<usize, Vec<MadeWith>> = BTreeMap::new();
    for row in witnesses.differing.iter().take(ROWS) {
        if let Some(made) = explain(&case, &blank, row) {
            let known = frames.entry(row.frame).or_default();
            if !known.contains(&made) {
                known.push(made);
            }
        }
    }
    if frames.is_empty() {
        return Vec::new();
    }
    let defect = defect(witnesses, frames);
    // A row is explained as a whole or not at all, so its explanation predicts what was found.
    vec![Hypothesis::new(defect, move |row| explain(&case, &blank, row).map(|_| row.found.to_vec().into()))]
}

/// What the row was made with, if that can be told and is not what it should be made with.
fn explain(case: &Case<'_>, blank: &Kernel, row: &Witness<'_>) -> Option<MadeWith> {
    candidates(case, row.uploaded.number).into_iter().find(|made| {
        let tables = tables(*made, case, blank, row);
        row.differences > 0 && tables.is_some_and(|tables| tables.corrected(row.samples()) == row.found)
    })
}

/// Everything that rows of generation `own` may wrongly be made with, combinations of a single generation first.
fn candidates(case: &Case<'_>, own: u8) -> Vec<MadeWith> {
    let mut sources: Vec<_> = case.uploaded.iter().rev().map(|uploaded| Some(uploaded.number)).collect();
    sources.push(None);
    let pairs = |factors: &Option<u8>| {
        sources.iter().map(|&kernel| MadeWith { factors: *factors, kernel }).collect::<Vec<_>>()
    };
    let mut made: Vec<_> = sources.iter().flat_map(pairs).collect();
    made.retain(|made| *made != MadeWith { factors: Some(own), kernel: Some(own) });
    made.sort_by_key(|made| made.factors != made.kernel);
    made
}

fn tables<'b>(
    made: MadeWith,
    case: &Case<'b>,
    blank: &'b Kernel,
    row: &Witness<'b>,
) -> Option<RowTables<'b>> {
    let stretch = match made.factors {
        Some(generation) => Stretch::of(&case.uploaded_as(generation)?.tables, row.geometry(), row.row)?,
        None => Stretch::Factor(RowFactor::ONE.get()),
    };
    let kernel = match made.kernel {
        Some(generation) => &case.uploaded_as(generation)?.kernel,
        None => blank,
    };
    Some(RowTables { stretch, kernel, ..row.tables() })
}

fn defect(witnesses: &Witnesses<'_>, frames: BTreeMap<usize, Vec<MadeWith>>) -> Defect {
    let stale = frames.into_iter().map(|(index, made_with)| {
        let known = witnesses.case.frames.get(index);
        let (frame, committed) = known.map_or((0, 0), |frame| (frame.number, frame.generation));
        StaleFrames { frame, committed, made_with }
    });
    Defect::StaleTables { rows: witnesses.few_rows().to_vec(), frames: stale.collect() }
}
