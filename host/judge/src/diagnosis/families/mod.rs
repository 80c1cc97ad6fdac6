//! The known defects, each kind in its own file.

mod arithmetic;
mod factor_search;
mod generations;
mod grid_entry;
mod grid_lines;
mod kernel_search;
mod kernel_switch;
mod kernel_word;
mod memory_address;
mod memory_data;
mod origin_search;
mod places;
mod row_factor;
mod sample_lines;
mod settings;
mod table_lines;
mod table_word;
mod taps;

use std::collections::BTreeMap;
use std::ops::Range;

use halfrow_model::{Kernel, TableSet};

use super::datapath::{RowTables, Stretch};
use super::hypothesis::{Hypothesis, Prediction};
use super::witnesses::{Witness, Witnesses};
use crate::result::Defect;
use crate::tables::Generation;

/// The defects that the pattern of differences allows, those of the smallest parts first.
pub(super) fn propose<'a>(witnesses: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    [
        row_factor::propose,
        grid_entry::propose,
        kernel_word::propose,
        memory_data::propose,
        memory_address::propose,
        taps::propose,
        arithmetic::propose,
        settings::propose,
        table_lines::propose,
        grid_lines::propose,
        generations::propose,
        places::propose,
    ]
    .into_iter()
    .flat_map(|propose| propose(witnesses))
    .collect()
}

/// Defects whose parameters must be searched for, tried if nothing else explains everything.
pub(super) fn search<'a>(witnesses: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    [
        factor_search::propose,
        kernel_search::propose,
        origin_search::propose,
        kernel_switch::propose,
        sample_lines::propose,
    ]
    .into_iter()
    .flat_map(|propose| propose(witnesses))
    .collect()
}

/// The kernels that `change` gives, by generation; generations for which it gives none are left out.
fn kernels(
    generations: &[&Generation],
    change: impl Fn(&Generation) -> Option<Kernel>,
) -> BTreeMap<u8, Kernel> {
    generations.iter().filter_map(|uploaded| Some((uploaded.number, change(uploaded)?))).collect()
}

/// Rows made with these kernels, by generation. Other generations are as they should be.
fn with_kernels<'a>(defect: Defect, kernels: BTreeMap<u8, Kernel>) -> Hypothesis<'a> {
    Hypothesis::new(defect, move |witness| {
        let kernel = kernels.get(&witness.uploaded.number)?;
        Some(RowTables { kernel, ..witness.tables() }.corrected(witness.samples()).into())
    })
}

/// Rows made with these grids, by generation, on a board with a ring of `ring` samples. Other generations are as they should be.
fn with_grids<'a>(defect: Defect, grids: BTreeMap<u8, TableSet>, ring: usize) -> Hypothesis<'a> {
    Hypothesis::new(defect, move |witness| {
        let tables = with_grid(witness, grids.get(&witness.uploaded.number)?)?;
        let samples = tables.corrected(witness.samples());
        Some(Prediction::partly(samples, tables.foretold(ring)))
    })
}

/// What a row is made with under another grid; none if that leaves the row as it should be.
fn with_grid<'a>(witness: &Witness<'a>, grid: &TableSet) -> Option<RowTables<'a>> {
    let own = witness.tables();
    let stretch = Stretch::of(grid, own.geometry, witness.row).filter(|stretch| *stretch != own.stretch)?;
    Some(RowTables { stretch, ..own })
}

/// The first number of a range from which on `holds` is true, found by bisection; the end of the range if it never is.
fn first_where(range: Range<i64>, holds: impl Fn(i64) -> bool) -> i64 {
    let Range { start: mut low, end: mut high } = range;
    while low < high {
        // Rounds down, also for negative numbers, which `midpoint` would round towards 0.
        let middle = low + (high - low) / 2;
        if holds(middle) { high = middle } else { low = middle + 1 }
    }
    low
}

/// A bus with one line stuck.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct StuckLine {
    bit: u32,
    high: bool,
}

impl StuckLine {
    /// The lowest `bits` lines of a bus, each stuck at 0 and at 1.
    fn all(bits: u32) -> impl Iterator<Item = Self> {
        (0..bits).flat_map(|bit| [false, true].map(|high| Self { bit, high }))
    }

    /// What arrives at the far end of the bus if `word` is sent.
    fn carry(self, word: u32) -> u32 {
        let line = 1 << self.bit;
        if self.high { word | line } else { word & !line }
    }

    /// The level at which it is stuck.
    fn value(self) -> u8 {
        self.high.into()
    }
}
