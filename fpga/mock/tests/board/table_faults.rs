//! Faults of the tables. A table that is written with the faulty bit wrong is put right by the fault, so a golden row shows
//! that the fault acts.

use halfrow_mock::{Bank, BoardFault, Port, Tables, UNSTRETCHED, Weight};

use crate::support::{GOLDEN_FACTOR, fault, hermite, noise_row, play_frame, small_board};
use halfrow_conformance::golden_rows::HERMITE;

/// The first row that a board with a fault makes of the golden samples, and its tables afterwards.
fn first_row(fault: BoardFault, factor: u32, kernel: &halfrow_mock::Kernel) -> (Vec<u16>, Tables) {
    let (mut player, mut tables) = small_board(Some(fault), &[factor], kernel);
    let mut rows = play_frame(&mut player, &mut tables, 0);
    (rows.remove(0).samples, tables)
}

#[test]
fn a_faulty_row_factor_shows_in_the_row_and_when_read_back() {
    let fault = fault("row-factor", &[("row", "0")]);
    let (samples, tables) = first_row(fault, GOLDEN_FACTOR ^ (1 << 18), &hermite());
    assert_eq!(samples, HERMITE);
    assert_eq!(tables.entry(Bank::Active, 0, Port::ReadBack), Some(GOLDEN_FACTOR));
}

#[test]
fn a_hidden_faulty_row_factor_shows_in_the_row_only() {
    let fault = fault("row-factor", &[("row", "0"), ("bit", "3"), ("hidden", "true")]);
    let (samples, tables) = first_row(fault, GOLDEN_FACTOR ^ 8, &hermite());
    assert_eq!(samples, HERMITE);
    assert_eq!(tables.entry(Bank::Active, 0, Port::ReadBack), Some(GOLDEN_FACTOR ^ 8));
}

#[test]
fn a_faulty_row_factor_spares_the_other_rows() {
    let (mut player, mut tables) = small_board(Some(fault("row-factor", &[])), &[UNSTRETCHED; 5], &hermite());
    let rows = play_frame(&mut player, &mut tables, 0);
    let wrong: Vec<_> = (0..5).filter(|&row| rows[row].samples != noise_row(row as u32, 64)).collect();
    assert_eq!(wrong, [3]);
}

#[test]
fn a_faulty_kernel_word_shows_in_the_row_and_when_read_back() {
    let mut kernel = hermite();
    kernel.nodes[16].g4 ^= 1 << 12;
    let (samples, tables) = first_row(fault("kernel-word", &[]), GOLDEN_FACTOR, &kernel);
    assert_eq!(samples, HERMITE);
    assert_eq!(*tables.kernel(Bank::Active, Port::ReadBack), hermite());
}

#[test]
fn a_hidden_faulty_kernel_word_shows_in_the_row_only() {
    let fault = BoardFault::KernelWord { node: 20, weight: Weight::R1, bit: 15, hidden: true };
    let mut kernel = hermite();
    kernel.nodes[20].r1 ^= i16::MIN;
    let (samples, tables) = first_row(fault, GOLDEN_FACTOR, &kernel);
    assert_eq!(samples, HERMITE);
    assert_eq!(*tables.kernel(Bank::Active, Port::ReadBack), kernel);
}

#[test]
fn a_drifting_entry_flips_once_while_the_board_runs() {
    let fault = fault("drifting-table", &[("after", "2"), ("row", "0")]);
    let (mut player, mut tables) = small_board(Some(fault), &[GOLDEN_FACTOR ^ (1 << 18); 2], &hermite());
    let golden: Vec<_> =
        (0..3).map(|frame| play_frame(&mut player, &mut tables, frame)[0].samples == HERMITE).collect();
    assert_eq!(golden, [false, true, true]);
    assert_eq!(tables.entry(Bank::Active, 0, Port::ReadBack), Some(GOLDEN_FACTOR));
}

/// Plays a frame of one unstretched row, commits the golden factor, and plays a second frame. Returns whether its row was made
/// with the new table, and the generation that it names.
fn second_frame(fault: BoardFault) -> (bool, u8) {
    let (mut player, mut tables) = small_board(Some(fault), &[UNSTRETCHED], &hermite());
    play_frame(&mut player, &mut tables, 0);
    tables.write_factors(0, &[GOLDEN_FACTOR]).unwrap();
    tables.write_nodes(0, &hermite().nodes).unwrap();
    tables.commit(2, 1).unwrap();
    let row = play_frame(&mut player, &mut tables, 1).remove(0);
    assert_eq!(tables.generation(), 2);
    assert!(row.samples == HERMITE || row.samples == noise_row(0, 64));
    (row.samples == HERMITE, row.name.generation)
}

#[test]
fn a_healthy_board_uses_the_new_table_and_says_so() {
    assert_eq!(second_frame(BoardFault::Late), (true, 2));
}

#[test]
fn a_stale_board_uses_the_old_table_and_says_so() {
    assert_eq!(second_frame(fault("stale-table", &[])), (false, 1));
}

#[test]
fn a_stale_board_can_deny_that_it_uses_the_old_table() {
    assert_eq!(second_frame(fault("stale-table-hidden", &[])), (false, 2));
}
