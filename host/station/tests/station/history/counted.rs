//! What is counted when a run ends: updated where the database is older, and checked against the records.

use halfrow::Verdict;
use halfrow_station::check::check;
use halfrow_station::history::unit::units;
use halfrow_station::store::{Folder, Snapshot, Store, StoreError};
use rusqlite::Connection;

use super::generated::first_schema;
use super::made::{BEGIN_MS, End, HOUR_MS, Made, Run};
use crate::common::untold;

#[test]
fn a_database_is_brought_up_to_date_with_a_copy_beside_it_by_who_writes_alone() {
    let kept = tempfile::tempdir().unwrap();
    let folder = Folder::new(kept.path());
    first_schema(&Connection::open(folder.database()).unwrap());
    let refused = Snapshot::take(&folder).unwrap_err();
    assert!(matches!(refused, StoreError::Older { found: 1, .. }), "{refused:?}");
    // What an earlier attempt left half written does no harm.
    std::fs::write(kept.path().join("station.before-2.partial"), "half").unwrap();
    drop(Store::open(&folder).unwrap());
    assert!(Snapshot::take(&folder).is_ok());
    let copy = Connection::open(kept.path().join("station.before-2.db")).unwrap();
    let version: i64 = copy.query_row("SELECT max(n) FROM schema_version", [], |row| row.get(0)).unwrap();
    assert_eq!(version, 1);
    assert!(!kept.path().join("station.before-2.partial").exists());
}

/// Ids contain the time, and tell in which order runs began.
#[test]
fn a_clock_that_is_set_back_puts_no_run_in_front_of_an_earlier_one() {
    let back = Run { started_ms: BEGIN_MS - HOUR_MS, ..Run::of("S1", End::Fail(&["memory"])) };
    let last = |made: &Made| units(&made.now(), "S1").unwrap()[0].runs[0].line.verdict;
    let faults = |made: &Made| check(&made.folder(), &mut untold).unwrap().faults.len();
    let mut by_clock = Made::new();
    by_clock.run(&Run::of("S1", End::Pass));
    by_clock.run(&back);
    assert!(last(&by_clock) == Some(Verdict::Pass) && faults(&by_clock) > 0);
    let mut made = Made::new();
    let first = made.run(&Run::of("S1", End::Pass));
    let id = made.store.new_id(back.started_ms).unwrap().to_string();
    assert!(id > first, "{id}");
    made.run_as(id, &back);
    assert_eq!((last(&made), faults(&made)), (Some(Verdict::Fail), 0));
    // A login while the clock was ahead is in no order with runs.
    let database = Connection::open(made.folder().database()).unwrap();
    let ahead = super::made::id(BEGIN_MS + 24 * HOUR_MS, 0);
    let line = "INSERT INTO audit VALUES (?1, ?2, 'weber', 'login', 'weber', '')";
    assert_eq!(database.execute(line, (&ahead, BEGIN_MS + 24 * HOUR_MS)).unwrap(), 1);
    // When the clock goes on, ids follow it again.
    let later = made.store.new_id(BEGIN_MS + HOUR_MS).unwrap().to_string();
    assert_eq!(later[..13], super::made::id(BEGIN_MS + HOUR_MS, 0)[..13]);
}

/// What is counted when a run ends follows from the records like everything else.
#[test]
fn what_was_counted_wrong_is_told_by_check() {
    let mut made = Made::new();
    for (end, hour) in [End::Fail(&["memory"]), End::Pass].into_iter().zip(0..) {
        made.run(&Run::of("S1", end).at_hour(hour));
    }
    let faults = || {
        check(&made.folder(), &mut untold).unwrap().faults.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    assert_eq!(faults(), Vec::<String>::new());
    for (change, told) in [
        ("UPDATE day_count SET passed = passed + 1", "passed is `1`, and the records say `0`"),
        ("UPDATE retest SET last_verdict = 'FAIL'", "last_verdict is `FAIL`, and the records say `PASS`"),
        ("DELETE FROM failure WHERE kind = 'check'", "table failure has no row"),
    ] {
        let before = faults().len();
        made.change(change);
        let after = faults();
        assert_eq!(after.len(), before + 1, "{after:?}");
        assert!(after.iter().any(|fault| fault.contains(told)), "{after:?}");
    }
}
