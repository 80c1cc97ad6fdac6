//! Rows made with the tables of another generation, or with those of power-up.

use std::collections::BTreeMap;

use halfrow_model::{Kernel, NODES, STEP_ONE};

use super::row_factor::FEW_ROWS;
use crate::diagnosis::Case;
use crate::diagnosis::datapath::RowTables;
use crate::diagnosis::hypothesis::{Cause, Hypothesis};
use crate::diagnosis::witnesses::{Witness, Witnesses};

/// Rows that are tried to find what frames were made with.
const ROWS: usize = 96;

/// What a row was made with: generations, or none for what a board holds when it was just switched on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Made {
    factors: Option<u8>,
    kernel: Option<u8>,
}

/// The tables that rows really were made with, when those are not what was committed for them.
pub(super) fn propose<'a>(witnesses: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    let case = witnesses.case;
    let Ok(blank) = Kernel::from_nodes(vec![[0; 5]; NODES]) else { return Vec::new() };
    let mut frames: BTreeMap<usize, Vec<Made>> = BTreeMap::new();
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
    let cause = cause(witnesses, &frames);
    // A row is explained whole or not at all, so what explains it predicts what was found.
    vec![Hypothesis::new(cause, move |row| explain(&case, &blank, row).map(|_| row.found.to_vec().into()))]
}

/// What the row was made with, if that is known and not what it should be made with.
fn explain(case: &Case<'_>, blank: &Kernel, row: &Witness<'_>) -> Option<Made> {
    candidates(case, row.uploaded.generation).into_iter().find(|made| {
        let tables = made.tables(case, blank, row);
        row.differences > 0 && tables.is_some_and(|tables| tables.corrected(row.samples()) == row.found)
    })
}

/// All that rows of `own` may wrongly be made with, whole generations first.
fn candidates(case: &Case<'_>, own: u8) -> Vec<Made> {
    let mut sources: Vec<_> = case.uploaded.iter().rev().map(|uploaded| Some(uploaded.generation)).collect();
    sources.push(None);
    let pairs = |factors: &Option<u8>| {
        sources.iter().map(|&kernel| Made { factors: *factors, kernel }).collect::<Vec<_>>()
    };
    let mut made: Vec<_> = sources.iter().flat_map(pairs).collect();
    made.retain(|made| *made != Made { factors: Some(own), kernel: Some(own) });
    made.sort_by_key(|made| made.factors != made.kernel);
    made
}

impl Made {
    fn tables<'b>(self, case: &Case<'b>, blank: &'b Kernel, row: &Witness<'b>) -> Option<RowTables<'b>> {
        let uploaded = |generation| case.uploaded.iter().rfind(|uploaded| uploaded.generation == generation);
        let step = match self.factors {
            Some(generation) => uploaded(generation)?.tables.step(row.row)?,
            None => STEP_ONE,
        };
        let kernel = match self.kernel {
            Some(generation) => uploaded(generation)?.kernel,
            None => blank,
        };
        Some(RowTables { geometry: row.geometry(), step, kernel })
    }

    /// "with the tables of generation 1 instead of 2"
    fn describe(self, own: u8) -> String {
        match (self.factors, self.kernel) {
            (None, None) => "as it went in".to_owned(),
            (None, _) => "without stretching it".to_owned(),
            (Some(factors), None) if factors == own => "without a kernel".to_owned(),
            (Some(factors), None) => {
                format!("with the factors of generation {factors} instead of {own} and without a kernel")
            }
            (Some(factors), Some(kernel)) if factors == kernel => {
                format!("with the tables of generation {factors} instead of {own}")
            }
            (Some(factors), Some(kernel)) if factors == own => {
                format!("with the kernel of generation {kernel} instead of {own}")
            }
            (Some(factors), Some(kernel)) if kernel == own => {
                format!("with the factors of generation {factors} instead of {own}")
            }
            (Some(factors), Some(kernel)) => {
                format!(
                    "with the factors of generation {factors} and the kernel of {kernel} instead of {own}"
                )
            }
        }
    }
}

fn cause(witnesses: &Witnesses<'_>, frames: &BTreeMap<usize, Vec<Made>>) -> Cause {
    let rows = match &witnesses.rows[..] {
        few if few.len() <= FEW_ROWS => format!("row {} of ", list(few)),
        _ => String::new(),
    };
    let mut alike: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for (&frame, made) in frames {
        let (number, own) =
            witnesses.case.frames.get(frame).map_or((0, 0), |frame| (frame.number, frame.generation));
        let manner: Vec<_> = made.iter().map(|made| made.describe(own)).collect();
        alike.entry(manner.join(" or ")).or_default().push(number.into());
    }
    let clauses: Vec<_> = alike
        .iter()
        .map(|(manner, numbers)| format!("making {rows}frame {} {manner}", list(numbers)))
        .collect();
    Cause {
        part: "stale tables",
        place: "the choice of the table bank".to_owned(),
        defect: clauses.join(", and "),
        next_step: "Check when the switch of table banks takes effect, and which bank the datapath reads."
            .to_owned(),
    }
}

/// "2, 4 to 8" for ascending numbers.
fn list(numbers: &[usize]) -> String {
    let runs = numbers.chunk_by(|a, b| a + 1 == *b);
    let words: Vec<_> = runs
        .map(|run| match run {
            [first, .., last] => format!("{first} to {last}"),
            one => one.iter().map(usize::to_string).collect(),
        })
        .collect();
    words.join(", ")
}
