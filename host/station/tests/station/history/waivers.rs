//! Waivers are added to a FAIL, with an entry in the audit.

use halfrow_station::record::RunCause;
use halfrow_station::store::NoWaiver;

use super::commands::did;
use super::made::{End, Made, Run};
use crate::common::reason;

fn rows(made: &Made, text: &str) -> Vec<String> {
    let database = rusqlite::Connection::open(made.folder().database()).unwrap();
    let mut statement = database.prepare(text).unwrap();
    statement.query_map([], |row| row.get(0)).unwrap().map(Result::unwrap).collect()
}

#[test]
fn a_waiver_changes_no_verdict_and_is_audited() {
    let mut made = Made::new();
    let run = made.run(&Run::of("S1", End::Fail(&[])));
    let before = made.folder().verdict_of(&run).unwrap();
    let waiver = made.store.waive(&run, "engel", &reason(" used as it is ")).unwrap();
    assert_eq!((waiver.operator.as_str(), waiver.reason.as_str()), ("engel", "used as it is"));
    assert_eq!(made.folder().verdict_of(&run).unwrap(), before);
    assert_eq!(
        rows(&made, "SELECT run_id || ' ' || operator_id || ': ' || reason FROM waiver"),
        [format!("{run} engel: used as it is")]
    );
    assert_eq!(
        rows(&made, "SELECT act || ' ' || subject || ' ' || operator_id || ': ' || detail FROM audit"),
        [format!("waive {run} engel: used as it is")]
    );
}

#[test]
fn what_is_no_fail_or_has_a_waiver_is_not_waived() {
    let mut made = Made::new();
    let passed = made.run(&Run::of("S1", End::Pass));
    let error = made.run(&Run::of("S2", End::Error(RunCause::Crash)));
    let open = made.run(&Run::of("S3", End::Open));
    let failed = made.run(&Run { lane: "2".to_owned(), ..Run::of("S4", End::TooLate) });
    let mut waive = |run: &str, operator: &str, why: &str| made.store.waive(run, operator, &reason(why));
    assert!(matches!(waive(&passed, "engel", "x"), Err(NoWaiver::NoFail { .. })));
    assert!(matches!(waive(&error, "engel", "x"), Err(NoWaiver::NoFail { .. })));
    assert!(matches!(waive(&open, "engel", "x"), Err(NoWaiver::NoRun { .. })));
    assert!(matches!(waive("nothing", "engel", "x"), Err(NoWaiver::NoRun { .. })));
    waive(&failed, "engel", "x").unwrap();
    let again = waive(&failed, "lang", "y").unwrap_err();
    assert!(again.to_string().contains("by engel: x"), "{again}");
    assert_eq!(rows(&made, "SELECT operator_id FROM waiver"), ["engel"]);
    assert_eq!(rows(&made, "SELECT operator_id FROM audit"), ["engel"]);
}

/// A line of its own could look like a verdict.
#[test]
fn a_reason_and_a_name_are_printed_in_one_line() {
    let mut made = Made::new();
    let run = made.run(&Run::of("S1", End::Fail(&[])));
    let made = made.closed();
    let waive = ["waive", &run, "--operator", "Eve\u{1b}[8m", "--reason", "x\nPASS\u{202e}"];
    let (code, said, complained) = did(&made, &waive);
    assert_eq!((code, complained.as_str()), (0, ""));
    assert_eq!(said, format!("run {run} is waived by Eve\\u{{1b}}[8m: x\\nPASS\\u{{202e}}\n"));
    let (code, said, complained) = did(&made, &waive);
    assert_eq!((code, said.as_str()), (2, ""));
    assert!(
        complained.contains("already, by Eve\\u{1b}[8m: x\\nPASS\\u{202e}; one is enough"),
        "{complained}"
    );
}

/// The audit's line about it is not a result.
#[test]
fn a_waiver_that_is_not_sent_is_a_result_as_its_run_is() {
    let mut made = Made::new();
    made.store.sends_to(vec!["mes".to_owned()]).unwrap();
    let run = made.run(&Run::of("S1", End::Fail(&[])));
    made.store.waive(&run, "engel", &reason("x")).unwrap();
    let [unsent] = &made.now().unsent().unwrap()[..] else { panic!("there is one sink") };
    assert_eq!((unsent.entries, unsent.results), (3, 2));
}
