//! The same scenarios on every kind of board. `HALFROW_TEST_BOARDS` names boards other than the mock.

// clippy.toml allows it inside #[test] functions, but not in the functions that several tests call.
#![allow(clippy::unwrap_used)]

use halfrow::board::deadlines::Step;
use halfrow_pipe::{FaultInfo, Parameter, Range};
use halfrow_tests::program::halfrow;
use halfrow_tests::scenario::{Scenario, run_all_on_boards};
use halfrow_tests::scenarios::{
    self, BROKEN_BOARDS, BROKEN_GRIDS, HOPELESS_LINKS, MISFITS, REPAIRED_LINKS, SLOW_LINKS, SOUND_BOARDS,
};
use serde_json::Value;

/// The number of samples that were compared, and of those that differed.
fn samples(report: &Value) -> (u64, u64) {
    let frames = report["frames"].as_array().unwrap();
    let sum = |what| frames.iter().filter_map(|frame| frame["comparison"][what].as_u64()).sum();
    (sum("samples"), sum("differences"))
}

#[test]
fn sound_boards_pass_with_every_sample_compared() {
    for report in run_all_on_boards(SOUND_BOARDS) {
        let (width, height) = (report["tables"]["width"].as_u64(), report["tables"]["height"].as_u64());
        let frames = report["frames"].as_array().unwrap().len() as u64;
        assert_eq!(samples(&report), (width.unwrap() * height.unwrap() * frames, 0));
        assert_eq!(report["link"]["retries"], 0, "{}", report["board"]["target"]);
    }
}

#[test]
fn broken_boards_fail_and_the_broken_part_is_named() {
    for report in run_all_on_boards(&BROKEN_BOARDS) {
        assert!(report["remedy"].is_string() || report["exit_code"] == 6, "{}", report["board"]["target"]);
    }
}

#[test]
fn broken_boards_fail_and_the_broken_part_is_named_behind_a_grid_as_well() {
    for report in run_all_on_boards(&BROKEN_GRIDS) {
        assert!(report["remedy"].is_string() || report["exit_code"] == 6, "{}", report["board"]["target"]);
    }
}

#[test]
fn what_a_link_spoils_is_asked_for_again() {
    for report in run_all_on_boards(REPAIRED_LINKS) {
        assert_ne!(report["link"]["retries"], 0, "{}", report["board"]["target"]);
    }
}

#[test]
fn a_link_that_is_slow_or_out_of_order_costs_no_verdict() {
    run_all_on_boards(SLOW_LINKS);
}

#[test]
fn a_link_that_is_too_poor_is_no_fault_of_the_board() {
    run_all_on_boards(HOPELESS_LINKS);
}

#[test]
fn what_does_not_fit_the_board_is_refused_without_a_verdict() {
    run_all_on_boards(MISFITS);
}

/// Whoever makes a board relies on the page.
#[test]
fn the_host_waits_as_long_as_the_page_of_the_wire_says() {
    let page = include_str!("../../protocol/WIRE.md");
    let milliseconds =
        |cell: &str| cell.trim().strip_suffix(" ms").and_then(|number| number.parse::<u64>().ok());
    let times: Vec<_> = page
        .lines()
        .filter_map(|line| {
            let cells: Vec<_> = line.trim_matches('|').split('|').collect();
            let [_, board, host, tries] = cells[..] else { return None };
            Some((milliseconds(board)?, milliseconds(host)?, tries.trim().parse::<u32>().ok()?))
        })
        .collect();
    let waited = |step: Step| (step.deadline().fixed.as_millis() as u64, step.deadline().attempts);
    let host: Vec<_> = times.iter().map(|&(_, host, tries)| (host, tries)).collect();
    assert_eq!(host, [Step::Hello, Step::Request, Step::Row].map(waited));
    assert!(times.iter().all(|(board, host, _)| 2 * board < *host), "there is time left for the link");
}

#[test]
fn every_fault_that_the_program_lists_has_a_scenario() {
    let listed = halfrow(["faults", "--json"]).json();
    let listed: Vec<_> =
        listed["faults"].as_array().unwrap().iter().filter_map(|fault| fault["name"].as_str()).collect();
    let names: Vec<_> = halfrow_mock::catalogue().map(|fault| fault.name).collect();
    assert_eq!(listed, names);
    let missing = without_scenario(scenarios::all, names.iter().map(|name| format!("fault={name}")));
    assert!(missing.is_empty(), "no scenario for {missing:?}");
    for (which, scenarios) in [("without a grid", &BROKEN_BOARDS), ("behind a grid", &BROKEN_GRIDS)] {
        let kinds = halfrow_mock::FAULTS.iter().flat_map(|fault| kinds(&fault.info));
        let missing = without_scenario(|| scenarios.iter(), kinds);
        assert!(missing.is_empty(), "no scenario {which} for {missing:?}");
    }
}

/// The options that ask for a fault: more than one where it stands for several, which `instead` tells apart.
fn kinds(fault: &FaultInfo) -> Vec<String> {
    let name = format!("fault={}", fault.name);
    let instead = fault.parameters.iter().find(|parameter| parameter.key == "instead");
    let Some(Parameter { range: Range::Words(words), .. }) = instead else { return vec![name] };
    words.iter().map(|word| format!("{name},instead={word}")).collect()
}

/// Those of `asked` that none of the scenarios gives to its board.
fn without_scenario<S: Iterator<Item = &'static Scenario>>(
    scenarios: impl Fn() -> S,
    asked: impl Iterator<Item = String>,
) -> Vec<String> {
    let is_given =
        |asked: &str, scenario: &Scenario| format!("{},", scenario.options).contains(&format!(",{asked},"));
    asked.filter(|asked| !scenarios().any(|scenario| is_given(asked, scenario))).collect()
}
