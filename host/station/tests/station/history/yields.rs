//! Yields, compared with cases that were worked by hand.

use halfrow_station::history::Period;
use halfrow_station::history::yields::{By, Wanted, Yields, yields};
use halfrow_station::record::RunCause;

use super::looked_at::all_between;
use super::made::{BEGIN_MS, DAY_MS, End, HOUR_MS, Made, Run};
use super::served::Served;
use crate::common::{now_ms, reason};

/// Runs in their order: the unit, then `P` for PASS, `F` FAIL, `W` a waived FAIL, `E` ERROR, `C` a crash, `R` refused, `O` open;
/// then the plan's name and version unless they are `final,1`. Next to them what counts for the plan `final`:
///
/// units, first pass, in the end, waived, flipped; runs, errors, crashes.
pub(crate) const CASES: [(&str, [u64; 8]); 42] = [
    ("A:P", [1, 1, 1, 0, 0, 1, 0, 0]),
    ("A:F", [1, 0, 0, 0, 0, 1, 0, 0]),
    // An ERROR is no judgement.
    ("A:E", [0, 0, 0, 0, 0, 1, 1, 0]),
    ("A:C", [0, 0, 0, 0, 0, 1, 1, 1]),
    ("A:R", [0, 0, 0, 0, 0, 1, 1, 0]),
    // A retest does not change the first pass.
    ("A:F A:P", [1, 0, 1, 0, 1, 2, 0, 0]),
    ("A:P A:F", [1, 1, 0, 0, 0, 2, 0, 0]),
    ("A:P A:P", [1, 1, 1, 0, 0, 2, 0, 0]),
    ("A:F A:F", [1, 0, 0, 0, 0, 2, 0, 0]),
    ("A:F A:F A:P", [1, 0, 1, 0, 1, 3, 0, 0]),
    ("A:F A:P A:F", [1, 0, 0, 0, 0, 3, 0, 0]),
    ("A:P A:F A:P", [1, 1, 1, 0, 0, 3, 0, 0]),
    ("A:F A:P A:F A:P", [1, 0, 1, 0, 1, 4, 0, 0]),
    // An ERROR before a judgement does not use up the first pass, and one after it takes nothing back.
    ("A:E A:P", [1, 1, 1, 0, 0, 2, 1, 0]),
    ("A:E A:F", [1, 0, 0, 0, 0, 2, 1, 0]),
    ("A:F A:E", [1, 0, 0, 0, 0, 2, 1, 0]),
    ("A:P A:E", [1, 1, 1, 0, 0, 2, 1, 0]),
    ("A:F A:E A:P", [1, 0, 1, 0, 1, 3, 1, 0]),
    ("A:E A:E A:E", [0, 0, 0, 0, 0, 3, 3, 0]),
    ("A:C A:P", [1, 1, 1, 0, 0, 2, 1, 1]),
    ("A:P A:C", [1, 1, 1, 0, 0, 2, 1, 1]),
    ("A:F A:C A:F", [1, 0, 0, 0, 0, 3, 1, 1]),
    ("A:F A:C A:P A:C", [1, 0, 1, 0, 1, 4, 2, 2]),
    ("A:R A:R A:P", [1, 1, 1, 0, 0, 3, 2, 0]),
    // A waiver does not make a FAIL a PASS. It counts while its FAIL is the last judgement.
    ("A:W", [1, 0, 0, 1, 0, 1, 0, 0]),
    ("A:W A:P", [1, 0, 1, 0, 1, 2, 0, 0]),
    ("A:W A:F", [1, 0, 0, 0, 0, 2, 0, 0]),
    ("A:F A:W", [1, 0, 0, 1, 0, 2, 0, 0]),
    ("A:P A:W", [1, 1, 0, 1, 0, 2, 0, 0]),
    ("A:W A:E", [1, 0, 0, 1, 0, 2, 1, 0]),
    ("A:W A:W", [1, 0, 0, 1, 0, 2, 0, 0]),
    ("A:W A:P A:W", [1, 0, 0, 1, 0, 3, 0, 0]),
    ("A:F A:W A:P", [1, 0, 1, 0, 1, 3, 0, 0]),
    // An open run does not count yet.
    ("A:F A:O", [1, 0, 0, 0, 0, 1, 0, 0]),
    // Each unit is counted by itself.
    ("A:P B:F", [2, 1, 1, 0, 0, 2, 0, 0]),
    ("A:F B:F A:P", [2, 0, 1, 0, 1, 3, 0, 0]),
    ("A:W B:P C:E D:F D:P", [3, 1, 2, 1, 1, 5, 1, 0]),
    // Another version of the plan is counted with it, another plan is not.
    ("A:F A:P@final,2", [1, 0, 1, 0, 1, 2, 0, 0]),
    ("A:F@final,2 A:W", [1, 0, 0, 1, 0, 2, 0, 0]),
    ("A:F A:P@intake,1", [1, 0, 0, 0, 0, 1, 0, 0]),
    ("A:P@intake,1 A:F@intake,1 A:P", [1, 1, 1, 0, 0, 1, 0, 0]),
    ("A:P@intake,1 A:F@intake,1 A:W", [1, 0, 0, 1, 0, 1, 0, 0]),
];

/// Enters one word of a case.
pub(crate) fn enter(made: &mut Made, word: &str, hour: i64) {
    let (word, plan) = word.split_once('@').unwrap_or((word, "final,1"));
    let (serial, end) = word.split_once(':').unwrap();
    let plan = match plan {
        "final,1" => ("final", "1"),
        "final,2" => ("final", "2"),
        _ => ("intake", "1"),
    };
    let ends = match end {
        "P" => End::Pass,
        "F" | "W" => End::Fail(&["memory"]),
        "E" => End::Error(RunCause::Link),
        "C" => End::Error(RunCause::Crash),
        "R" => End::Error(RunCause::Refused),
        "O" => End::Open,
        other => panic!("{other}"),
    };
    let run = Run { plan, ..Run::of(serial, ends).at_hour(hour) };
    let id = made.run(&run);
    if end == "W" {
        made.store.waive(&id, "engel", &reason("used as it is")).unwrap();
    }
}

fn told(story: &str) -> Yields {
    let mut made = Made::new();
    for (word, hour) in story.split(' ').zip(0..) {
        enter(&mut made, word, hour);
    }
    let wanted = Wanted { plan: Some("final".to_owned()), ..Wanted::default() };
    yields(&made.now(), &wanted, By::Plan).unwrap()
}

#[test]
fn every_run_counts_where_it_belongs() {
    for (story, right) in CASES {
        let found = told(story);
        let [line] = &found.lines[..] else { panic!("{story}: {found:?}") };
        let (first, last, errors) = (line.first_pass, line.last, line.errors);
        assert_eq!(first.of, last.of, "{story}");
        let counted = [
            first.of,
            first.count,
            last.count,
            line.waived,
            line.flipped,
            errors.of,
            errors.count,
            line.crashes,
        ];
        assert_eq!(counted, right, "{story}");
        assert_eq!(found.flips.len() as u64, right[4], "{story}");
    }
}

#[test]
fn what_is_open_has_no_yield() {
    assert_eq!(told("A:O").lines, Vec::new());
}

#[test]
fn what_flipped_is_listed_by_unit() {
    let found = told("A:F B:F C:F B:F B:P A:P C:F");
    let flips: Vec<_> = found
        .flips
        .iter()
        .map(|flip| (flip.serial.as_str(), flip.judgements, flip.failed_ms, flip.passed_ms))
        .collect();
    let hour = |hour: i64| BEGIN_MS + hour * HOUR_MS;
    assert_eq!(flips, [("A", 2, hour(0), hour(5)), ("B", 3, hour(1), hour(4))]);
}

/// A fails in lane 1 on the first day and passes in lane 2 on the second, where B passes at once.
fn of_two_days() -> Made {
    let mut made = Made::new();
    for (serial, end, lane, hour) in [
        ("A", End::Fail(&["memory"]), "1", 0),
        ("A", End::Error(RunCause::Link), "2", 23),
        ("A", End::Pass, "2", 24),
        ("B", End::Pass, "2", 25),
    ] {
        made.run(&Run { lane: lane.to_owned(), ..Run::of(serial, end).at_hour(hour) });
    }
    made
}

/// For each line its name, then units, first pass, in the end, runs, errors.
fn lines(made: &Made, wanted: &Wanted, by: By) -> Vec<(String, [u64; 5])> {
    let found = yields(&made.now(), wanted, by).unwrap();
    let line = |line: &halfrow_station::history::yields::Yield| {
        let day = line.day.map(|day| day.to_string());
        let name = day.or_else(|| line.lane.clone()).unwrap_or_default();
        let (first, last, errors) = (line.first_pass, line.last, line.errors);
        (name, [first.of, first.count, last.count, errors.of, errors.count])
    };
    found.lines.iter().map(line).collect()
}

#[test]
fn a_unit_belongs_to_the_lane_and_the_day_of_its_first_judgement() {
    let made = of_two_days();
    let of = |lines: &[(&str, [u64; 5])]| {
        lines.iter().map(|(name, counts)| ((*name).to_owned(), *counts)).collect::<Vec<_>>()
    };
    let all = Wanted::default();
    let by_day = of(&[("2026-11-01", [1, 0, 1, 2, 1]), ("2026-11-02", [1, 1, 1, 2, 0])]);
    assert_eq!(lines(&made, &all, By::Day), by_day);
    assert_eq!(lines(&made, &all, By::Lane), of(&[("1", [1, 0, 1, 1, 0]), ("2", [1, 1, 1, 3, 1])]));
    assert_eq!(lines(&made, &all, By::Plan), of(&[("", [2, 1, 2, 4, 1])]));
    let first = Wanted { lane: Some("1".to_owned()), ..Wanted::default() };
    assert_eq!(lines(&made, &first, By::Plan), of(&[("", [1, 0, 1, 1, 0])]));
    let period = Period { until_ms: BEGIN_MS + 24 * HOUR_MS, ..Period::default() };
    let first = Wanted { period, ..Wanted::default() };
    assert_eq!(lines(&made, &first, By::Plan), of(&[("", [1, 0, 1, 2, 1])]), "A passed behind it");
    assert_eq!(yields(&made.now(), &first, By::Plan).unwrap().flips.len(), 1);
    let period = Period { from_ms: BEGIN_MS + 24 * HOUR_MS, until_ms: BEGIN_MS + 25 * HOUR_MS };
    let hour = Wanted { period, ..Wanted::default() };
    assert_eq!(lines(&made, &hour, By::Plan), of(&[("", [0, 0, 0, 1, 0])]), "B began as it ended");
    let period = Period { from_ms: BEGIN_MS + 24 * HOUR_MS, ..Period::default() };
    let second = Wanted { period, ..Wanted::default() };
    assert_eq!(lines(&made, &second, By::Plan), of(&[("", [1, 1, 1, 2, 0])]));
    assert_eq!(yields(&made.now(), &second, By::Plan).unwrap().flips, Vec::new());
}

/// A was judged in the first hour, and B in the second one of the same day.
#[test]
fn a_waived_unit_counts_in_the_hour_in_which_it_was_judged_alone() {
    let mut made = Made::new();
    for (word, hour) in [("A:W", 0), ("B:P", 1)] {
        enter(&mut made, word, hour);
    }
    let waived = |hour: i64| {
        let from_ms = BEGIN_MS + hour * HOUR_MS;
        let period = Period { from_ms, until_ms: from_ms + HOUR_MS };
        let found = yields(&made.now(), &Wanted { period, ..Wanted::default() }, By::Plan).unwrap();
        found.lines.iter().map(|line| (line.first_pass.of, line.waived)).collect::<Vec<_>>()
    };
    assert_eq!([0, 1].map(waived), [[(1, 1)], [(1, 0)]]);
}

/// A shift counts its own boards, whenever it is midnight in UTC, and whatever a clock that was ahead has dated.
#[test]
fn the_day_so_far_is_the_one_by_the_clock_on_the_wall() {
    let now_ms = now_ms();
    // Half past one at night, in a zone that is as far east of UTC as that takes (POSIX.1-2024, 8.3 counts to the west).
    let east = (90 - now_ms / 60_000).rem_euclid(1440);
    let east = if east > 720 { east - 1440 } else { east };
    let sign = if east > 0 { '-' } else { '+' };
    let zone = format!("XYZ{sign}{:02}:{:02}", east.abs() / 60, east.abs() % 60);
    let mut made = Made::new();
    for (serial, hours) in [("S1", 3), ("S2", 1), ("S3", -24)] {
        made.run(&Run { started_ms: now_ms - hours * HOUR_MS, ..Run::of(serial, End::Pass) });
    }
    let today = Served::in_zone(made, &zone).page("/today");
    let local = jiff::Timestamp::from_millisecond(now_ms + east * 60_000).unwrap();
    let (hours, minutes) = (east.abs() / 60, east.abs() % 60);
    let sign = if east < 0 { '-' } else { '+' };
    let day = format!("{} (UTC{sign}{hours:02}:{minutes:02}): 1 judged", local.strftime("%Y-%m-%d"));
    assert!(today.contains(&day), "{zone}: {day}: {today}");
}

/// All of 200 units passed in five days, and on the sixth one of three. The share of all is 201/203; of 40 units at least 37 pass
/// then, of three at least 2. An axis down to 90 % would have the third of the last day below its end.
#[test]
fn no_day_is_drawn_better_than_it_was() {
    let mut made = Made::new();
    for (day, units) in [40, 40, 40, 40, 40, 3].into_iter().zip(0..).map(|(units, day)| (day, units)) {
        for number in 0..units {
            let started_ms = BEGIN_MS + day * DAY_MS + number;
            let end = if day == 5 && number > 0 { End::Fail(&["memory"]) } else { End::Pass };
            made.run(&Run { started_ms, ..Run::of(&format!("S{day}-{number}"), end) });
        }
    }
    let page = Served::of(made).page("/yield?by=day");
    // 8 pixels from above is 100 %, and 108 is none: 8 + 100 · 2/3.
    assert!(page.contains("<path class=\"beyond\" d=\"M66 74.7 "), "{page}");
}

/// Six of six passed: the share is at least n/(n + z²) = 61.0 %, so an axis from 95 % on would cut off what is not known.
#[test]
fn the_interval_of_the_first_units_is_drawn_whole() {
    let mut made = Made::new();
    for number in 0..6 {
        made.run(&Run { started_ms: BEGIN_MS + number, ..Run::of(&format!("S{number}"), End::Pass) });
    }
    let page = Served::of(made).page("/yield?by=day");
    // 8 pixels from above is 100 %, and 108 is 50 %: 100 · (1 − 0.6097) / 0.5.
    assert!(
        page.contains("<rect class=\"interval\" x=\"5\" y=\"8.0\" width=\"2\" height=\"78.1\">"),
        "{page}"
    );
    assert!(!page.contains("class=\"cut\""), "{page}");
}

/// Of 40 of 40 at least 91.2 % is known, so the axis begins at 90 %; of three of three it is 43.8 %.
#[test]
fn an_interval_that_goes_on_below_the_chart_is_marked() {
    let mut made = Made::new();
    for (day, units) in [(0, 40), (1, 3)] {
        for number in 0..units {
            let started_ms = BEGIN_MS + day * DAY_MS + number;
            made.run(&Run { started_ms, ..Run::of(&format!("S{day}-{number}"), End::Pass) });
        }
    }
    let page = Served::of(made).page("/yield?by=day");
    let marks = all_between(&page, "<path class=\"cut\" d=\"", '"');
    // The second column begins at 12, and 90 % is at 108.
    assert_eq!(marks, ["M18 115 l-4 -6 h8 z"], "{page}");
}

/// Of 60 units all passed at one station, and none of 60 at the other: p = 6.3e-28, by Python's `math.erfc`.
#[test]
fn a_chance_that_nobody_can_imagine_is_told_as_less_than_one_that_can_be() {
    let mut made = Made::new();
    for number in 0..60 {
        for (station, end) in [("north", End::Pass), ("south", End::Fail(&["memory"]))] {
            made.run(&Run {
                station,
                started_ms: BEGIN_MS + number,
                ..Run::of(&format!("{station}{number}"), end)
            });
        }
    }
    let page = Served::of(made).page("/yield?by=station");
    assert!(page.contains(" · p &lt; 1e-15") && !page.contains("p = "), "{page}");
}

/// Of 12 units four passed, so two would be expected at each station, and five are needed.
#[test]
fn stations_with_too_few_units_are_not_said_to_be_alike() {
    let page = |cases: &[(&'static str, i64, [i64; 2])]| {
        let mut made = Made::new();
        for &(plan, units, passed) in cases {
            for (number, (station, passed)) in (0..units)
                .flat_map(|number| ["north", "south"].into_iter().zip(passed).map(move |of| (number, of)))
            {
                let end = if number < passed { End::Pass } else { End::Fail(&["memory"]) };
                let run = Run::of(&format!("{plan} {station} {number}"), end);
                made.run(&Run { station, plan: (plan, "1"), started_ms: BEGIN_MS + number, ..run });
            }
        }
        Served::of(made).page("/yield?by=station")
    };
    let few = ("few", 6, [4, 0]);
    let alike = "No station differs by more than chance.";
    let none = page(&[few]);
    assert!(none.contains("Too few units to compare stations.") && !none.contains(alike), "{none}");
    let some = page(&[few, ("many", 40, [20, 20])]);
    assert!(some.contains(alike) && some.contains("could be compared: 2 of 4."), "{some}");
}

#[test]
fn charts_of_two_products_are_told_apart() {
    let mut made = Made::new();
    for product in ["CAM-T", "CAM-U"] {
        made.run(&Run { product, ..Run::of(product, End::Pass) });
    }
    let page = Served::of(made).page("/yield?by=day");
    let captions = all_between(&page, "<figcaption>", '<');
    assert_eq!(captions, ["First pass: CAM-T final", "First pass: CAM-U final"]);
}

/// Of 70 units five failed, all of them on a day before those that are drawn.
#[test]
fn a_day_beyond_the_band_is_named_although_it_is_not_drawn() {
    let mut made = Made::new();
    for day in 0..66 {
        for number in 0..if day == 0 { 5 } else { 1 } {
            let started_ms = BEGIN_MS + (day - 90) * DAY_MS + number;
            let end = if day == 0 { End::Fail(&["memory"]) } else { End::Pass };
            made.run(&Run { started_ms, ..Run::of(&format!("S{day}-{number}"), end) });
        }
    }
    let page = Served::of(made).page("/yield?by=day");
    assert!(page.contains("Beyond the band: 2026-08-03</p>"), "{page}");
    assert!(
        page.contains("Only the newest 60 are drawn") && page.matches("class=\"point\"").count() == 60,
        "{page}"
    );
}
