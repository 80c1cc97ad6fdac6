//! Words for wrong tables: as the samples show it, and as they read back.

use super::places;
use super::{LOGIC, MEMORY, Words, memory};
use crate::result::{Memory, Reading, TableWord, TableWords};
use crate::words::{count, grouped};

pub(super) fn row_bit(row: usize, bit: u32, reading: &Reading, above_one: bool) -> Words {
    let illegal = if above_one { " (above 1, so only part of the row can be predicted)" } else { "" };
    row_factor(
        row,
        format!("row {row}'s factor, {}", bits(bit, reading)),
        format!("{}{illegal}", read(reading)),
    )
}

pub(super) fn row_value(row: usize, only: Option<u8>, values: (u32, u32), uploaded: u32) -> Words {
    let values = (i64::from(values.0), i64::from(values.1));
    row_factor(row, format!("row {row}'s factor"), read_value(values, uploaded.into(), only))
}

fn row_factor(row: usize, place: String, defect: String) -> Words {
    Words {
        part: "row factor",
        place,
        defect,
        designer: format!(
            "Check entry {row} of the row table as the datapath reads it, and the memory that holds it."
        ),
        technician: MEMORY,
    }
}

pub(super) fn grid_bit(entry: (usize, usize), bit: u32, reading: &Reading, illegal: bool) -> Words {
    let illegal =
        if illegal { " (which leads out of the row, so only part of it can be predicted)" } else { "" };
    let (column, row) = entry;
    Words {
        part: "grid entry",
        place: format!("{}, {}", grid_entry(entry), bits(bit, reading)),
        defect: format!("{}{illegal}", read(reading)),
        designer: format!(
            "Check entry ({column}, {row}) of the grid as the datapath reads it, and the memory that holds it."
        ),
        technician: MEMORY,
    }
}

/// "grid row 4, node 11"
fn grid_entry((column, row): (usize, usize)) -> String {
    match column.checked_sub(1) {
        None => format!("grid row {row}, offset"),
        Some(node) => format!("grid row {row}, node {node}"),
    }
}

pub(super) fn word_bit(node: usize, weight: &str, bit: u32, reading: &Reading) -> Words {
    kernel_word(node, weight, &format!(", {}", bits(bit, reading)), read(reading))
}

pub(super) fn word_value(word: (usize, &str), only: Option<u8>, values: (i64, i64), uploaded: i16) -> Words {
    kernel_word(word.0, word.1, "", read_value(values, uploaded.into(), only))
}

fn kernel_word(node: usize, weight: &str, bit: &str, defect: String) -> Words {
    Words {
        part: "kernel word",
        place: format!("kernel node {node}, weight {weight}{bit}"),
        defect,
        designer: format!(
            "Check node {node} of the kernel as the datapath reads it, and the memory that holds weight {weight}."
        ),
        technician: MEMORY,
    }
}

/// "the value read as 5 instead of 7", with the generation when the other tables are right.
fn read(reading: &Reading) -> String {
    let Reading { uploaded, read, generation, only, alike } = reading;
    let tables = in_tables(only.then_some(*generation));
    match alike.as_slice() {
        [] => format!("the value read as {read} instead of {uploaded}{tables}"),
        _ => format!("any one of these bits inverted{tables}"),
    }
}

/// "bit 3", or all bits that would have the same effect.
fn bits(bit: u32, reading: &Reading) -> String {
    if reading.alike.is_empty() {
        return format!("bit {bit}");
    }
    let mut alike = reading.alike.clone();
    alike.push(bit);
    alike.sort_unstable();
    format!("one of {}", places::bits(&alike))
}

fn read_value((least, most): (i64, i64), uploaded: i64, only: Option<u8>) -> String {
    let others = if least == most { String::new() } else { format!(" (or another up to {most})") };
    format!("the value read as {least}{others} instead of {uploaded}{}", in_tables(only))
}

/// The generation, if the other tables are right.
fn in_tables(only: Option<u8>) -> String {
    only.map_or_else(String::new, |generation| format!(" in the tables of generation {generation} only"))
}

/// A table that reads back longer or shorter than it was uploaded.
pub(super) fn length(table: Memory) -> Words {
    let designer = "Check how the board counts entries when it reads a table back.".to_owned();
    Words { designer, technician: LOGIC, ..of_table(table, "the table's length".to_owned(), String::new()) }
}

pub(super) fn word_read(TableWord { table, entry, weight, bits, .. }: &TableWord) -> Words {
    of_table(*table, word(*entry, weight.as_deref(), bits), String::new())
}

pub(super) fn words_read(TableWords { table, wrong, words, .. }: &TableWords) -> Words {
    let place = format!("{}, {} of its {}", memory(*table), grouped(*wrong), count(*words, "word"));
    stored(*table, place, String::new())
}

pub(super) fn bytes_reversed(table: Memory) -> Words {
    let place = format!("{}, the order of its bytes", memory(table));
    stored(table, place, "the bytes of every word in reverse order".to_owned())
}

/// A table of which so much is wrong that the logic around its memory is likelier to blame than the memory.
fn stored(table: Memory, place: String, defect: String) -> Words {
    let designer = "Check how the board writes and reads the entries of TABLE_WRITE and TABLE_READ: their size, their order, and \
                    their bytes, of which the lowest comes first (protocol/WIRE.md)."
        .to_owned();
    Words { designer, technician: LOGIC, ..of_table(table, place, defect) }
}

pub(super) fn grid_entry_read(entry: (usize, usize), bits: &[u32]) -> Words {
    let place = format!("{}, {}", grid_entry(entry), places::bits(bits));
    Words { part: "grid entry", ..of_table(Memory::Rows, place, String::new()) }
}

pub(super) fn data_stuck(table: Memory, weight: Option<&str>, bit: u32, value: u8) -> Words {
    let weight = weight.map_or_else(String::new, |weight| format!(", weight {weight}"));
    let place = format!("{}{weight}, data bit {bit}", memory(table));
    of_table(table, place, format!("this bit stuck at {value}"))
}

pub(super) fn address_stuck(table: Memory, bit: u32, value: u8) -> Words {
    let stuck = match value {
        0 => "this bit stuck at 0 for reading",
        _ => "this bit stuck at 1 for reading, or at 0 or 1 for writing as well",
    };
    of_table(table, format!("{}, address bit {bit}", memory(table)), stuck.to_owned())
}

pub(super) fn write_address_stuck(table: Memory, bit: u32) -> Words {
    let place = format!("{}, write address bit {bit}", memory(table));
    of_table(table, place, "this bit stuck at 0 for writing but right for reading".to_owned())
}

pub(super) fn address_off(table: Memory, entries: isize) -> Words {
    let side = if entries < 0 { "before" } else { "after" };
    of_table(
        table,
        format!("{}, its address", memory(table)),
        format!("every entry read as the one {side} it"),
    )
}

pub(super) fn level_stuck(table: Memory, value: u8) -> Words {
    of_table(table, memory(table).to_owned(), format!("every bit read as {value}"))
}

fn of_table(table: Memory, place: String, defect: String) -> Words {
    let (part, memory) = match table {
        Memory::Rows => ("row factor", "row table's memory"),
        Memory::Kernel => ("kernel word", "kernel's memory"),
    };
    let designer = format!("Check the {memory}, its write path and its supply; then upload again.");
    Words { part, place, defect, designer, technician: MEMORY }
}

fn word(entry: usize, weight: Option<&str>, bits: &[u32]) -> String {
    let name = match weight {
        None => format!("row {entry}'s factor"),
        Some(weight) => format!("kernel node {entry}, weight {weight}"),
    };
    format!("{name}, {}", places::bits(bits))
}
