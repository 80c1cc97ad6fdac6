//! Single lines of a table's memory that make many words wrong, and words whose bytes are in the wrong order.

use halfrow_model::WEIGHT_NAMES;

use super::Words;
use crate::board::Table;
use crate::diagnosis::address_bits;
use crate::result::{Account, Defect, Suspect};

/// The most suspects that are named.
const NAMED: usize = 3;
/// Fewer explained words than this are a coincidence.
const LEAST_EXPLAINED: usize = 2;

/// A broken line.
struct Line<'a> {
    defect: Defect,
    /// The word read at an index; none if it cannot be known.
    read: Box<dyn Fn(usize) -> Option<u32> + 'a>,
}

/// The lines that make all `wrong` words read as found, and change no other.
pub(super) fn suspects(expected: Words<'_>, found: Words<'_>, wrong: usize) -> Vec<Suspect> {
    let explaining = |lines: &mut dyn Iterator<Item = Line<'_>>| {
        let explaining = lines.filter_map(|line| Some((explained(&line, expected, found)?, line.defect)));
        explaining.filter(|(explained, _)| *explained >= LEAST_EXPLAINED).collect::<Vec<_>>()
    };
    let mut fitting = explaining(&mut lines(expected));
    if fitting.is_empty() {
        fitting = explaining(&mut write_lines(expected));
    }
    let others = fitting.len().saturating_sub(1);
    fitting
        .into_iter()
        .take(NAMED)
        .map(|(explained, defect)| Suspect {
            defect,
            account: Account::Words { wrong, explained, others },
            explained: explained as f64 / wrong as f64,
        })
        .collect()
}

/// How many of the wrong words the line explains; none if it contradicts any word.
fn explained(line: &Line<'_>, expected: Words<'_>, found: Words<'_>) -> Option<usize> {
    let mut explained = 0;
    for index in 0..expected.count() {
        let Some(read) = (line.read)(index) else { continue };
        if found.word(index) != Some(read) {
            return None;
        }
        explained += usize::from(expected.word(index) != Some(read));
    }
    Some(explained)
}

/// The lines for which it is known what every word reads as.
fn lines(words: Words<'_>) -> impl Iterator<Item = Line<'_>> {
    let levels = [0, 1];
    let data = (0..words.bits()).flat_map(move |bit| levels.map(|level| (bit, level)));
    let address = (0..address_bits(words.entries())).flat_map(move |bit| levels.map(|level| (bit, level)));
    data.flat_map(move |(bit, level)| data_lines(words, bit, level))
        .chain(address.map(move |(bit, level)| address_line(words, bit, level)))
        .chain([shifted(words, -1), shifted(words, 1), bytes_reversed(words)])
        .chain(levels.map(move |level| all(words, level)))
}

/// The address lines stuck at 0 for writing alone. One stuck at 1 shows only right entries, and cells that were never written.
fn write_lines(words: Words<'_>) -> impl Iterator<Item = Line<'_>> {
    (0..address_bits(words.entries())).map(move |bit| write_address_line(words, bit))
}

/// A data line of the whole table or, in a kernel, of the memory of one weight.
fn data_lines(words: Words<'_>, bit: u32, value: u8) -> Vec<Line<'_>> {
    let table = words.memory();
    let forced = move |word: u32| if value == 1 { word | 1 << bit } else { word & !(1 << bit) };
    let whole = Line {
        defect: Defect::TableDataStuck { table, weight: None, bit, value },
        read: Box::new(move |index| words.word(index).map(forced)),
    };
    let weights = match words.table {
        Table::RowFactors | Table::Grid => &[][..],
        Table::Kernel => &WEIGHT_NAMES[..],
    };
    let of_weight = |(tap, weight): (usize, &&str)| Line {
        defect: Defect::TableDataStuck { table, weight: Some((*weight).to_owned()), bit, value },
        read: Box::new(move |index| {
            let word = words.word(index);
            if index % words.per_entry() == tap { word.map(forced) } else { word }
        }),
    };
    weights.iter().enumerate().map(of_weight).chain([whole]).collect()
}

/// An address line stuck for reading. If it is stuck for writing too, at either level, the later of two entries stays in their
/// cell, which reads as if it were stuck at 1.
fn address_line(words: Words<'_>, bit: u32, value: u8) -> Line<'_> {
    let read = move |entry: usize| if value == 1 { entry | 1 << bit } else { entry & !(1 << bit) };
    Line {
        defect: Defect::TableAddressStuck { table: words.memory(), bit, value },
        read: Box::new(move |index| word_of(words, read(index / words.per_entry()), index)),
    }
}

/// An address line stuck at 0 for writing alone. Of two entries for one cell the later stays, and the other cell is never
/// written.
fn write_address_line(words: Words<'_>, bit: u32) -> Line<'_> {
    Line {
        defect: Defect::TableWriteAddressStuck { table: words.memory(), bit },
        read: Box::new(move |index| {
            let entry = index / words.per_entry();
            let is_written = entry >> bit & 1 == 0;
            let later = || word_of(words, entry | 1 << bit, index).or_else(|| words.word(index));
            is_written.then(later).flatten()
        }),
    }
}

/// Entries read from one place off.
fn shifted(words: Words<'_>, distance: isize) -> Line<'_> {
    Line {
        defect: Defect::TableAddressOff { table: words.memory(), entries: distance },
        read: Box::new(move |index| {
            let entry = (index / words.per_entry()).checked_add_signed(distance)?;
            word_of(words, entry, index)
        }),
    }
}

/// Words with their highest byte in front.
fn bytes_reversed(words: Words<'_>) -> Line<'_> {
    let unused = u32::BITS - 8 * words.word_bytes() as u32;
    Line {
        defect: Defect::TableBytesReversed { table: words.memory() },
        read: Box::new(move |index| words.word(index).map(|word| word.swap_bytes() >> unused)),
    }
}

/// Every word reads as all zeros or all ones.
fn all(words: Words<'_>, value: u8) -> Line<'_> {
    let mask = u32::MAX >> (u32::BITS - 8 * words.word_bytes() as u32);
    let word = if value == 1 { mask } else { 0 };
    Line {
        defect: Defect::TableLevelStuck { table: words.memory(), value },
        read: Box::new(move |_| Some(word)),
    }
}

/// The word of another entry at the same place within the entry as `index`.
fn word_of(words: Words<'_>, entry: usize, index: usize) -> Option<u32> {
    words.word(entry * words.per_entry() + index % words.per_entry())
}
