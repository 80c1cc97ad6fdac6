//! The mock's scenarios, by way of a serial port.

use halfrow_tests::scenario::{Scenario, run_all_on_serial_ports};
use halfrow_tests::scenarios::{BROKEN_BOARDS, HOPELESS_LINKS, REPAIRED_LINKS, SLOW_LINKS, SOUND_BOARDS};

/// All but those at full size, which would move the same bytes for much longer.
fn small(scenarios: &'static [Scenario]) -> Vec<&'static Scenario> {
    scenarios.iter().filter(|scenario| scenario.arguments.contains(&"--width")).collect()
}

#[test]
fn sound_boards_pass() {
    for report in run_all_on_serial_ports(&small(SOUND_BOARDS)) {
        assert_eq!(report["board"]["kind"], "mock");
    }
}

#[test]
fn broken_boards_fail() {
    let _ = run_all_on_serial_ports(&small(BROKEN_BOARDS));
}

#[test]
fn what_a_link_spoils_is_asked_for_again() {
    for report in run_all_on_serial_ports(&small(REPAIRED_LINKS)) {
        assert_ne!(report["link"]["retries"], 0);
    }
}

#[test]
fn links_that_are_slow_pass_and_hopeless_ones_end_with_an_error() {
    let _ = run_all_on_serial_ports(&small(SLOW_LINKS));
    let _ = run_all_on_serial_ports(&small(HOPELESS_LINKS));
}
