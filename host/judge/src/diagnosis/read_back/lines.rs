//! Single lines of a table's memory that make many words wrong.

use halfrow_model::TAP_NAMES;

use super::Words;
use crate::board::Table;
use crate::report::Suspect;

/// Suspects that are named.
const NAMED: usize = 3;
/// Fewer words that a line explains are chance.
const LEAST_EXPLAINED: usize = 2;

/// A line out of order.
struct Line<'a> {
    place: String,
    defect: String,
    /// The word read at an index; none where that cannot be known.
    read: Box<dyn Fn(usize) -> Option<u32> + 'a>,
}

/// The lines that explain all `wrong` words and change no other.
pub(super) fn suspects(expected: Words<'_>, found: Words<'_>, wrong: usize) -> Vec<Suspect> {
    let fitting: Vec<_> = lines(expected)
        .filter_map(|line| Some((explained(&line, expected, found)?, line)))
        .filter(|(explained, _)| *explained >= LEAST_EXPLAINED)
        .collect();
    let unsure =
        if fitting.len() > 1 { "; other lines would read alike, so this is not certain" } else { "" };
    fitting
        .into_iter()
        .take(NAMED)
        .map(|(explained, line)| Suspect {
            part: expected.part(),
            place: line.place,
            evidence: format!(
                "{} gives {explained} of the {wrong} wrong words, and changes no other{unsure}",
                line.defect
            ),
            next_step: expected.next_step(),
            explained: explained as f64 / wrong as f64,
        })
        .collect()
}

/// How many wrong words the line reads as they were found; none if it reads any word otherwise.
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

fn lines(words: Words<'_>) -> impl Iterator<Item = Line<'_>> {
    let entries = words.count() / words.per_entry();
    let address_bits = usize::BITS - entries.saturating_sub(1).leading_zeros();
    let levels = [(false, "0"), (true, "1")];
    let data = (0..words.bits()).flat_map(move |bit| levels.map(|level| (bit, level)));
    let address = (0..address_bits).flat_map(move |bit| levels.map(|level| (bit, level)));
    data.flat_map(move |(bit, level)| data_lines(words, bit, level))
        .chain(address.map(move |(bit, level)| address_line(words, bit, level)))
        .chain([shifted(words, -1), shifted(words, 1)])
        .chain([(0, "0"), (u32::MAX, "1")].map(move |level| all(words, level)))
}

/// A data line of the whole table or, in a kernel, of the memory of one weight.
fn data_lines<'a>(words: Words<'a>, bit: u32, (high, name): (bool, &str)) -> Vec<Line<'a>> {
    let forced = move |word: u32| if high { word | 1 << bit } else { word & !(1 << bit) };
    let whole = Line {
        place: format!("{}, data bit {bit}", memory(words)),
        defect: format!("this bit stuck at {name}"),
        read: Box::new(move |index| words.word(index).map(forced)),
    };
    let weights = match words.table {
        Table::Steps => &[][..],
        Table::Kernel => &TAP_NAMES[..],
    };
    let of_weight = |(tap, weight): (usize, &&str)| Line {
        place: format!("{}, weight {weight}, data bit {bit}", memory(words)),
        defect: format!("this bit stuck at {name}"),
        read: Box::new(move |index| {
            let word = words.word(index);
            if index % words.per_entry() == tap { word.map(forced) } else { word }
        }),
    };
    weights.iter().enumerate().map(of_weight).chain([whole]).collect()
}

/// An address line stuck for reading or, at either level, for writing as well: then the later entry stays.
fn address_line<'a>(words: Words<'a>, bit: u32, (high, name): (bool, &str)) -> Line<'a> {
    let read = move |entry: usize| if high { entry | 1 << bit } else { entry & !(1 << bit) };
    let stuck = if high {
        "this bit stuck at 1, or at either level for writing too,".to_owned()
    } else {
        format!("this bit stuck at {name} for reading")
    };
    Line {
        place: format!("{}, address bit {bit}", memory(words)),
        defect: stuck,
        read: Box::new(move |index| word_of(words, read(index / words.per_entry()), index)),
    }
}

/// Entries read one place off.
fn shifted(words: Words<'_>, distance: isize) -> Line<'_> {
    let side = if distance < 0 { "before" } else { "after" };
    Line {
        place: format!("{}, its address", memory(words)),
        defect: format!("every entry read as the one {side} it"),
        read: Box::new(move |index| {
            let entry = (index / words.per_entry()).checked_add_signed(distance)?;
            word_of(words, entry, index)
        }),
    }
}

/// Nothing but one level.
fn all<'a>(words: Words<'a>, (word, name): (u32, &str)) -> Line<'a> {
    let mask = u32::MAX >> (u32::BITS - 8 * words.word_bytes() as u32);
    Line {
        place: memory(words).to_owned(),
        defect: format!("every bit read as {name}"),
        read: Box::new(move |_| Some(word & mask)),
    }
}

/// The word at the place of `index` in another entry.
fn word_of(words: Words<'_>, entry: usize, index: usize) -> Option<u32> {
    words.word(entry * words.per_entry() + index % words.per_entry())
}

fn memory(words: Words<'_>) -> &'static str {
    match words.table {
        Table::Steps => "row table",
        Table::Kernel => "kernel memory",
    }
}
