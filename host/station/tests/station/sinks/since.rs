//! Since when something is unsent, where the clock was wrong.

use halfrow_station::store::{Tried, Unsent};

use crate::common::now_ms;
use crate::history::made::{DAY_MS, End, HOUR_MS, Made, Run, id};

/// Ids go on behind those of a clock that was ahead, so they are of a time that is still to come.
#[test]
fn what_is_kept_behind_runs_of_a_clock_that_was_ahead_is_as_old_as_it_is() {
    let mut made = Made::new();
    made.store.sends_to(vec!["mes".to_owned()]).unwrap();
    let (now_ms, started_ms) = (now_ms(), now_ms() - 2 * HOUR_MS);
    made.run(&Run { started_ms: now_ms + 30 * DAY_MS, ..Run::of("S1", End::Pass) });
    let [ahead] = &made.folder().due("mes", now_ms, i64::MAX).unwrap()[..] else {
        panic!("there is one run")
    };
    made.store.tried("mes", &[(ahead.clone(), Tried::Done)], now_ms).unwrap();
    for (number, later_ms) in [(2, 0), (3, HOUR_MS)] {
        let run = Run { started_ms: started_ms + later_ms, ..Run::of(&format!("S{number}"), End::Pass) };
        made.run_as(id(now_ms + 30 * DAY_MS + i64::from(number), number), &run);
    }
    // A run takes 1.5 s.
    assert_eq!(since(&made), started_ms + 1500);
}

/// The control: of a run that is dated long ago, the id is right.
#[test]
fn what_a_clock_that_was_behind_has_dated_is_no_older_for_it() {
    let mut made = Made::new();
    made.store.sends_to(vec!["mes".to_owned()]).unwrap();
    let began_ms = now_ms() - 2 * HOUR_MS;
    made.run_as(id(began_ms, 1), &Run { started_ms: 1000, ..Run::of("S1", End::Pass) });
    assert_eq!(since(&made), began_ms);
}

fn since(made: &Made) -> i64 {
    let unsent = made.now().unsent().unwrap();
    let [Unsent { entries, since_ms, .. }] = unsent[..] else { panic!("{unsent:?}") };
    assert!(entries > 0);
    since_ms
}
