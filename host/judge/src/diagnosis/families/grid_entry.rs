//! One entry of a grid with a bit inverted.

use std::collections::BTreeMap;

use halfrow_model::{RowFactor, TableSet};

use super::table_word::{Word, changed, inversions, reading};
use super::{with_grid, with_grids};
use crate::diagnosis::hypothesis::Hypothesis;
use crate::diagnosis::witnesses::{Witness, Witnesses};
use crate::result::Defect;
use crate::tables::Generation;

/// How many rows a bit is tried on before it is simulated as a whole, and how many samples of each.
const ROWS: usize = 6;
const SAMPLES: usize = 16;

/// Every bit of the entries that the differing rows and the first differing column allow, if it predicts most of a few samples.
pub(super) fn propose<'a>(witnesses: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    let mut rows: Vec<_> = witnesses.differing.iter().collect();
    rows.sort_by_key(|row| std::cmp::Reverse(row.differences));
    rows.truncate(ROWS);
    let possible = |bit: &EntryBit| rows.iter().any(|row| bit.gives_most(row, witnesses.case.ring));
    let bits = entries(witnesses).into_iter().flat_map(EntryBit::bits);
    bits.filter(possible).flat_map(|bit| bit.hypotheses(witnesses)).collect()
}

/// The entries (c, b) that influence every differing row, from the first differing column or one left of it on.
///
/// An entry influences the rows of three blocks of 2^v. A node does so from the node left of it on, an offset everywhere.
fn entries(witnesses: &Witnesses<'_>) -> Vec<(usize, usize)> {
    let Some(first) = witnesses.differing.first() else { return Vec::new() };
    let (Some(shape), geometry) = (first.uploaded.tables.shape(), first.geometry()) else {
        return Vec::new();
    };
    let left = witnesses.differing.iter().filter_map(|row| row.differing_columns().next()).min();
    let (Some(top), Some(bottom), Some(left)) = (witnesses.rows.first(), witnesses.rows.last(), left) else {
        return Vec::new();
    };
    let grid_rows = bottom / shape.row_pitch()..=top / shape.row_pitch() + 2;
    let columns = shape.columns(geometry).min(left / shape.column_pitch() + 3);
    grid_rows.flat_map(|row| (0..columns).rev().map(move |column| (column, row))).collect()
}

/// A bit of an entry.
#[derive(Clone, Copy, Debug)]
struct EntryBit {
    /// c.
    column: usize,
    /// b.
    row: usize,
    bit: u32,
}

impl EntryBit {
    fn bits((column, row): (usize, usize)) -> impl Iterator<Item = Self> {
        (0..RowFactor::BITS).map(move |bit| Self { column, row, bit })
    }

    /// The index of the entry in a bank; none if the table is not a grid.
    fn index(self, tables: &TableSet) -> Option<usize> {
        let rows = tables.shape()?.rows(tables.geometry());
        (self.row < rows).then_some(self.column * rows + self.row)
    }

    fn word(self, tables: &TableSet) -> Option<u32> {
        tables.entries().nth(self.index(tables)?)
    }

    /// The grid with `word` at this place.
    fn replaced(self, tables: &TableSet, word: u32) -> Option<TableSet> {
        let mut entries: Vec<_> = tables.entries().collect();
        *entries.get_mut(self.index(tables)?)? = word;
        TableSet::from_grid(*tables.geometry(), tables.shape()?, &entries).ok()
    }

    /// Whether inverting the bit predicts most of a few differing samples of the row, as far as they can be predicted.
    fn gives_most(self, row: &Witness<'_>, ring: usize) -> bool {
        let own = &row.uploaded.tables;
        let grid = self.word(own).and_then(|word| self.replaced(own, word ^ 1 << self.bit));
        let Some(tables) = grid.and_then(|grid| with_grid(row, &grid)) else { return false };
        let foretold = tables.foretold(ring);
        let known: Vec<_> = row.differing_columns().filter(|column| foretold.contains(column)).collect();
        let tried = known.iter().step_by(known.len().div_ceil(SAMPLES).max(1));
        let given: Vec<_> = tried
            .map(|&column| row.found.get(column) == Some(&tables.output(row.samples(), column)))
            .collect();
        2 * given.iter().filter(|given| **given).count() > given.len()
    }

    fn hypotheses<'a>(self, witnesses: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
        let generations = witnesses.generations();
        let word = |uploaded: &&Generation| Some((uploaded.number, self.word(&uploaded.tables)?));
        let words: Vec<Word> = generations.iter().filter_map(word).collect();
        let broken = |read: Vec<Word>| self.hypothesis(&generations, &words, &read, witnesses.case.ring);
        inversions(&words, self.bit).into_iter().map(broken).collect()
    }

    /// The defect that makes the board read `read` instead of `words`.
    fn hypothesis<'a>(
        self,
        generations: &[&Generation],
        words: &[Word],
        read: &[Word],
        ring: usize,
    ) -> Hypothesis<'a> {
        let grid = |uploaded: &&Generation| {
            Some((uploaded.number, self.replaced(&uploaded.tables, changed(read, uploaded)?)?))
        };
        let grids: BTreeMap<u8, TableSet> = generations.iter().filter_map(grid).collect();
        let illegal = grids.values().any(|grid| grid.check_ring(ring).is_err());
        let (Self { column, row, bit }, reading) = (self, reading(words, read, i64::from));
        with_grids(Defect::GridEntryBitWrong { column, row, bit, reading, illegal }, grids, ring)
    }
}
