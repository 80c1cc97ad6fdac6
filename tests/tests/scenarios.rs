//! The same scenarios on every kind of board. Other boards than the mock are named by `HALFROW_TEST_BOARDS`.

// clippy.toml allows it inside #[test] functions, but not in the functions that several tests call.
#![allow(clippy::unwrap_used)]

use halfrow_tests::program::halfrow;
use halfrow_tests::scenario::{Scenario, boards, run_all};
use halfrow_tests::scenarios::{
    self, BROKEN_BOARDS, HOPELESS_LINKS, MISFITS, REPAIRED_LINKS, SLOW_LINKS, SOUND_BOARDS,
};
use serde_json::Value;

/// The reports of `scenarios` on all boards.
fn on_all_boards(scenarios: &[Scenario]) -> Vec<Value> {
    boards().iter().flat_map(|board| run_all(scenarios, board)).collect()
}

/// Samples that were compared, and those that differed.
fn samples(report: &Value) -> (u64, u64) {
    let frames = report["frames"].as_array().unwrap();
    let sum = |what| frames.iter().filter_map(|frame| frame["comparison"][what].as_u64()).sum();
    (sum("samples"), sum("differences"))
}

#[test]
fn sound_boards_pass_with_every_sample_compared() {
    for report in on_all_boards(SOUND_BOARDS) {
        let (width, height) = (report["tables"]["width"].as_u64(), report["tables"]["height"].as_u64());
        let frames = report["frames"].as_array().unwrap().len() as u64;
        assert_eq!(samples(&report), (width.unwrap() * height.unwrap() * frames, 0));
        assert_eq!(report["link"]["retries"], 0, "{}", report["board"]["target"]);
    }
}

#[test]
fn broken_boards_fail_and_the_broken_part_is_named() {
    for report in on_all_boards(BROKEN_BOARDS) {
        assert!(report["remedy"].is_string() || report["exit_code"] == 6, "{}", report["board"]["target"]);
    }
}

#[test]
fn what_a_link_spoils_is_asked_for_again() {
    for report in on_all_boards(REPAIRED_LINKS) {
        assert_ne!(report["link"]["retries"], 0, "{}", report["board"]["target"]);
    }
}

#[test]
fn a_link_that_is_slow_or_out_of_order_costs_no_verdict() {
    on_all_boards(SLOW_LINKS);
}

#[test]
fn a_link_that_is_too_poor_is_no_fault_of_the_board() {
    on_all_boards(HOPELESS_LINKS);
}

#[test]
fn what_does_not_fit_the_board_is_refused_without_a_verdict() {
    on_all_boards(MISFITS);
}

#[test]
fn every_fault_that_the_program_lists_has_a_scenario() {
    let listed = halfrow(["faults", "--json"]).json();
    let names: Vec<_> =
        listed["faults"].as_array().unwrap().iter().filter_map(|fault| fault["name"].as_str()).collect();
    assert_eq!(names.len(), 21, "{names:?}");
    let has_scenario = |name: &&&str| {
        let fault = format!("fault={name}");
        scenarios::all().any(|scenario| scenario.options.split(',').any(|option| option == fault))
    };
    let missing: Vec<_> = names.iter().filter(|name| !has_scenario(name)).collect();
    assert!(missing.is_empty(), "no scenario for {missing:?}");
}
