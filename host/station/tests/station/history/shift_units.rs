//! The units that check a shift are no products, and count nowhere.

use halfrow_station::check::check;
use halfrow_station::history::counts::Tally;
use halfrow_station::history::pareto::{Of, pareto};
use halfrow_station::history::yields::{By, Wanted, yields};
use halfrow_station::record::RunCause;
use halfrow_station::store::{Folder, Snapshot, Store};
use rusqlite::Connection;

use super::made::{BEGIN_MS, End, HOUR_MS, Made, Run, SHIFT};
use crate::common::{query, untold};

const GOOD: &str = "CAT00001";
const BAD: &str = "CAT00002";

/// Two shifts with three products. The bad unit was a product under the plan before it, and is judged by that once more.
pub(crate) fn made() -> Made {
    let mut made = Made::new();
    let before = ("shift", "before");
    for (hour, plan, serial, end) in [
        (0, before, BAD, End::Fail(&["clock"])),
        (1, SHIFT, GOOD, End::Pass),
        (2, SHIFT, BAD, End::Fail(&["core"])),
        (3, SHIFT, "CAT00003", End::Pass),
        (4, SHIFT, "CAT00004", End::Fail(&["memory"])),
        (5, SHIFT, "CAT00004", End::Pass),
        (6, SHIFT, "HR:MOCK:1", End::Fail(&["core"])),
        (24, SHIFT, GOOD, End::Error(RunCause::Link)),
        (25, SHIFT, GOOD, End::Pass),
        (26, SHIFT, BAD, End::Fail(&["core"])),
        (27, SHIFT, "CAT00005", End::Pass),
        (28, before, BAD, End::Pass),
    ] {
        made.run(&Run { plan, started_ms: BEGIN_MS + hour * HOUR_MS, ..Run::of(serial, end) });
    }
    made
}

/// Asserts of a station's folder that all is as its records say, and counted right.
fn is_right(folder: &Folder) {
    let faults = check(folder, &mut untold).unwrap().faults;
    assert!(faults.is_empty(), "{faults:?}");
    is_counted_right(&Snapshot::take(folder).unwrap());
}

/// Asserts what was counted by hand: of four units two passed at first and all in the end, and of six runs two failed.
pub(crate) fn is_counted_right(now: &Snapshot) {
    let all = Wanted::default();
    let lines = yields(now, &all, By::Plan).unwrap().lines;
    let [line] = &lines[..] else { panic!("{lines:?}") };
    assert_eq!((line.first_pass.count, line.first_pass.of, line.last.count), (2, 4, 4));
    assert_eq!((line.flipped, line.errors.count, line.errors.of), (2, 0, 6));
    let found = pareto(now, &all, Of::Part).unwrap();
    let parts: Vec<_> = found.bars.iter().map(|bar| (bar.name.as_str(), bar.runs.count)).collect();
    assert_eq!((found.failed, parts), (2, vec![("clock", 1), ("memory", 1)]));
    let counts = Tally::new(false, 0).counts(now).unwrap();
    let [count] = &counts.into_values().collect::<Vec<_>>()[..] else { panic!("one plan") };
    assert_eq!((count.passed, count.failed, count.errors, count.units, count.first_passed), (4, 2, 0, 4, 2));
}

/// The number of every judgement of this unit.
fn numbers(made: &impl AsRef<std::path::Path>, serial: &str) -> Vec<String> {
    let text = "SELECT nth FROM run JOIN unit ON unit.id = unit_id WHERE serial = '{}' ORDER BY run.id";
    query(made.as_ref(), &text.replace("{}", serial))
}

#[test]
fn units_that_check_a_shift_are_in_no_yield_and_not_among_what_fails_most() {
    let made = made();
    is_right(&made.folder());
    assert_eq!(numbers(&made, GOOD), ["0", "0", "0"]);
    assert_eq!(numbers(&made, BAD), ["1", "0", "0", "2"]);
}

/// Statements that count everything as programs did that had units which check a shift among the products, and take back the schema
/// after theirs.
pub(crate) fn as_before() -> String {
    let numbered = "UPDATE run SET nth = (
        SELECT 1 + count(*) FROM run AS earlier
        JOIN plan AS theirs ON theirs.sha256 = earlier.plan_sha256
        JOIN plan AS ours ON ours.sha256 = run.plan_sha256
        WHERE earlier.unit_id = run.unit_id AND theirs.name = ours.name AND earlier.id < run.id
          AND earlier.verdict <> 'ERROR')
        WHERE unit_id IN (SELECT id FROM unit WHERE serial NOT LIKE 'HR:MOCK:%');
        DELETE FROM day_count; DELETE FROM retest; DELETE FROM failure; DELETE FROM schema_version WHERE n = 8;
        DROP INDEX run_judged;";
    // The second schema counted what was there.
    let schema = include_str!("../../../sql/schema-2.sql");
    let counted = schema.split_inclusive(";\n").filter(|part| part.contains("INSERT INTO")).map(|counted| {
        counted
            .replace("WHERE verdict IS NOT NULL", "WHERE verdict IS NOT NULL AND nth > 0")
            .replace("run.verdict = 'FAIL'", "run.verdict = 'FAIL' AND run.nth > 0")
    });
    std::iter::once(numbered.to_owned()).chain(counted).collect()
}

#[test]
fn a_store_in_which_they_were_counted_is_counted_anew() {
    let folder = made().closed();
    let database = Connection::open(folder.path().join("station.db")).unwrap();
    database.execute_batch(&as_before()).unwrap();
    drop(database);
    // Of good and bad unit two judgements each, and an ERROR.
    assert_eq!(query(folder.path(), "SELECT sum(runs) FROM day_count"), ["11"]);
    assert_eq!(numbers(&folder, BAD), ["1", "2", "3", "4"]);
    drop(Store::open(&Folder::new(folder.path())).unwrap());
    is_right(&Folder::new(folder.path()));
    assert_eq!(numbers(&folder, GOOD), ["0", "0", "0"]);
    assert_eq!(numbers(&folder, BAD), ["1", "0", "0", "2"]);
    assert!(folder.path().join("station.before-8.db").is_file());
}

/// A unit that checks shifts is judged in every lane and every shift, and each lane asks for its last judgement before every run.
#[test]
fn the_last_judgement_of_such_a_unit_is_found_without_reading_those_before_it() {
    let folder = made().closed();
    let database = Connection::open(folder.path().join("station.db")).unwrap();
    let text = format!("EXPLAIN QUERY PLAN {}", include_str!("../../../sql/last-judgement.sql"));
    let mut statement = database.prepare(&text).unwrap();
    let of = ["12", "1", "plan", "CAM-T", GOOD];
    let looks = statement.query_map(of, |row| row.get::<_, String>(3)).unwrap();
    let looks: Vec<_> = looks.map(Result::unwrap).collect();
    let of_lane = "SEARCH run USING INDEX run_judged (unit_id=? AND plan_sha256=? AND station=? AND lane=?)";
    assert!(looks.iter().any(|look| look == of_lane), "{looks:?}");
    assert!(!looks.iter().any(|look| look.contains("SCAN") || look.contains("TEMP B-TREE")), "{looks:?}");
}
