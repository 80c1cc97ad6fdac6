//! Words for wrong tables: as the samples show it, and as they read back.

use super::places;
use super::{LOGIC, MEMORY, Words, memory};
use crate::result::{Defect, Memory, Reading};

/// The words for what samples show about single words of tables.
pub(super) fn as_seen(defect: &Defect) -> Option<Words> {
    Some(match defect {
        Defect::RowFactorBitWrong { row, bit, reading, above_one } => {
            row_bit(*row, *bit, reading, *above_one)
        }
        Defect::RowFactorWrong { row, generation, least, most, uploaded, only } => {
            row_value(*row, only.then_some(*generation), (*least, *most), *uploaded)
        }
        Defect::GridEntryBitWrong { column, row, bit, reading, illegal } => {
            grid_bit((*column, *row), *bit, reading, *illegal)
        }
        Defect::KernelWordBitWrong { node, weight, bit, reading } => word_bit(*node, weight, *bit, reading),
        Defect::KernelWordWrong { node, weight, generation, least, most, uploaded, only } => {
            word_value((*node, weight), only.then_some(*generation), (*least, *most), *uploaded)
        }
        _ => return None,
    })
}

fn row_bit(row: usize, bit: u32, reading: &Reading, above_one: bool) -> Words {
    let illegal = if above_one { " (above 1, so only part of the row can be predicted)" } else { "" };
    row_factor(
        row,
        format!("row {row}'s factor, {}", bits(bit, reading)),
        format!("{}{illegal}", read(reading)),
    )
}

fn row_value(row: usize, only: Option<u8>, values: (u32, u32), uploaded: u32) -> Words {
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

fn grid_bit(entry: (usize, usize), bit: u32, reading: &Reading, illegal: bool) -> Words {
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

fn word_bit(node: usize, weight: &str, bit: u32, reading: &Reading) -> Words {
    kernel_word(node, weight, &format!(", {}", bits(bit, reading)), read(reading))
}

fn word_value(word: (usize, &str), only: Option<u8>, values: (i64, i64), uploaded: i16) -> Words {
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

/// The words for what was seen when a table was read back.
pub(super) fn read_back(defect: &Defect) -> Option<Words> {
    let (table, place, defect) = match defect {
        Defect::TableLengthWrong { table, .. } => {
            let words = of_table(*table, "the table's length".to_owned(), String::new());
            let designer = "Check how the board counts entries when it reads a table back.".to_owned();
            return Some(Words { designer, technician: LOGIC, ..words });
        }
        Defect::TableWordWrong { table, entry, weight, bits, .. } => {
            (table, word(*entry, weight.as_deref(), bits), String::new())
        }
        Defect::GridEntryReadsWrong { column, row, bits, .. } => {
            let place = format!("{}, {}", grid_entry((*column, *row)), places::bits(bits));
            return Some(Words { part: "grid entry", ..of_table(Memory::Rows, place, String::new()) });
        }
        Defect::TableDataStuck { table, weight, bit, value } => {
            let weight = weight.as_ref().map_or_else(String::new, |weight| format!(", weight {weight}"));
            let place = format!("{}{weight}, data bit {bit}", memory(*table));
            (table, place, format!("this bit stuck at {value}"))
        }
        Defect::TableAddressStuck { table, bit, value } => {
            let stuck = match value {
                0 => "this bit stuck at 0 for reading",
                _ => "this bit stuck at 1 for reading, or at 0 or 1 for writing as well",
            };
            (table, format!("{}, address bit {bit}", memory(*table)), stuck.to_owned())
        }
        Defect::TableWriteAddressStuck { table, bit } => {
            let place = format!("{}, write address bit {bit}", memory(*table));
            (table, place, "this bit stuck at 0 for writing but right for reading".to_owned())
        }
        Defect::TableAddressOff { table, entries } => {
            let side = if *entries < 0 { "before" } else { "after" };
            let place = format!("{}, its address", memory(*table));
            (table, place, format!("every entry read as the one {side} it"))
        }
        Defect::TableLevelStuck { table, value } => {
            (table, memory(*table).to_owned(), format!("every bit read as {value}"))
        }
        _ => return None,
    };
    Some(of_table(*table, place, defect))
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
