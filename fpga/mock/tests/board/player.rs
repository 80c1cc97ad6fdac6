//! Playing rows: banks, latency, gaps, settings.

use halfrow_mock::{
    BoardFault, Depth, Options, PlayError, Player, RowIn, RowName, Settings, SettingsError, Tables,
    UNSTRETCHED,
};

use crate::support::{GOLDEN_FACTOR, fault, hermite, noise_row, play_frame, small_board, small_settings};
use halfrow_conformance::golden_rows::HERMITE;

fn row(number: u16, last: bool) -> RowIn {
    RowIn { sequence: number.into(), frame: 0, row: number, last, samples: noise_row(number.into(), 64) }
}

fn board(fault: Option<BoardFault>) -> (Player, Tables) {
    small_board(fault, &[UNSTRETCHED; 8], &hermite())
}

fn complete(player: &Player) -> Vec<u16> {
    player.banks.complete().map(|row| row.name.row).collect()
}

#[test]
fn a_row_is_complete_when_half_of_the_next_has_entered_or_the_core_was_flushed() {
    let (mut player, mut tables) = board(None);
    player.play(&row(0, false), &mut tables).unwrap();
    assert_eq!(complete(&player), []);
    player.play(&row(1, false), &mut tables).unwrap();
    assert_eq!(complete(&player), [0]);
    player.play(&row(2, true), &mut tables).unwrap();
    player.flush();
    assert_eq!(complete(&player), [0, 1, 2]);
}

#[test]
fn only_the_last_row_of_a_frame_is_flushed() {
    let (mut player, mut tables) = board(None);
    player.play(&row(0, false), &mut tables).unwrap();
    player.flush();
    assert_eq!(complete(&player), []);
}

#[test]
fn the_next_frame_may_enter_while_the_last_row_leaves() {
    let (mut player, mut tables) = small_board(None, &[GOLDEN_FACTOR], &hermite());
    let frame = |frame| RowIn { frame, ..row(0, true) };
    player.play(&frame(0), &mut tables).unwrap();
    tables.write_factors(0, &[UNSTRETCHED]).unwrap();
    tables.write_nodes(0, &hermite().nodes).unwrap();
    tables.commit(2, 1).unwrap();
    player.play(&frame(1), &mut tables).unwrap();
    player.flush();
    let rows: Vec<_> = player.banks.complete().collect();
    assert_eq!((&rows[0].samples[..], rows[0].name.generation), (&HERMITE[..], 1));
    assert_eq!((&rows[1].samples, rows[1].name.generation), (&noise_row(0, 64), 2));
}

#[test]
fn every_row_takes_w_over_2_plus_l_from_first_to_first_and_from_last_to_last() {
    let (mut player, mut tables) = board(None);
    for (blanking, gap_seed) in [(0, 0), (1, 0), (0, 99), (300, 12345)] {
        player.configure(small_settings(8, blanking, gap_seed)).unwrap();
        let rows = play_frame(&mut player, &mut tables, 0);
        assert!(rows.iter().all(|row| (row.first_latency, row.last_latency) == (44, 44)));
        assert_eq!(rows.len(), 8);
    }
}

#[test]
fn a_late_board_measures_its_real_latency_and_loses_no_sample() {
    let (mut player, mut tables) = board(Some(fault("late", &[])));
    let rows = play_frame(&mut player, &mut tables, 0);
    assert_eq!(rows.len(), 8);
    assert!(rows.iter().all(|row| (row.first_latency, row.last_latency) == (45, 45)));
}

#[test]
fn a_row_keeps_its_name_and_its_samples() {
    let (mut player, mut tables) = board(None);
    let played = RowIn { sequence: 70_000, frame: 9, row: 0, last: true, samples: noise_row(5, 64) };
    tables.start_frame(0);
    player.play(&played, &mut tables).unwrap();
    player.flush();
    let out = player.banks.fetch().unwrap();
    assert_eq!(out.name, RowName { sequence: 70_000, frame: 9, row: 0, generation: 1 });
    assert_eq!(out.samples, noise_row(5, 64));
}

#[test]
fn two_out_banks_are_enough_and_a_third_row_waits_for_one() {
    let options = Options { row_banks_out: 2, ..Options::default() };
    let mut player = Player::new(&options, None).unwrap();
    let mut tables = Tables::new(&options, None);
    player.configure(small_settings(8, 0, 0)).unwrap();
    player.play(&row(0, false), &mut tables).unwrap();
    player.play(&row(1, false), &mut tables).unwrap();
    assert_eq!(player.play(&row(2, false), &mut tables), Err(PlayError::NoBank));
    assert_eq!(player.banks.fetch().unwrap().name.row, 0);
    assert_eq!(player.play(&row(2, false), &mut tables), Ok(()));
}

#[test]
fn a_lost_row_never_comes_out_and_keeps_no_bank() {
    let (mut player, mut tables) = board(Some(fault("lost-row", &[])));
    for frame in 0..4 {
        let rows: Vec<_> =
            play_frame(&mut player, &mut tables, frame).iter().map(|row| row.name.row).collect();
        assert_eq!(rows, [0, 1, 2, 4, 5, 6, 7]);
    }
}

/// What a board with a fault makes of the golden row with this centre set, by the golden factor.
fn about(centre2: u16, fault: Option<BoardFault>) -> Vec<u16> {
    let (mut player, mut tables) = small_board(fault, &[GOLDEN_FACTOR], &hermite());
    player.configure(Settings { centre2, ..small_settings(1, 0, 0) }).unwrap();
    play_frame(&mut player, &mut tables, 0).remove(0).samples
}

/// The golden row is that of C = 63.
#[test]
fn an_ignored_centre_is_the_middle_of_the_row() {
    assert_ne!(about(20, None), HERMITE);
    assert_eq!(about(20, Some(fault("centre-ignored", &[]))), HERMITE);
}

/// 63 is 11 1111, and 55 is 11 0111.
#[test]
fn a_stuck_bit_of_the_centre_moves_it() {
    assert_ne!(about(55, None), HERMITE);
    assert_eq!(about(55, Some(fault("stuck-centre", &[("bit", "3"), ("value", "1")]))), HERMITE);
    assert_eq!(about(63, Some(fault("stuck-centre", &[("bit", "3"), ("value", "0")]))), about(55, None));
}

/// The numbers are those of xorshift32 with the seed 1, counted in Python.
#[test]
fn pauses_follow_the_seed_and_start_anew_with_every_frame() {
    let (mut player, mut tables) = board(None);
    player.configure(small_settings(4, 0, 1)).unwrap();
    for frame in 0..2 {
        let pauses: Vec<_> =
            play_frame(&mut player, &mut tables, frame).iter().map(|row| row.pauses).collect();
        assert_eq!(pauses, [6, 15, 9, 10]);
    }
}

#[test]
fn without_a_seed_nothing_pauses() {
    let (mut player, mut tables) = board(None);
    assert!(play_frame(&mut player, &mut tables, 0).iter().all(|row| row.pauses == 0));
}

#[test]
fn rows_that_do_not_fit_the_settings_are_refused() {
    let (mut player, mut tables) = board(None);
    let short = RowIn { samples: vec![0; 62], ..row(0, false) };
    assert_eq!(player.play(&short, &mut tables), Err(PlayError::Width { samples: 62, width: 64 }));
    assert_eq!(player.play(&row(8, false), &mut tables), Err(PlayError::Row { row: 8, height: 8 }));
}

#[test]
fn settings_change_only_while_the_core_is_empty() {
    let (mut player, mut tables) = board(None);
    let narrower = small_settings(4, 0, 0);
    player.play(&row(0, false), &mut tables).unwrap();
    assert_eq!(player.configure(narrower.clone()), Err(SettingsError::Busy));
    player.play(&row(1, true), &mut tables).unwrap();
    assert_eq!(player.configure(narrower.clone()), Err(SettingsError::Busy));
    player.flush();
    assert_eq!(player.configure(narrower), Ok(()));
}

#[test]
fn settings_that_the_build_cannot_run_with_are_refused() {
    let options =
        Options { least_blanking: 7, max_height: 1080, depths: vec![Depth::Twelve], ..Options::default() };
    let fine = small_settings(8, 7, 0);
    let refusal = |settings: Settings| settings.check(&options).unwrap_err();
    assert_eq!(fine.check(&options), Ok(()));
    assert_eq!(
        refusal(Settings { width: 65, ..fine.clone() }),
        SettingsError::Width { width: 65, most: 2048 }
    );
    assert_eq!(
        refusal(Settings { width: 62, ..fine.clone() }),
        SettingsError::Width { width: 62, most: 2048 }
    );
    assert_eq!(
        refusal(Settings { width: 2050, ..fine.clone() }),
        SettingsError::Width { width: 2050, most: 2048 }
    );
    assert_eq!(
        refusal(Settings { height: 0, ..fine.clone() }),
        SettingsError::Height { height: 0, most: 1080 }
    );
    assert_eq!(
        refusal(Settings { height: 1081, ..fine.clone() }),
        SettingsError::Height { height: 1081, most: 1080 }
    );
    assert_eq!(
        refusal(Settings { centre2: 127, ..fine.clone() }),
        SettingsError::Centre { centre2: 127, most: 126 }
    );
    assert_eq!(refusal(Settings { depth: Depth::Ten, ..fine.clone() }), SettingsError::Depth { bits: 10 });
    assert_eq!(refusal(Settings { blanking: 6, ..fine }), SettingsError::Blanking { blanking: 6, least: 7 });
}

#[test]
fn outputs_are_clamped_to_the_depth() {
    let (mut player, mut tables) = board(None);
    player.configure(Settings { depth: Depth::Ten, ..small_settings(8, 0, 0) }).unwrap();
    player.play(&RowIn { samples: vec![4095; 64], ..row(0, true) }, &mut tables).unwrap();
    player.flush();
    assert_eq!(player.banks.fetch().unwrap().samples, [1023; 64]);
}
