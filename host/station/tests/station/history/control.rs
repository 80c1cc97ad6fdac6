//! Limits of a p-chart and the test of two proportions, compared with the figures of SciPy and statsmodels.

use halfrow_station::history::control::{Limits, limits};
use halfrow_station::history::drift::drifts;
use halfrow_station::history::rate::Rate;
use halfrow_station::history::yields::{By, Wanted, Yield, yields};
use halfrow_station::plan::PlanName;

use super::made::{BEGIN_MS, DAY_MS, End, Made, Run};

/// Units, their mean in thousandths, and the least and the greatest number within the limits: `scipy.stats.binom.cdf` first
/// reaches 0.0013498980316301 there, from either side.
const LIMITS: [(u64, u64, u64, u64); 5] = [
    (30, 970, 25, 30),
    (200, 970, 186, 200),
    (1000, 950, 928, 969),
    (50, 500, 15, 35),
    (10_000, 990, 9869, 9928),
];

#[test]
fn the_limits_are_those_of_the_binomial_distribution() {
    for (of, mean, least, most) in LIMITS {
        let at = |count| Limits::of(&Rate::new(count, of), mean as f64 / 1000.0);
        let [low, high] = at(least).limits.map(|share| (share * of as f64).round() as u64);
        assert_eq!((low, high), (least, most), "{of} of mean {mean}");
        assert!(!at(least).is_beyond && !at(most).is_beyond);
        assert!(at(least - 1).is_beyond, "{of} of mean {mean}");
        assert!(most == of || at(most + 1).is_beyond, "{of} of mean {mean}");
    }
}

#[test]
fn groups_of_nobody_have_no_limits_and_shares_at_the_end_none_but_their_own() {
    assert_eq!(limits(&[]), []);
    assert_eq!(limits(&[Rate::new(0, 0)]), [None]);
    for (count, of, share) in [(0, 7, 0.0), (7, 7, 1.0)] {
        let found = limits(&[Rate::new(count, of)])[0].unwrap();
        assert_eq!((found.mean, found.limits, found.is_beyond), (share, [share, share], false));
    }
}

/// Passed and judged here, passed and judged elsewhere, and the p-value that `statsmodels.stats.proportion.proportions_ztest`
/// gives for them.
const CHANCES: [(u64, u64, u64, u64, f64); 3] = [
    (940, 1000, 9700, 10_000, 3.697_961_058_300_583_5e-7),
    (485, 500, 4850, 5000, 1.0),
    (480, 500, 4875, 5000, 0.045_924_752_314_011_07),
];

/// A line of a yield by station.
fn line(station: &str, first_pass: Rate) -> Yield {
    let mut made = Made::new();
    made.run(&Run::of("S1", End::Pass));
    let of_one = yields(&made.now(), &Wanted::default(), By::Station).unwrap().lines.remove(0);
    Yield { station: Some(station.to_owned()), first_pass, ..of_one }
}

#[test]
fn a_station_that_judges_otherwise_is_marked() {
    for (passed, judged, others, of, chance) in CHANCES {
        let found = drifts(&[line("1", Rate::new(passed, judged)), line("2", Rate::new(others, of))]);
        let [first, second] = &found[..] else { panic!("{found:?}") };
        let told = first.chance.unwrap();
        assert!((told - chance).abs() <= 1e-12 * chance.max(1e-3), "{told} and not {chance}");
        assert_eq!(first.chance, second.chance);
        // With two stations, half of one in a hundred.
        assert_eq!(first.is_marked, chance < 0.005);
        assert_eq!((first.elsewhere.count, first.elsewhere.of), (others, of));
    }
}

/// Of two stations 473 of 500 and 4850 of 5000 passed: p = 0.0037396, by Python's `math.erfc`. That is less than 0.01 / 2.
#[test]
fn with_more_plans_on_a_page_a_station_needs_more_to_be_marked() {
    let plan = |name: &str| {
        let of = |station: &str, passed, judged| {
            let line = line(station, Rate::new(passed, judged));
            Yield { plan: PlanName { plan: name.to_owned(), ..line.plan.clone() }, ..line }
        };
        [of("1", 473, 500), of("2", 4850, 5000)]
    };
    let marked = |plans: &[&str]| {
        let lines: Vec<_> = plans.iter().flat_map(|name| plan(name)).collect();
        drifts(&lines).iter().filter(|drift| drift.is_marked).count()
    };
    assert_eq!([marked(&["a"]), marked(&["a", "b"])], [2, 0]);
}

/// Of 1000 units each, 970 and 990 passed: p = 0.0013, which is less than 0.01 / 2, and more than 0.01 / 62.
#[test]
fn plans_with_too_few_units_to_tell_hide_no_station_that_judges_otherwise() {
    let pair = |name: &str, [one, other]: [Rate; 2]| {
        [("1", one), ("2", other)].map(|(station, rate)| {
            let line = line(station, rate);
            Yield { plan: PlanName { plan: name.to_owned(), ..line.plan.clone() }, ..line }
        })
    };
    let few = (0..30).flat_map(|number| pair(&format!("few {number}"), [Rate::new(2, 3), Rate::new(3, 3)]));
    let lines: Vec<_> =
        pair("many", [Rate::new(970, 1000), Rate::new(990, 1000)]).into_iter().chain(few).collect();
    let found = drifts(&lines);
    let marked: Vec<_> =
        found.iter().filter(|drift| drift.is_marked).map(|drift| drift.plan.plan.as_str()).collect();
    assert_eq!((found.len(), marked), (62, vec!["many", "many"]));
}

#[test]
fn of_few_units_or_one_station_nothing_is_told() {
    let few = drifts(&[line("1", Rate::new(20, 30)), line("2", Rate::new(900, 1000))]);
    assert!(few.iter().all(|drift| drift.chance.is_none() && !drift.is_marked), "{few:?}");
    assert_eq!(drifts(&[line("1", Rate::new(20, 30))]), []);
}

/// Weeks begin on Monday: 1 November 2026 is a Sunday.
#[test]
fn a_yield_by_week_has_whole_weeks_and_limits() {
    let mut made = Made::new();
    for (day, end) in [(0, End::Pass), (1, End::Pass), (7, End::Fail(&["clock"])), (8, End::Pass)] {
        made.run(&Run { started_ms: BEGIN_MS + day * DAY_MS, ..Run::of(&format!("S{day}"), end) });
    }
    let lines = yields(&made.now(), &Wanted::default(), By::Week).unwrap().lines;
    let weeks: Vec<_> = lines.iter().map(|line| line.week.unwrap().to_string()).collect();
    assert_eq!(weeks, ["2026-10-26", "2026-11-02", "2026-11-09"]);
    let passed: Vec<_> = lines.iter().map(|line| (line.first_pass.count, line.first_pass.of)).collect();
    assert_eq!(passed, [(1, 1), (1, 2), (1, 1)]);
    assert!(lines.iter().all(|line| line.limits.is_some_and(|limits| limits.mean == 0.75)), "{lines:?}");
}
