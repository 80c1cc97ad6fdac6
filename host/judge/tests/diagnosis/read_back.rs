//! Tables that read back wrong.

use halfrow::board::Table;
use halfrow::diagnosis::read_back;
use halfrow::result::{Defect, Suspect, TableWord};
use halfrow::tables::Generation;
use halfrow_model::{BitDepth, Geometry, Interpolant, Kernel, TableSet};

use crate::bench::grid;

fn factors() -> Vec<u32> {
    (0..100_u32).map(|row| 16_777_216 - row.wrapping_mul(2_654_435_761) % 5_000_000).collect()
}

/// The suspects for `found`, read back from `table` of a board with `tables` and Hermite's kernel.
fn read(tables: &TableSet, table: Table, found: &[u8]) -> Vec<Suspect> {
    let kernel = Kernel::from(Interpolant::Hermite);
    read_back(&Generation { number: 2, tables: tables.clone(), kernel }, table, found)
}

fn bytes(entries: &[u32]) -> Vec<u8> {
    entries.iter().flat_map(|entry| entry.to_le_bytes()).collect()
}

fn of_factors() -> TableSet {
    let geometry = Geometry::centred(64, 100, BitDepth::Twelve).unwrap();
    TableSet::from_units(geometry, &factors()).unwrap()
}

fn read_factors(found: &[u32]) -> Vec<Suspect> {
    read(&of_factors(), Table::RowFactors, &bytes(found))
}

/// The suspects for a grid of 8 columns and 8 rows whose entries are changed.
fn read_grid(change: impl Fn(usize, &mut u32)) -> Vec<Suspect> {
    let tables = &grid().generations[1].tables;
    let mut entries: Vec<_> = tables.entries().collect();
    entries.iter_mut().enumerate().for_each(|(index, entry)| change(index, entry));
    read(tables, Table::Grid, &bytes(&entries))
}

fn read_nodes(change: impl Fn(usize, &mut [i16; 5])) -> Vec<Suspect> {
    let kernel = Kernel::from(Interpolant::Hermite);
    let mut nodes = kernel.nodes().to_vec();
    nodes.iter_mut().enumerate().for_each(|(node, weights)| change(node, weights));
    read(&of_factors(), Table::Kernel, &Kernel::from_nodes(nodes).unwrap().to_bytes())
}

/// The place that is named first, and the share of the wrong words that it explains.
fn first(suspects: &[Suspect]) -> (String, f64) {
    (suspects[0].place(), suspects[0].explained)
}

#[test]
fn equal_tables_have_no_suspects() {
    assert_eq!(read_factors(&factors()), []);
    assert_eq!(read_grid(|_, _| ()), []);
    assert_eq!(read_nodes(|_, _| ()), []);
}

#[test]
fn one_wrong_factor_is_named_with_its_bit_and_values() {
    let mut found = factors();
    found[17] ^= 1 << 12;
    let suspects = read_factors(&found);
    assert_eq!(first(&suspects), ("row 17's factor, bit 12".to_owned(), 1.0));
    assert_eq!(
        suspects[0].evidence(),
        format!("{} was read where {} was uploaded", found[17], factors()[17])
    );
}

#[test]
fn one_wrong_weight_is_named_with_its_bits() {
    let suspects = read_nodes(|node, weights| {
        if node == 12 {
            weights[1] ^= 0b10_1110;
        }
    });
    assert_eq!(first(&suspects), ("kernel node 12, weight r1, bits 1 to 3, 5".to_owned(), 1.0));
}

#[test]
fn a_stuck_data_line_is_named() {
    let suspects = read_factors(&factors().iter().map(|factor| factor | 1 << 7).collect::<Vec<_>>());
    assert_eq!(first(&suspects), ("row table, data bit 7".to_owned(), 1.0));
    assert!(suspects[0].evidence().contains("stuck at 1"));
    assert_eq!(suspects.len(), 1);
}

#[test]
fn a_stuck_data_line_of_one_weights_memory_is_named() {
    let suspects = read_nodes(|_, weights| weights[2] &= !(1 << 4));
    assert_eq!(first(&suspects), ("kernel memory, weight g4, data bit 4".to_owned(), 1.0));
    assert_eq!(suspects.len(), 1);
}

#[test]
fn a_stuck_address_line_is_named() {
    let suspects = read_factors(&(0..100).map(|row: usize| factors()[row & !8]).collect::<Vec<_>>());
    assert_eq!(first(&suspects), ("row table, address bit 3".to_owned(), 1.0));
    let nodes = *Kernel::from(Interpolant::Hermite).nodes();
    let suspects = read_nodes(|node, weights| *weights = nodes[node & !16]);
    assert_eq!(first(&suspects), ("kernel memory, address bit 4".to_owned(), 1.0));
}

/// Of two entries in the same cell, the one written later stays.
#[test]
fn an_address_line_stuck_for_writing_too_is_named() {
    let later = |row: usize| if row | 32 < 100 { row | 32 } else { row };
    let suspects = read_factors(&(0..100).map(|row| factors()[later(row)]).collect::<Vec<_>>());
    assert_eq!(first(&suspects), ("row table, address bit 5".to_owned(), 1.0));
}

/// In a memory with two ports, half of the cells are never written, and keep what they held.
#[test]
fn an_address_line_stuck_for_writing_alone_is_named() {
    let mut cells = vec![1 << 24; 100];
    factors().into_iter().enumerate().for_each(|(row, factor)| cells[row & !4] = factor);
    let suspects = read_factors(&cells);
    assert_eq!(suspects.len(), 1, "{suspects:#?}");
    assert_eq!(first(&suspects).0, "row table, write address bit 2");
    let nodes = *Kernel::from(Interpolant::Hermite).nodes();
    let written = |node: usize| if node & 16 > 0 { [0; 5] } else { nodes[(node | 16).min(64)] };
    let suspects = read_nodes(|node, weights| *weights = written(node));
    assert_eq!(first(&suspects).0, "kernel memory, write address bit 4");
}

#[test]
fn entries_read_one_place_off_are_named() {
    let suspects =
        read_factors(&(0..100).map(|row: usize| factors()[row.saturating_sub(1)]).collect::<Vec<_>>());
    assert_eq!(first(&suspects), ("row table, its address".to_owned(), 1.0));
    assert!(suspects[0].evidence().contains("the one before"));
}

#[test]
fn a_dead_table_is_named() {
    assert_eq!(first(&read_factors(&[0; 100])), ("row table".to_owned(), 1.0));
}

#[test]
fn words_without_a_common_cause_are_counted() {
    let mut found = factors();
    for (row, bit) in [(5, 3), (40, 9), (77, 20)] {
        found[row] ^= 1 << bit;
    }
    let suspects = read_factors(&found);
    assert_eq!(first(&suspects), ("row 5's factor, bit 3".to_owned(), 1.0 / 3.0));
    assert!(suspects[0].evidence().contains("the first of 3 wrong words"));
}

#[test]
fn a_table_of_another_length_is_told_by_its_length() {
    let suspects = read_factors(&factors()[..60]);
    assert_eq!(suspects[0].evidence(), "100 entries were uploaded and 60 came back");
    let half_a_node = read(&of_factors(), Table::Kernel, &[1, 2, 3]);
    assert_eq!(half_a_node[0].evidence(), "65 entries were uploaded and 0 came back");
}

#[test]
fn a_wrong_entry_of_a_grid_is_named_by_grid_row_and_node() {
    for (entry, place) in [
        (0, "grid row 0, offset, bit 12"),
        (7, "grid row 7, offset, bit 12"),
        (8, "grid row 0, node 0, bit 12"),
        (8 * 5 + 3, "grid row 3, node 4, bit 12"),
        (63, "grid row 7, node 6, bit 12"),
    ] {
        let suspects = read_grid(|index, word| *word ^= u32::from(index == entry) << 12);
        assert_eq!(first(&suspects), (place.to_owned(), 1.0));
        assert_eq!(suspects[0].part(), "grid entry");
        assert!(suspects[0].evidence().contains("was read where"), "{}", suspects[0].evidence());
    }
}

#[test]
fn wrong_entries_of_a_grid_are_counted_or_named_by_their_line() {
    let suspects = read_grid(|index, word| *word ^= u32::from(index % 30 == 19) << 3);
    assert_eq!(first(&suspects), ("grid row 3, node 1, bit 3".to_owned(), 0.5));
    assert!(suspects[0].evidence().contains("the first of 2 wrong words"), "{}", suspects[0].evidence());
    let suspects = read_grid(|_, word| *word |= 1 << 9);
    assert_eq!(first(&suspects), ("row table, data bit 9".to_owned(), 1.0));
}

/// Of entries A, B, A, A, the second one wrong. Were address line 0 stuck for writing, the first would read B as well, and nothing is
/// known of the others.
#[test]
fn a_line_that_explains_one_word_of_two_is_not_named() {
    let [a, b] = [1 << 23, 1 << 22];
    let geometry = Geometry::centred(64, 4, BitDepth::Twelve).unwrap();
    let tables = TableSet::from_units(geometry, &[a, b, a, a]).unwrap();
    let suspects = read(&tables, Table::RowFactors, &bytes(&[b, b + 3, a, a]));
    assert_eq!(suspects.len(), 1, "{suspects:?}");
    let Defect::TableWordWrong(TableWord { entry: 0, wrong: 2, .. }) = suspects[0].defect else {
        panic!("{suspects:?}")
    };
    assert_eq!(suspects[0].explained, 0.5);
}

/// A word of the row table has four bytes, one of the kernel two. The value of a palindrome says nothing.
#[test]
fn bytes_in_the_wrong_order_are_named_and_no_memory_is_blamed() {
    let reversed = factors().iter().map(|factor| factor.swap_bytes()).collect::<Vec<_>>();
    let nodes = read_nodes(|_, weights| *weights = weights.map(i16::swap_bytes));
    let entries = read_grid(|_, entry| *entry = entry.swap_bytes());
    for (suspects, table) in
        [(read_factors(&reversed), "row table"), (nodes, "kernel memory"), (entries, "row table")]
    {
        assert_eq!(first(&suspects), (format!("{table}, the order of its bytes"), 1.0));
        assert_eq!(suspects.len(), 1, "{suspects:#?}");
        assert!(suspects[0].designer().contains("the lowest comes first"), "{}", suspects[0].designer());
        assert!(suspects[0].technician().contains("try another board"), "{}", suspects[0].technician());
    }
    // Another word that is wrong is explained by no order.
    let other =
        reversed.iter().enumerate().map(|(row, factor)| factor ^ u32::from(row == 50)).collect::<Vec<_>>();
    assert_eq!(first(&read_factors(&other)).0, "row table, 100 of its 100 words");
}

/// Cells break one by one, so that a board is given up for a few of them alone.
#[test]
fn many_words_without_a_common_cause_are_no_broken_memory() {
    let told = |wrong: usize| {
        let found: Vec<_> = factors()
            .iter()
            .enumerate()
            .map(|(row, factor)| factor ^ if row < wrong { 5 << (row % 7) } else { 0 })
            .collect();
        let suspects = read_factors(&found);
        assert_eq!(suspects.len(), 1, "{suspects:#?}");
        (suspects[0].place(), suspects[0].evidence(), suspects[0].technician())
    };
    let (place, _, technician) = told(8);
    assert_eq!(place, "row 0's factor, bits 0 and 2");
    assert!(technician.contains("a memory block"), "{technician}");
    let (place, evidence, technician) = told(9);
    assert_eq!(place, "row table, 9 of its 100 words");
    let first = factors()[0];
    let told = format!("in entry 0, {} was read where {first} was uploaded", first ^ 5);
    assert!(evidence.starts_with(&told) && evidence.contains("the first of 9 wrong words"), "{evidence}");
    assert!(technician.contains("try another board"), "{technician}");
}
