//! A unit's page.

use halfrow_station::history::unit::units;
use halfrow_station::record::RunCause;

use super::made::{BEGIN_MS, End, Made, Run};
use super::served::Served;
use crate::common::reason;

#[test]
fn a_unit_has_its_runs_and_nobody_elses_with_all_that_belongs_to_them() {
    let mut made = Made::new();
    let ends = [End::Error(RunCause::Link), End::Fail(&["memory", "row factor"]), End::Pass];
    let mut ids = Vec::new();
    for (end, hour) in ends.into_iter().zip(0..) {
        made.run(&Run::of("S2", End::Fail(&["clock"])).at_hour(hour));
        ids.push(made.run(&Run::of("S1", end).at_hour(hour)));
    }
    made.store.waive(&ids[1], "engel", &reason("used as it is")).unwrap();
    let units = units(&made.now(), "S1").unwrap();
    let [unit] = &units[..] else { panic!("{units:?}") };
    assert_eq!((unit.serial.as_str(), unit.first_seen_ms), ("S1", BEGIN_MS));
    let runs: Vec<_> = unit.runs.iter().map(|run| (run.line.id.as_str(), run.line.nth)).collect();
    assert_eq!(runs, [(ids[2].as_str(), 2), (ids[1].as_str(), 1), (ids[0].as_str(), 1)]);
    let failed = &unit.runs[1];
    let parts: Vec<_> = failed.suspects.iter().map(|suspect| suspect.part.as_str()).collect();
    assert_eq!(parts, ["memory", "row factor"]);
    let steps: Vec<_> = failed.steps.iter().map(|step| (step.name.as_str(), step.outcome.as_str())).collect();
    assert_eq!(steps, [("identity", "passed"), ("verify", "failed")]);
    assert_eq!((failed.line.waived, failed.waivers[0].reason.as_str()), (true, "used as it is"));
    assert_eq!(failed.device.as_deref(), Some("0123456789abcdef"));
    assert!(unit.runs[0].waivers.is_empty() && unit.runs[0].suspects.is_empty());
}

#[test]
fn a_serial_number_that_was_never_tested_is_no_unit() {
    let mut made = Made::new();
    made.run(&Run::of("S1", End::Pass));
    assert_eq!(units(&made.now(), "S").unwrap(), Vec::new());
}

/// The mock that checks a shift is to FAIL, and its runs count nowhere.
#[test]
fn runs_that_do_not_count_are_no_judgements_of_a_unit() {
    let mut made = Made::new();
    let mut ids = Vec::new();
    for serial in ["HR:MOCK:1", "S1"] {
        for (end, hour) in [End::Fail(&["memory"]), End::Pass].into_iter().zip(0..) {
            ids.push(made.run(&Run::of(serial, end).at_hour(hour)));
        }
    }
    let served = Served::of(made);
    let told = |path: &str| {
        let page = served.page(path);
        [
            "First FAIL, in the end PASS",
            " · judgement ",
            "Number of this judgement",
            " · does not count",
            "Counts in yields",
        ]
        .map(|words| page.contains(words))
    };
    assert_eq!(told("/unit?serial=HR%3AMOCK%3A1"), [false, false, false, true, false]);
    assert_eq!(told(&format!("/runs/{}", ids[0])), [false, false, false, false, true]);
    // The lanes' page shows local times.
    assert!(served.page("/unit?serial=S1").contains(">2026-11-01 00:00:00</time> UTC"));
    assert_eq!(served.get("/unit?serial=").status, 404);
    assert!(!served.get("/unit?serial=").text().contains("serial number ."));
    assert!(served.page("/history?serial=S2&serial=S1").contains("/unit?serial=S1"));
    // The control.
    assert_eq!(told("/unit?serial=S1"), [true, true, false, false, false]);
    assert_eq!(told(&format!("/runs/{}", ids[2])), [false, false, true, false, false]);
}
