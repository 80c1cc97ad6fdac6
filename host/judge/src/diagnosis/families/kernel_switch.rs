//! Rows in which the kernel changes, because the switch of its bank does not wait for the row's end, or comes after its beginning.

use crate::diagnosis::Case;
use crate::diagnosis::datapath::RowTables;
use crate::diagnosis::hypothesis::Hypothesis;
use crate::diagnosis::witnesses::{Witness, Witnesses};
use crate::result::{Defect, KernelSwitch};

/// Rows in which a switch is searched for.
const ROWS: usize = 96;
/// Fewer samples than this may be explained by chance.
const LEAST: usize = 4;

pub(super) fn propose<'a>(witnesses: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    let case = witnesses.case;
    let first = witnesses.differing.iter().take(ROWS).find_map(|row| switch(&case, row));
    first
        .map(|first| {
            // A row is explained as a whole or not at all.
            let predict = move |row: &Witness<'_>| switch(&case, row).map(|_| row.found.to_vec().into());
            Hypothesis::new(Defect::KernelSwitchedInRow(first), predict)
        })
        .into_iter()
        .collect()
}

/// Where the row changes from its own kernel to another one, or from another one to its own.
fn switch(case: &Case<'_>, row: &Witness<'_>) -> Option<KernelSwitch> {
    if row.differences < LEAST {
        return None;
    }
    let own = row.uploaded.number;
    let frame = case.frames.get(row.frame)?.number;
    let others = case.uploaded.iter().rev().filter(|other| other.number != own);
    others
        .flat_map(|other| {
            let made = RowTables { kernel: &other.kernel, ..row.tables() }.corrected(row.samples());
            let other = other.number;
            let to_other = column(row.found, row.expected, &made).map(|column| (column, own, other));
            let from_other = column(row.found, &made, row.expected).map(|column| (column, other, own));
            to_other.or(from_other)
        })
        .map(|(column, before, after)| KernelSwitch { row: row.row, frame, column, before, after })
        .next()
}

/// The first column at which `found` no longer is as `before`, if it is as `after` from there on.
fn column(found: &[u16], before: &[u16], after: &[u16]) -> Option<usize> {
    let column = found.iter().zip(before).position(|(found, before)| found != before)?;
    (column > 0 && found.get(column..)? == after.get(column..)?).then_some(column)
}
