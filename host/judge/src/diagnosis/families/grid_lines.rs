//! A stuck line in the memory that holds a grid, or its address off by one, so that many entries are read wrong.

use halfrow_model::{RowFactor, TableSet};

use super::{StuckLine, with_grids};
use crate::diagnosis::address_bits;
use crate::diagnosis::hypothesis::Hypothesis;
use crate::diagnosis::witnesses::Witnesses;
use crate::result::Defect;
use crate::tables::Generation;

/// Every data and address line, and entries read from one place too early or too late.
pub(super) fn propose<'a>(witnesses: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    let mut generations = witnesses.generations();
    generations.retain(|uploaded| uploaded.tables.shape().is_some());
    let entries = generations.iter().map(|uploaded| uploaded.tables.entries().len()).max();
    let Some(entries) = entries else { return Vec::new() };
    let lines = Lines { generations, ring: witnesses.case.ring };
    StuckLine::all(RowFactor::BITS)
        .map(|line| lines.data(line))
        .chain(StuckLine::all(address_bits(entries)).map(|line| lines.address(line)))
        .chain([-1, 1].map(|distance| lines.neighbour(distance)))
        .collect()
}

/// The grids that a line may affect.
struct Lines<'a> {
    generations: Vec<&'a Generation>,
    ring: usize,
}

impl Lines<'_> {
    fn data<'a>(&self, line: StuckLine) -> Hypothesis<'a> {
        let defect = Defect::RowTableDataStuck { bit: line.bit, value: line.value() };
        self.read(defect, |entries, index| entries.get(index).map(|&entry| line.carry(entry)))
    }

    fn address<'a>(&self, line: StuckLine) -> Hypothesis<'a> {
        let defect = Defect::RowTableAddressStuck { bit: line.bit, value: line.value() };
        self.read(defect, |entries, index| entries.get(line.carry(index as u32) as usize).copied())
    }

    fn neighbour<'a>(&self, distance: isize) -> Hypothesis<'a> {
        let defect = Defect::RowTableAddressOff { entries: distance };
        self.read(defect, |entries, index| entries.get(index.checked_add_signed(distance)?).copied())
    }

    /// Rows made with grids whose entries `read` gives. Entries beyond a grid are assumed to have the value at power-up.
    fn read<'a>(&self, defect: Defect, read: impl Fn(&[u32], usize) -> Option<u32>) -> Hypothesis<'a> {
        let grid = |uploaded: &&Generation| {
            let tables = &uploaded.tables;
            let entries: Vec<_> = tables.entries().collect();
            let entry = |index| read(&entries, index).unwrap_or(RowFactor::ONE.get());
            let read: Vec<_> = (0..entries.len()).map(entry).collect();
            let grid = TableSet::from_grid(*tables.geometry(), tables.shape()?, &read).ok()?;
            Some((uploaded.number, grid))
        };
        with_grids(defect, self.generations.iter().filter_map(grid).collect(), self.ring)
    }
}
