//! Pages of a list, compared with the whole list.

use halfrow::Verdict;
use halfrow_station::history::Period;
use halfrow_station::history::runs::{Filter, Page, page};
use halfrow_station::record::RunCause;

use super::made::{BEGIN_MS, End, HOUR_MS, Made, Run};

/// Forty runs, many with the same start, and not entered in the order of their starts.
fn made() -> (Made, Vec<(String, Run)>) {
    let mut made = Made::new();
    let ends = [End::Pass, End::Fail(&["memory"]), End::Error(RunCause::Link), End::Pass, End::Open];
    let mut entered = Vec::new();
    for number in 0_usize..40 {
        let mut run = Run::of(&format!("S{}", number % 7), ends[number % 5]);
        run.started_ms = BEGIN_MS + HOUR_MS * (number as i64 * 7 % 11);
        run.plan = [("final", "1"), ("final", "2"), ("intake", "1")][number % 3];
        run.lane = (number % 4).to_string();
        run.operator = ["weber", "lang"][number % 2].to_owned();
        if run.end == End::Open {
            // A lane and a unit can only have one open run.
            run.lane = format!("open {number}");
            run.serial = format!("OPEN{number}");
        }
        entered.push((made.run(&run), run));
    }
    (made, entered)
}

/// The runs that `filter` selects, taken from the list itself.
fn wanted(entered: &[(String, Run)], filter: &Filter) -> Vec<String> {
    let verdict = |run: &Run| match run.end {
        End::Pass => Some(Verdict::Pass),
        End::Fail(_) | End::TooLate | End::TooLateAndWrong => Some(Verdict::Fail),
        End::Error(_) => Some(Verdict::Error),
        End::Open => None,
    };
    let is = |wanted: &Option<String>, found: &str| wanted.as_ref().is_none_or(|wanted| wanted == found);
    let mut found: Vec<_> = entered
        .iter()
        .filter(|(_, run)| is(&filter.serial, &run.serial) && is(&filter.plan, run.plan.0))
        .filter(|(_, run)| is(&filter.lane, &run.lane) && is(&filter.operator, &run.operator))
        .filter(|(_, run)| filter.verdict.is_none() || filter.verdict == verdict(run))
        .filter(|(_, run)| (filter.period.from_ms..filter.period.until_ms).contains(&run.started_ms))
        .map(|(id, run)| (run.started_ms, id.clone()))
        .collect();
    found.sort_unstable();
    found.into_iter().rev().map(|(_, id)| id).collect()
}

/// All pages of `limit` runs each, one after another.
fn walked(made: &Made, filter: &Filter, limit: u32) -> Vec<String> {
    let (mut found, mut after) = (Vec::new(), None);
    loop {
        let Page { runs, next } = page(&made.now(), filter, after.as_ref(), limit).unwrap();
        assert!(runs.len() <= limit as usize);
        assert!(next.is_none() || runs.len() == limit as usize);
        assert!(after.is_none() || !runs.is_empty(), "the last page of {limit} named a next one");
        found.extend(runs.into_iter().map(|run| run.id));
        match next {
            Some(next) => after = Some(next),
            None => return found,
        }
    }
}

#[test]
fn pages_together_are_the_whole_list_for_every_combination_of_filters() {
    let (made, entered) = made();
    let text = |is: bool, value: &str| is.then(|| value.to_owned());
    let mut found_any = 0;
    for chosen in 0..128 {
        let is = |bit: u32| chosen >> bit & 1 == 1;
        let all = Period::default();
        let some = Period { from_ms: BEGIN_MS + HOUR_MS, until_ms: BEGIN_MS + 9 * HOUR_MS };
        let filter = Filter {
            serial: text(is(0), "S3"),
            // All runs are of this product, and of several plans.
            product: text(is(6), super::made::PRODUCT),
            plan: text(is(1), "final"),
            station: None,
            lane: text(is(2), "1"),
            operator: text(is(3), "lang"),
            verdict: is(4).then_some(Verdict::Pass),
            period: if is(5) { some } else { all },
        };
        let right = wanted(&entered, &filter);
        found_any += usize::from(!right.is_empty());
        for limit in [1, 7, 40, 1000] {
            assert_eq!(walked(&made, &filter, limit), right, "{filter:?}, pages of {limit}");
        }
    }
    assert!(found_any > 40, "only {found_any} filters find anything");
}

#[test]
fn nothing_is_found_by_a_name_that_is_not_there() {
    let (made, _) = made();
    for filter in [
        Filter { serial: Some("S".to_owned()), ..Filter::default() },
        Filter { plan: Some("' OR 1=1 --".to_owned()), ..Filter::default() },
        Filter { operator: Some("%".to_owned()), ..Filter::default() },
    ] {
        assert_eq!(walked(&made, &filter, 10), Vec::<String>::new());
    }
}

/// With row numbers instead of keys, a run would be shown twice.
#[test]
fn runs_that_are_added_meanwhile_move_nothing() {
    let (mut made, entered) = made();
    let all = wanted(&entered, &Filter::default());
    let first = page(&made.now(), &Filter::default(), None, 10).unwrap();
    made.run(&Run::of("NEW", End::Pass).at_hour(100));
    let second = page(&made.now(), &Filter::default(), first.next.as_ref(), 10).unwrap();
    assert_eq!(
        second.runs.iter().map(|run| &run.id).collect::<Vec<_>>(),
        all[10..20].iter().collect::<Vec<_>>()
    );
}

#[test]
fn a_line_says_what_was_entered() {
    let mut made = Made::new();
    let run = Run { lane: "3".to_owned(), operator: "lang".to_owned(), ..Run::of("S1", End::TooLate) };
    let id = made.run(&run);
    let page = page(&made.now(), &Filter::default(), None, 1).unwrap();
    let [line] = &page.runs[..] else { panic!("{page:?}") };
    assert_eq!((&line.id, line.started_ms, line.ended_ms), (&id, BEGIN_MS, Some(BEGIN_MS + 1500)));
    assert_eq!((line.serial.as_str(), line.product.as_str()), ("S1", super::made::PRODUCT));
    assert_eq!((line.plan.as_str(), line.version.as_str()), ("final", "1"));
    assert_eq!(
        (line.station.as_str(), line.lane.as_str(), line.operator.as_str()),
        ("station 7", "3", "lang")
    );
    assert_eq!((line.verdict, line.cause.as_deref()), (Some(Verdict::Fail), Some("board")));
    assert_eq!((line.nth, line.waived), (1, false));
}
