//! The mock's scenarios, over a serial port.

use halfrow_tests::scenario::{Scenario, run_all_on_serial_ports, run_each};
use halfrow_tests::scenarios::{
    BROKEN_BOARDS, HOPELESS_LINKS, MISFITS, REPAIRED_LINKS, SLOW_LINKS, SOUND_BOARDS,
};
use halfrow_tests::served::Served;

/// All but those at full size, which would move the same kinds of packets for much longer.
fn small(scenarios: &'static [Scenario]) -> Vec<&'static Scenario> {
    scenarios.iter().filter(|scenario| scenario.has_own_size()).collect()
}

#[test]
fn sound_boards_pass() {
    for report in run_all_on_serial_ports(&small(SOUND_BOARDS)) {
        assert_eq!(report["board"]["kind"], "mock");
    }
}

/// A sixth of those that fail on the mock itself.
#[test]
fn broken_boards_fail() {
    let some: Vec<_> = small(&BROKEN_BOARDS).into_iter().step_by(6).collect();
    let _ = run_all_on_serial_ports(&some);
}

#[test]
#[ignore = "half a minute long; scripts/soak runs it"]
fn all_broken_boards_fail() {
    let _ = run_all_on_serial_ports(&small(&BROKEN_BOARDS));
}

#[test]
fn what_a_link_spoils_is_asked_for_again() {
    let reports = run_all_on_serial_ports(&small(REPAIRED_LINKS));
    // What is hit depends on timing: an acknowledgement that another one follows is not asked for again.
    let mended = reports.iter().filter(|report| report["link"]["retries"] != 0).count();
    assert!(2 * mended > reports.len(), "{mended} of {}", reports.len());
}

#[test]
fn links_that_are_slow_pass() {
    let _ = run_all_on_serial_ports(&small(SLOW_LINKS));
}

#[test]
fn hopeless_links_end_with_an_error() {
    let _ = run_all_on_serial_ports(&small(HOPELESS_LINKS));
}

/// Like boards that `HALFROW_TEST_BOARDS` names: one device, and one scenario after another. On devices of their own each of them
/// passes above.
#[test]
fn a_board_behind_a_device_takes_one_scenario_after_another() {
    for served in [Served::on_a_serial_port("mock"), Served::on_a_tcp_port("127.0.0.1", "mock")] {
        let some = small(SOUND_BOARDS).into_iter().step_by(6);
        let scenarios: Vec<_> = some.chain(small(MISFITS)).collect();
        assert!(run_each(&scenarios, &served.target()).len() > 1);
    }
}
