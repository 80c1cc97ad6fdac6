//! What a lane owes its shift after its station's clock was wrong.

use std::fs;

use halfrow_station::plan::Plan;
use halfrow_station::store::InLane;

use super::floor::{SERIALS, plan};
use crate::history::made::{DAY_MS, End, HOUR_MS, Made, PRODUCT, Run, id};

/// 1 January 2000, midnight UTC, at which a clock with an empty battery begins.
const EMPTY_BATTERY_MS: i64 = 946_684_800_000;
/// When the first of them begins, by a clock that is right.
const NOON_MS: i64 = crate::history::made::BEGIN_MS + 12 * HOUR_MS;
const BAD: End = End::Fail(&["row-buffer"]);

/// Judges these serial numbers in this order, each at the hour that the clock shows, counted from noon; returns why the lane is out
/// at the hour `now`.
fn owed(judged: &[(&str, End, i64)], now: i64) -> Option<String> {
    let mut made = Made::new();
    for ((serial, end, started_ms), nth) in judged.iter().zip(1..) {
        // The ids of a station are in order, whatever its clock says.
        let run = Run { started_ms: *started_ms, ..Run::of(serial, *end) };
        made.count_from(nth);
        made.run_as(id(NOON_MS, nth), &run);
    }
    let sha256 = crate::common::query(made.as_ref(), "SELECT sha256 FROM plan").remove(0);
    let path = made.as_ref().join("plan.toml");
    let shift = "[shift]\ngood = \"CA0131103628\"\nbad = \"CA0201134373\"\nhours = 8\n[tables]";
    fs::write(&path, plan().replace("[tables]", shift)).unwrap();
    let plan = Plan::load(&path).unwrap();
    let place = InLane { plan_sha256: &sha256, product: PRODUCT, ..InLane::of("station 7", "1", &plan) };
    let checked = made.folder().owed(&place, now).unwrap();
    checked.owed.map(|owed| owed.why.to_string())
}

const fn hour(number: i64) -> i64 {
    NOON_MS + number * HOUR_MS
}

/// A battery is empty, the computer's clock is set to local time, somebody types the wrong year.
#[test]
fn a_check_that_failed_while_the_clock_was_wrong_keeps_the_lane_out() {
    let [good, bad, ..] = SERIALS;
    let checked = [(good, End::Pass, hour(0)), (bad, BAD, hour(1))];
    assert_eq!(owed(&checked, hour(2)), None, "the control");
    for dated in [EMPTY_BATTERY_MS, hour(-10), hour(1), hour(30), hour(10 * 8766)] {
        let why = owed(&[&checked[..], &[(good, BAD, dated)]].concat(), hour(2)).unwrap();
        assert!(why.contains("the good unit CA0131103628 was judged FAIL"), "{dated}: {why}");
        let why = owed(&[&checked[..], &[(bad, End::Pass, dated)]].concat(), hour(2)).unwrap();
        assert!(why.contains("the bad unit CA0201134373 was judged PASS"), "{dated}: {why}");
        let repaired =
            [&checked[..], &[(good, BAD, dated), (good, End::Pass, hour(2)), (bad, BAD, hour(3))]].concat();
        assert_eq!(owed(&repaired, hour(4)), None, "{dated}");
    }
}

/// Nobody knows when it was made.
#[test]
fn a_check_that_a_wrong_clock_dated_outside_the_shift_checks_nothing() {
    let [good, bad, ..] = SERIALS;
    for dated in [EMPTY_BATTERY_MS, hour(2) - DAY_MS, hour(2) + DAY_MS] {
        let judged = [(good, End::Pass, hour(0)), (bad, BAD, hour(1)), (good, End::Pass, dated)];
        let why = owed(&judged, hour(2)).unwrap();
        assert!(why.contains("the good unit CA0131103628 must be judged PASS first"), "{dated}: {why}");
    }
}
