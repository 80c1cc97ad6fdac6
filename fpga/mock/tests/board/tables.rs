//! Two banks of tables: writing one, committing it, and what is refused.

use halfrow_mock::{Bank, Node, Options, Port, TableError, Tables, TapCount, UNSTRETCHED};

use crate::support::{GOLDEN_FACTOR, hermite, keys, noise_row, play_frame, small_board};
use halfrow_conformance::golden_rows::HERMITE;

fn tables() -> Tables {
    Tables::new(&Options::default(), None)
}

#[test]
fn a_commit_takes_effect_with_row_0_of_its_frame() {
    let (mut player, mut tables) = small_board(None, &[UNSTRETCHED; 2], &hermite());
    play_frame(&mut player, &mut tables, 0);
    tables.write_factors(0, &[GOLDEN_FACTOR]).unwrap();
    tables.write_nodes(0, &hermite().nodes).unwrap();
    tables.commit(2, 5).unwrap();
    let before = play_frame(&mut player, &mut tables, 4);
    let after = play_frame(&mut player, &mut tables, 5);
    assert_eq!((&before[0].samples, before[0].name.generation), (&noise_row(0, 64), 1));
    assert_eq!((&after[0].samples[..], after[0].name.generation), (&HERMITE[..], 2));
}

#[test]
fn the_banks_change_places_at_a_commit() {
    let mut tables = tables();
    tables.write_factors(3, &[5, 6]).unwrap();
    tables.commit(9, 0).unwrap();
    tables.start_frame(0);
    assert_eq!(tables.entry(Bank::Active, 4, Port::ReadBack), Some(6));
    assert_eq!(tables.entry(Bank::Shadow, 4, Port::ReadBack), Some(UNSTRETCHED));
    assert_eq!(tables.generation(), 9);
}

#[test]
fn a_committed_bank_cannot_be_written_before_its_frame() {
    let mut tables = tables();
    tables.commit(1, 7).unwrap();
    let pending = Err(TableError::CommitPending { first_frame: 7 });
    assert_eq!(tables.write_factors(0, &[1]), pending);
    assert_eq!(tables.write_nodes(0, &hermite().nodes), pending);
    assert_eq!(tables.commit(2, 8), pending);
    tables.start_frame(7);
    assert_eq!(tables.write_factors(0, &[1]), Ok(()));
}

#[test]
fn entries_beyond_a_table_are_refused() {
    let mut tables = tables();
    let beyond = |entry, entries| Err(TableError::NoSuchEntry { entry, entries });
    assert_eq!(tables.write_factors(2047, &[1, 1]), beyond(2048, 2048));
    assert_eq!(tables.write_nodes(65, &[Node::default()]), beyond(65, 65));
    assert_eq!(tables.write_factors(usize::MAX, &[1]), beyond(usize::MAX - 1, 2048));
    assert_eq!(tables.entry(Bank::Active, 2048, Port::ReadBack), None);
}

#[test]
fn a_factor_of_zero_or_above_one_is_refused_and_nothing_is_written() {
    let mut tables = tables();
    for factor in [0, UNSTRETCHED + 1] {
        let refused = tables.write_factors(10, &[77, factor]);
        assert_eq!(refused, Err(TableError::Factor { row: 11, factor }));
        assert_eq!(tables.entry(Bank::Shadow, 10, Port::ReadBack), Some(UNSTRETCHED));
    }
}

#[test]
fn a_five_tap_build_refuses_keys_and_takes_hermite() {
    let mut tables = Tables::new(&Options { taps: TapCount::Five, ..Options::default() }, None);
    assert_eq!(tables.write_nodes(0, &keys().nodes), Err(TableError::OuterTaps { node: 1 }));
    assert_eq!(tables.write_nodes(0, &hermite().nodes), Ok(()));
}
