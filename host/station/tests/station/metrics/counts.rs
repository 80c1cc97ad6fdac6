//! Runs by verdict, as they are reported to whoever asks every few seconds.

use halfrow_station::history::counts::Tally;
use halfrow_station::record::RunCause;

use crate::common::query;
use crate::history::made::{BEGIN_MS, DAY_MS, End, HOUR_MS, Made, Run};

fn run(serial: &str, lane: &str, end: End, started_ms: i64) -> Run {
    Run { lane: lane.to_owned(), started_ms, ..Run::of(serial, end) }
}

/// What is counted: a line for each plan, lane and verdict with runs.
fn counted(tally: &Tally, made: &Made) -> Vec<String> {
    let counts = tally.counts(&made.now()).unwrap();
    let lines = counts.iter().flat_map(|(cell, count)| {
        let by_verdict = [("ERROR", count.errors), ("FAIL", count.failed), ("PASS", count.passed)];
        let has_runs = by_verdict.into_iter().filter(|(_, runs)| *runs > 0);
        has_runs.map(|(verdict, runs)| format!("{} {} {verdict} {runs}", cell.plan.plan, cell.lane))
    });
    lines.collect()
}

/// The same, counted from the runs themselves.
fn from_the_runs(made: &Made) -> Vec<String> {
    let text = "SELECT plan.name || ' ' || lane || ' ' || verdict || ' ' || count(*) FROM run
        JOIN plan ON plan.sha256 = plan_sha256 JOIN unit ON unit.id = unit_id
        WHERE state = 'final' AND serial NOT LIKE 'HR:MOCK:%' GROUP BY plan.name, lane, verdict ORDER BY 1";
    query(made.as_ref(), text)
}

#[test]
fn runs_are_counted_by_verdict_whatever_day_they_come_from() {
    let (mut made, tally) = (Made::new(), Tally::new(true, 0));
    assert_eq!(counted(&tally, &made), from_the_runs(&made));
    let runs = [
        run("S1", "1", End::Fail(&["memory", "clock"]), BEGIN_MS),
        run("S1", "2", End::TooLateAndWrong, BEGIN_MS + HOUR_MS),
        run("S1", "1", End::Pass, BEGIN_MS + 3 * DAY_MS),
        run("S2", "1", End::Error(RunCause::Link), BEGIN_MS + 3 * DAY_MS + 1),
        Run { plan: ("final", "2"), ..run("S3", "1", End::TooLate, BEGIN_MS + 3 * DAY_MS + 2) },
        Run { plan: ("intake", "1"), ..run("S3", "1", End::Pass, BEGIN_MS + 40 * DAY_MS) },
        run("S4", "3", End::Open, BEGIN_MS + 40 * DAY_MS),
        // The mock that checks a shift is no unit.
        run("HR:MOCK:1", "1", End::Fail(&[]), BEGIN_MS + 40 * DAY_MS + 1),
        // It comes late, for a day that was already counted.
        run("S5", "2", End::Fail(&[]), BEGIN_MS + 2 * HOUR_MS),
    ];
    for of in &runs {
        made.run(of);
        assert_eq!(counted(&tally, &made), from_the_runs(&made), "{of:?}");
    }
    assert_eq!(
        counted(&Tally::new(true, 0), &made),
        ["final 1 ERROR 1", "final 1 FAIL 2", "final 1 PASS 1", "final 2 FAIL 2", "intake 1 PASS 1"]
    );
    let all = Tally::new(false, 0).counts(&made.now()).unwrap();
    let (cell, count) = all.first_key_value().unwrap();
    assert_eq!((cell.plan.plan.as_str(), cell.lane.as_str()), ("final", ""));
    assert_eq!((count.errors, count.failed, count.passed), (1, 4, 1));
    // S1, S3 and S5 were judged under `final`, and none of them passed the first time.
    assert_eq!((count.units, count.first_passed), (3, 0));
}

/// All runs are read once, which may be a million; after that only those of days on which something ended.
#[test]
fn a_day_without_another_run_is_not_looked_at_again() {
    let (mut made, tally) = (Made::new(), Tally::new(true, 0));
    made.run(&run("S1", "1", End::Fail(&[]), BEGIN_MS));
    made.run(&run("S2", "1", End::Fail(&[]), BEGIN_MS + DAY_MS));
    assert_eq!(counted(&tally, &made), ["final 1 FAIL 2"]);
    // The program never does this: a new count of these days finds no FAIL.
    made.change("UPDATE run SET nth = 0");
    assert_eq!(counted(&Tally::new(true, 0), &made), ["final 1 PASS 2"]);
    assert_eq!(counted(&tally, &made), ["final 1 FAIL 2"]);
    made.run(&run("S3", "1", End::Fail(&[]), BEGIN_MS + DAY_MS + HOUR_MS));
    assert_eq!(
        counted(&tally, &made),
        ["final 1 FAIL 2", "final 1 PASS 1"],
        "the second day alone is counted anew"
    );
}

/// A plant whose counting takes long is not counted all the time.
#[test]
fn what_was_counted_is_told_again_for_as_long_as_is_wanted() {
    let mut made = Made::new();
    let tallies = [0, u32::MAX].map(|rests| Tally::new(true, rests));
    made.run(&run("S1", "1", End::Pass, BEGIN_MS));
    assert_eq!(tallies.each_ref().map(|tally| counted(tally, &made)), [["final 1 PASS 1"]; 2]);
    made.run(&run("S2", "1", End::Pass, BEGIN_MS + HOUR_MS));
    let after = tallies.each_ref().map(|tally| counted(tally, &made));
    assert_eq!(after, [["final 1 PASS 2"], ["final 1 PASS 1"]]);
}
