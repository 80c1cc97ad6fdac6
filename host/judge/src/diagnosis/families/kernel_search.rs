//! A word of the kernel with any value, found from the samples themselves.

use std::ops::Range;

use super::first_where;
use super::kernel_word::{KernelWord, common_words};
use crate::diagnosis::datapath::RowTables;
use crate::diagnosis::hypothesis::Hypothesis;
use crate::diagnosis::witnesses::{Witness, Witnesses};
use crate::result::Defect;
use crate::tables::Generation;

/// Differing rows that must agree, and as many that do not differ.
const ROWS: usize = 192;
/// All values of a word.
const VALUES: Range<i64> = i16::MIN as i64..i16::MAX as i64 + 1;

/// The weights that outputs were really made with, at the nodes that all differing samples need. Each generation is searched
/// separately.
pub(super) fn propose<'a>(witnesses: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    common_words(witnesses).into_iter().filter_map(|word| any_value(witnesses, word)).collect()
}

fn any_value<'a>(witnesses: &Witnesses<'a>, word: KernelWord) -> Option<Hypothesis<'a>> {
    let generations = witnesses.generations();
    let found: Vec<_> = generations
        .iter()
        .filter_map(|uploaded| Some((uploaded, values(witnesses, uploaded.number, word)?)))
        .collect();
    let (last, values) = found.last()?;
    let defect = Defect::KernelWordWrong {
        node: word.node,
        weight: word.weight(),
        generation: last.number,
        least: values.start,
        most: values.end - 1,
        uploaded: word.of(&last.kernel)?,
        only: found.len() < generations.len(),
    };
    let kernel = |(uploaded, values): &(&&Generation, Range<i64>)| {
        Some((uploaded.number, word.replaced(&uploaded.kernel, values.start as i16)?))
    };
    Some(super::with_kernels(defect, found.iter().filter_map(kernel).collect()))
}

/// The values of the word that give every sample made with it under the tables of a generation; none if no value does, or if none
/// of these samples differs.
fn values(witnesses: &Witnesses<'_>, generation: u8, word: KernelWord) -> Option<Range<i64>> {
    let mut values = VALUES;
    let mut differ = false;
    for row in witnesses.sample(ROWS).filter(|row| row.uploaded.number == generation) {
        differ |= row.differences > 0;
        let tables = row.tables();
        for column in 0..row.found.len() {
            let node = tables.source(column).node;
            if node == word.node || node + 1 == word.node {
                values = narrowed(values, row, &tables, column, word)?;
            }
        }
    }
    differ.then_some(values)
}

/// Those of `values` that give the sample that was found; none if none does. The output moves in one direction as the weight
/// grows.
fn narrowed(
    values: Range<i64>,
    row: &Witness<'_>,
    tables: &RowTables<'_>,
    column: usize,
    word: KernelWord,
) -> Option<Range<i64>> {
    let found = *row.found.get(column)?;
    let output = |value: i64| {
        let kernel = word.replaced(&row.uploaded.kernel, value as i16);
        kernel.map_or(found, |kernel| {
            RowTables { kernel: &kernel, ..tables.clone() }.output(row.samples(), column)
        })
    };
    let rises = output(values.start) <= output(values.end - 1);
    let reached = |value| if rises { output(value) >= found } else { output(value) <= found };
    let start = first_where(values.clone(), reached);
    let end = first_where(start..values.end, |value| output(value) != found);
    (start < end).then_some(start..end)
}
