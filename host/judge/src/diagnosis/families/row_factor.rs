//! One row's table entry with an inverted bit.

use halfrow_model::RowFactor;

use super::table_word::{Word, changed, inversions, reading};
use crate::diagnosis::datapath::{RowTables, Stretch};
use crate::diagnosis::hypothesis::{Hypothesis, Prediction};
use crate::diagnosis::witnesses::{Witness, Witnesses};
use crate::result::Defect;

/// Every bit of the entry of every differing row, if few rows differ.
pub(super) fn propose<'a>(witnesses: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    witnesses.few_rows().iter().flat_map(|&row| entry(witnesses, row)).collect()
}

fn entry<'a>(witnesses: &Witnesses<'a>, row: usize) -> Vec<Hypothesis<'a>> {
    let ring = witnesses.case.ring;
    let words: Vec<_> = witnesses
        .generations()
        .iter()
        .filter_map(|uploaded| Some((uploaded.number, uploaded.tables.row_factor(row)?.get())))
        .collect();
    let bits =
        (0..RowFactor::BITS).flat_map(|bit| inversions(&words, bit).into_iter().map(move |read| (bit, read)));
    bits.map(|(bit, read)| {
        let (above_one, reading) = (is_illegal(&read), reading(&words, &read, i64::from));
        Hypothesis::new(Defect::RowFactorBitWrong { row, bit, reading, above_one }, move |witness| {
            let read = changed(&read, witness.uploaded).filter(|_| witness.row == row);
            read.map(|entry| with_entry(witness, entry, ring))
        })
    })
    .collect()
}

/// A factor above 1 reads ahead of what the ring holds. There the simulation ends.
fn is_illegal(read: &[Word]) -> bool {
    read.iter().any(|word| word.1 > RowFactor::ONE.get())
}

/// The witness's row made with another table entry, on a board with a ring of `ring` samples.
pub(super) fn with_entry(witness: &Witness<'_>, entry: u32, ring: usize) -> Prediction {
    let tables = RowTables { stretch: Stretch::Factor(entry), ..witness.tables() };
    Prediction::partly(tables.corrected(witness.samples()), tables.foretold(ring))
}
