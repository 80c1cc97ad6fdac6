//! Units that have already passed, in lanes.

use std::fs;
use std::thread;
use std::time::{Duration, Instant};

use super::floor::{SERIALS, Station, plan};

/// What comes sooner after the question is no answer to it.
const READ: Duration = Duration::from_secs(1);

fn station(again: &str) -> Station {
    let station = Station::with(&["mock"], "");
    let plan = plan().replace("device = ", &format!("again = \"{again}\"\ndevice = "));
    fs::write(station.path("plan.toml"), plan).unwrap();
    station
}

#[test]
fn a_unit_that_passed_is_scanned_once_more_if_it_is_meant() {
    let station = station("ask");
    let mut running = station.start();
    let serial = SERIALS[0];
    for _ in 0..2 {
        running.scan(serial);
        running.answer(serial);
        running.state("1", "PASS");
        running.scan(serial);
        let (is_taken, said) = running.answer(serial);
        assert!(!is_taken && said.contains("passed already under this plan"), "{said}");
        assert!(said.ends_with("scan it once more to test it again"), "{said}");
        let ready = running.state("1", "READY");
        assert_eq!(ready["note"].as_str(), Some(said.as_str()));
        thread::sleep(READ);
    }
    // Another unit comes in between, so that the second scan is a first one again.
    running.scan(SERIALS[1]);
    running.state("1", "PASS");
    running.scan(serial);
    assert!(!running.answer(serial).0);
    assert_eq!(running.end().0, Some(0));
    assert_eq!(station.query("SELECT count(*) FROM run"), ["3"]);
    station.assert_well();
}

#[test]
fn a_plan_may_refuse_units_that_passed() {
    let station = station("refuse");
    let mut running = station.start();
    running.scan(SERIALS[0]);
    running.state("1", "PASS");
    for _ in 0..2 {
        running.scan(SERIALS[0]);
        let (is_taken, said) = running.answer(SERIALS[0]);
        assert!(!is_taken && said.ends_with("put it with the boards that passed"), "{said}");
    }
    assert_eq!(running.end().0, Some(0));
    assert_eq!(station.query("SELECT count(*) FROM run"), ["1"]);
}

#[test]
fn what_was_asked_of_one_unit_is_said_for_no_other() {
    let station = station("ask");
    let mut running = station.start();
    for serial in [SERIALS[0], SERIALS[1]] {
        running.scan(serial);
        running.state("1", "PASS");
    }
    for serial in [SERIALS[0], SERIALS[1], SERIALS[0]] {
        running.scan(serial);
        let (is_taken, said) = running.answer(serial);
        assert!(!is_taken && said.contains("passed already under this plan"), "{serial}: {said}");
    }
    assert_eq!(running.end().0, Some(0));
    assert_eq!(station.query("SELECT count(*) FROM run"), ["2"]);
}

/// A hand scanner may read a label twice.
#[test]
fn a_label_that_is_read_twice_at_once_asks_and_does_not_answer() {
    let station = station("ask");
    let mut running = station.start();
    let serial = SERIALS[0];
    running.scan(serial);
    running.answer(serial);
    running.state("1", "PASS");
    let begun = Instant::now();
    (0..3).for_each(|_| running.scan(serial));
    let taken = [(); 3].map(|()| running.answer(serial).0);
    // A machine may be so slow that the last ones come late enough.
    assert!(begun.elapsed() >= READ || taken == [false; 3], "{taken:?}");
    assert_eq!(running.end().0, Some(0));
}
