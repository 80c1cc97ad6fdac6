//! Which entries of a table read back wrong, and what they have in common.

mod lines;

use halfrow_model::{RowFactor, WEIGHT_NAMES};

use crate::board::Table;
use crate::compare::bits_in;
use crate::result::{Account, Defect, Memory, Suspect, TableWord, TableWords};
use crate::tables::Generation;

/// A table as words: row factors, grid entries, or the weights of one node after the other.
#[derive(Clone, Copy, Debug)]
struct Words<'a> {
    table: Table,
    /// Rows of a grid.
    grid_rows: Option<usize>,
    bytes: &'a [u8],
}

/// If more words than this are wrong, cells of their own are not to blame.
const FEW_WORDS: usize = 8;

/// A word that reads back with another value.
#[derive(Clone, Copy, Debug)]
struct WrongWord {
    index: usize,
    expected: u32,
    found: u32,
}

/// The parts that explain why `found`, in wire format, was read back from `table` instead of what was uploaded: at most three,
/// the likeliest first; none if they are equal.
///
/// A single wrong entry is named with the bits that differ. Several are named by the line that would cause them, if a single line
/// would, or by the order of their bytes, otherwise by their number and the first of them.
#[must_use]
pub fn read_back(uploaded: &Generation, table: Table, found: &[u8]) -> Vec<Suspect> {
    let Generation { tables, kernel, .. } = uploaded;
    let bytes = match table {
        Table::RowFactors | Table::Grid => tables.to_bytes(),
        Table::Kernel => kernel.to_bytes(),
    };
    let grid_rows = tables.shape().map(|shape| shape.rows(tables.geometry()));
    let [expected, found] = [&bytes[..], found].map(|bytes| Words { table, grid_rows, bytes });
    if expected.bytes.len() != found.bytes.len() {
        return vec![wrong_length(expected, found)];
    }
    let wrong: Vec<_> = (0..expected.count())
        .filter_map(|index| {
            let word = WrongWord { index, expected: expected.word(index)?, found: found.word(index)? };
            (word.expected != word.found).then_some(word)
        })
        .collect();
    match wrong.as_slice() {
        [] => Vec::new(),
        &[only] => vec![one_word(expected, only, 1)],
        [first, ..] => {
            let suspects = lines::suspects(expected, found, wrong.len());
            match wrong.len() {
                _ if !suspects.is_empty() => suspects,
                ..=FEW_WORDS => vec![one_word(expected, *first, wrong.len())],
                many => vec![many_words(expected, *first, many)],
            }
        }
    }
}

impl<'a> Words<'a> {
    /// Words in an entry.
    fn per_entry(self) -> usize {
        match self.table {
            Table::RowFactors | Table::Grid => 1,
            Table::Kernel => WEIGHT_NAMES.len(),
        }
    }

    /// Bits that a word uses.
    fn bits(self) -> u32 {
        match self.table {
            Table::RowFactors | Table::Grid => RowFactor::BITS,
            Table::Kernel => 16,
        }
    }

    fn word_bytes(self) -> usize {
        self.table.entry_bytes() / self.per_entry()
    }

    fn count(self) -> usize {
        self.bytes.len() / self.word_bytes()
    }

    fn entries(self) -> usize {
        self.count() / self.per_entry()
    }

    /// The word at `index`, as an unsigned number.
    fn word(self, index: usize) -> Option<u32> {
        let length = self.word_bytes();
        let bytes: &'a [u8] = self.bytes.get(index * length..)?.get(..length)?;
        Some(bytes.iter().rev().fold(0, |word, &byte| word << 8 | u32::from(byte)))
    }

    /// The value of a word as people write it.
    fn value(self, word: u32) -> i64 {
        match self.table {
            Table::RowFactors | Table::Grid => i64::from(word),
            Table::Kernel => i64::from(word as u16 as i16),
        }
    }

    fn memory(self) -> Memory {
        match self.table {
            Table::RowFactors | Table::Grid => Memory::Rows,
            Table::Kernel => Memory::Kernel,
        }
    }

    /// In a kernel, the name of the weight at `index`.
    fn weight(self, index: usize) -> Option<String> {
        match self.table {
            Table::RowFactors | Table::Grid => None,
            Table::Kernel => WEIGHT_NAMES.get(index % self.per_entry()).map(|&weight| weight.to_owned()),
        }
    }
}

fn wrong_length(expected: Words<'_>, found: Words<'_>) -> Suspect {
    let entry = expected.table.entry_bytes();
    let (uploaded, read) = (expected.bytes.len() / entry, found.bytes.len() / entry);
    let defect = Defect::TableLengthWrong { table: expected.memory(), uploaded, read };
    Suspect::explaining_nothing(defect)
}

/// The suspect for `word`, the first of `count` wrong words.
fn one_word(words: Words<'_>, word: WrongWord, count: usize) -> Suspect {
    let bits = bits_in(word.expected ^ word.found);
    let [uploaded, read] = [word.expected, word.found].map(|word| words.value(word));
    let entry = word.index / words.per_entry();
    let defect = match (words.table, words.grid_rows) {
        (Table::Grid, Some(rows)) => {
            let (column, row) = (entry / rows, entry % rows);
            Defect::GridEntryReadsWrong { column, row, bits, uploaded, read, wrong: count }
        }
        _ => Defect::TableWordWrong(TableWord {
            table: words.memory(),
            entry,
            weight: words.weight(word.index),
            bits,
            uploaded,
            read,
            wrong: count,
        }),
    };
    let account = Account::Words { wrong: count, explained: 1, others: 0 };
    Suspect { defect, account, explained: 1.0 / count as f64 }
}

/// The suspect for `wrong` words with no common cause, of which `first` is the first.
fn many_words(words: Words<'_>, first: WrongWord, wrong: usize) -> Suspect {
    let [uploaded, read] = [first.expected, first.found].map(|word| words.value(word));
    let defect = Defect::TableWordsWrong(TableWords {
        table: words.memory(),
        entry: first.index / words.per_entry(),
        weight: words.weight(first.index),
        uploaded,
        read,
        wrong,
        words: words.count(),
    });
    Suspect::explaining_nothing(defect)
}
