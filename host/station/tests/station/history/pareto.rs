//! The most frequent failures, compared with counts made by hand.

use halfrow_station::history::Period;
use halfrow_station::history::pareto::{Of, pareto};
use halfrow_station::history::yields::Wanted;
use halfrow_station::record::{RunCause, StepOutcome, StepRecord};

use super::made::{BEGIN_MS, End, HOUR_MS, Made, Run, record};

/// Six runs of four units failed: three with the memory as first suspect, one with the clock, one without a suspect, and one that
/// was too late.
fn made() -> Made {
    let mut made = Made::new();
    let runs = [
        ("S1", End::Fail(&["memory", "clock"]), "1"),
        ("S1", End::Fail(&["memory"]), "1"),
        ("S2", End::Fail(&["clock", "memory"]), "2"),
        ("S3", End::Fail(&["memory"]), "2"),
        ("S3", End::Fail(&[]), "2"),
        ("S4", End::TooLate, "1"),
        ("S5", End::Pass, "1"),
        ("S6", End::Error(RunCause::Link), "1"),
    ];
    for ((serial, end, lane), hour) in runs.into_iter().zip(0..) {
        made.run(&Run { lane: lane.to_owned(), ..Run::of(serial, end).at_hour(hour) });
    }
    made
}

/// Names with their numbers of runs and units.
fn bars(made: &Made, wanted: &Wanted, by: Of) -> Vec<(String, u64, u64)> {
    let pareto = pareto(&made.now(), wanted, by).unwrap();
    assert!(pareto.bars.iter().all(|bar| bar.runs.of == pareto.failed));
    pareto.bars.into_iter().map(|bar| (bar.name, bar.runs.count, bar.units)).collect()
}

fn named(bars: &[(&str, u64, u64)]) -> Vec<(String, u64, u64)> {
    bars.iter().map(|(name, runs, units)| ((*name).to_owned(), *runs, *units)).collect()
}

#[test]
fn failures_are_counted_by_the_part_that_is_suspected_first() {
    let made = made();
    let all = Wanted::default();
    assert_eq!(bars(&made, &all, Of::Part), named(&[("memory", 3, 2), ("", 2, 2), ("clock", 1, 1)]));
    let lane = Wanted { lane: Some("2".to_owned()), ..Wanted::default() };
    assert_eq!(bars(&made, &lane, Of::Part), named(&[("", 1, 1), ("clock", 1, 1), ("memory", 1, 1)]));
    let period = Period { from_ms: BEGIN_MS + HOUR_MS, until_ms: BEGIN_MS + 3 * HOUR_MS };
    let hours = Wanted { period, ..Wanted::default() };
    assert_eq!(bars(&made, &hours, Of::Part), named(&[("clock", 1, 1), ("memory", 1, 1)]));
    let (plan, lane) = (Some("final".to_owned()), Some("1".to_owned()));
    let both = Wanted { plan, lane, ..Wanted::default() };
    assert_eq!(bars(&made, &both, Of::Part), named(&[("memory", 2, 1), ("", 1, 1)]));
    let other = Wanted { plan: Some("other".to_owned()), ..Wanted::default() };
    assert_eq!(bars(&made, &other, Of::Part), Vec::new());
}

#[test]
fn failures_are_counted_by_the_check_that_failed() {
    let all = Wanted::default();
    assert_eq!(bars(&made(), &all, Of::Check), named(&[("verify", 5, 3), ("latency.clocks", 1, 1)]));
}

#[test]
fn a_step_that_failed_by_more_than_its_limit_counts_with_both() {
    let mut made = Made::new();
    made.run(&Run::of("S1", End::TooLateAndWrong));
    let right = named(&[("latency.clocks", 1, 1), ("verify", 1, 1)]);
    assert_eq!(bars(&made, &Wanted::default(), Of::Check), right);
}

#[test]
fn all_that_failed_are_told_with_their_units() {
    let all = pareto(&made().now(), &Wanted::default(), Of::Part).unwrap();
    // An ERROR is no judgement.
    assert_eq!((all.failed, all.judged, all.units), (6, 7, 4));
}

/// A retry was due since the station was at fault as well; in the second try the board is in time, but wrong.
#[test]
fn a_limit_that_a_try_missed_which_was_not_the_last_counts() {
    let mut made = Made::new();
    let [late, wrong] = [End::TooLate, End::Fail(&["memory"])].map(|end| Run::of("S1", end));
    let (head, plan) = made.begin(&wrong);
    let [late, mut tried] = [late, wrong].map(|run| record(head.clone(), plan.clone(), &run));
    let first = StepRecord { outcome: StepOutcome::Error, cause: RunCause::Station, ..late.steps[1].clone() };
    tried.steps[1].attempt = 2;
    tried.steps.insert(1, first);
    tried.marginal = true;
    made.store.finish(&tried, 2).unwrap();
    let right = named(&[("latency.clocks", 1, 1), ("verify", 1, 1)]);
    assert_eq!(bars(&made, &Wanted::default(), Of::Check), right);
}
