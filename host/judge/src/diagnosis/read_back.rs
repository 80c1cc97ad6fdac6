//! Which entries of a table read back wrong, and what they have in common.

mod lines;

use halfrow_model::TAP_NAMES;

use crate::board::Table;
use crate::report::Suspect;

/// A table as words: row factors, or the weights of nodes one after the other.
#[derive(Clone, Copy, Debug)]
struct Words<'a> {
    table: Table,
    bytes: &'a [u8],
}

/// A word that reads back as another.
#[derive(Clone, Copy, Debug)]
struct WrongWord {
    index: usize,
    expected: u32,
    found: u32,
}

/// The parts that explain why `found` was read of `table` where `expected` was uploaded, both as on the wire: at most
/// three, the likeliest first, none when they are equal.
///
/// One wrong entry is named with the bits that differ. Several are named by the line that would make them, if a single
/// one would, and else by their number and the first.
#[must_use]
pub fn read_back(table: Table, expected: &[u8], found: &[u8]) -> Vec<Suspect> {
    let (expected, found) = (Words { table, bytes: expected }, Words { table, bytes: found });
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
            if suspects.is_empty() { vec![one_word(expected, *first, wrong.len())] } else { suspects }
        }
    }
}

impl<'a> Words<'a> {
    /// Words in an entry.
    fn per_entry(self) -> usize {
        match self.table {
            Table::Steps => 1,
            Table::Kernel => TAP_NAMES.len(),
        }
    }

    /// Bits that a word uses.
    fn bits(self) -> u32 {
        match self.table {
            Table::Steps => 25,
            Table::Kernel => 16,
        }
    }

    fn word_bytes(self) -> usize {
        self.table.entry_bytes() / self.per_entry()
    }

    fn count(self) -> usize {
        self.bytes.len() / self.word_bytes()
    }

    /// The word at `index`, unsigned.
    fn word(self, index: usize) -> Option<u32> {
        let length = self.word_bytes();
        let bytes: &'a [u8] = self.bytes.get(index * length..)?.get(..length)?;
        Some(bytes.iter().rev().fold(0, |word, &byte| word << 8 | u32::from(byte)))
    }

    /// "row 5's factor"
    fn name(self, index: usize) -> String {
        match self.table {
            Table::Steps => format!("row {index}'s factor"),
            Table::Kernel => {
                let weight = TAP_NAMES.get(index % self.per_entry()).copied().unwrap_or_default();
                format!("kernel node {}, weight {weight}", index / self.per_entry())
            }
        }
    }

    /// A word as people write it.
    fn value(self, word: u32) -> i64 {
        match self.table {
            Table::Steps => i64::from(word),
            Table::Kernel => i64::from(word as u16 as i16),
        }
    }

    fn part(self) -> &'static str {
        match self.table {
            Table::Steps => "row factor",
            Table::Kernel => "kernel word",
        }
    }

    fn next_step(self) -> String {
        let memory = match self.table {
            Table::Steps => "row table's memory",
            Table::Kernel => "kernel's memory",
        };
        format!("Check the {memory}, its write path and its supply; then upload again.")
    }
}

fn wrong_length(expected: Words<'_>, found: Words<'_>) -> Suspect {
    let entry = expected.table.entry_bytes();
    Suspect {
        part: expected.part(),
        place: "the table's length".to_owned(),
        evidence: format!(
            "{} entries were uploaded and {} came back",
            expected.bytes.len() / entry,
            found.bytes.len() / entry
        ),
        next_step: "Check how the board counts entries when it reads a table back.".to_owned(),
        explained: 0.0,
    }
}

/// The word `word`, the first of `count` that are wrong.
fn one_word(words: Words<'_>, word: WrongWord, count: usize) -> Suspect {
    let differing = word.expected ^ word.found;
    let bits: Vec<_> =
        (0..u32::BITS).filter(|bit| differing >> bit & 1 == 1).map(|bit| bit.to_string()).collect();
    let label = if bits.len() == 1 { "bit" } else { "bits" };
    let (expected, found) = (words.value(word.expected), words.value(word.found));
    let first = if count == 1 {
        String::new()
    } else {
        format!("; it is the first of {count} wrong words, which no single line explains")
    };
    Suspect {
        part: words.part(),
        place: format!("{}, {label} {}", words.name(word.index), bits.join(", ")),
        evidence: format!("{found} was read where {expected} was uploaded{first}"),
        next_step: words.next_step(),
        explained: 1.0 / count as f64,
    }
}
