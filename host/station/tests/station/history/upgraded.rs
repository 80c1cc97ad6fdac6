//! A store that a newer program upgrades.

use std::fs;
use std::process::Command;

use halfrow_station::store::{Folder, Store};
use rusqlite::Connection;

use super::commands::did;
use super::released::{before, copies, left, names, newest, upgraded};
use crate::common::{change, program, query};

/// The first schema with an outbox. Those in `released` are empty.
const WITH_OUTBOX: usize = 3;

#[test]
fn what_was_sent_and_what_was_not_stays_so_through_an_upgrade() {
    let outbox = "SELECT concat_ws(' ', sink, kind, subject, attempts, next_ms, done_ms, '/', dead_ms, said) FROM outbox \
                  UNION ALL SELECT id FROM origin ORDER BY 1";
    let entered = "INSERT INTO origin VALUES ('01a19467-e800-7000-8001-000000000000'); \
        INSERT INTO outbox (sink, kind, subject, attempts, next_ms, done_ms, dead_ms, said) \
        SELECT 'share', 'run', id, 2, 5, iif(verdict = 'PASS', 6, NULL), iif(verdict = 'FAIL', 7, NULL), 'no' FROM run";
    for number in WITH_OUTBOX..=newest() {
        let data = left(number);
        change(data.path(), entered);
        let before = query(data.path(), outbox);
        assert!(
            before.iter().any(|row| row.contains(" 6 /")) && before.iter().any(|row| row.contains("/ 7 "))
        );
        drop(Store::open(&Folder::new(data.path())).unwrap());
        assert_eq!(query(data.path(), outbox), before, "schema {number}");
    }
}

/// Figures may change with it, and whoever goes back looks for the copy.
#[test]
fn an_upgrade_is_told_once_with_what_is_kept_of_before() {
    let data = left(1);
    let call = || did(&data, &["prune", "--operator", "weber"]);
    let (code, _, told) = call();
    assert_eq!((code, told), (0, upgraded(1)));
    let (code, _, told) = call();
    assert!(code == 0 && told.is_empty(), "{told}");
}

#[test]
fn a_database_that_cannot_be_brought_up_to_date_is_the_earlier_programs_still() {
    let data = left(1);
    // The newest schema has another table of this name.
    change(data.path(), "CREATE TABLE mismatch (n)");
    let refused = Store::open(&Folder::new(data.path())).unwrap_err();
    assert!(format!("{refused:?}").contains("mismatch already exists"), "{refused:?}");
    assert_eq!(query(data.path(), "SELECT max(n) FROM schema_version"), ["1"]);
    // The copy is made once, however often the upgrade is tried.
    assert!(Store::open(&Folder::new(data.path())).is_err());
    assert_eq!(copies(data.path()), before(1));
}

/// An older database may be brought up to date in the folder of a newer one, for example when a copy that is too old is tried.
#[test]
fn a_copy_of_before_an_upgrade_is_not_written_over() {
    let data = left(1);
    let first = data.path().join("station.before-2.db");
    fs::write(&first, "of the day of the upgrade").unwrap();
    drop(Store::open(&Folder::new(data.path())).unwrap());
    assert_eq!(fs::read_to_string(&first).unwrap(), "of the day of the upgrade");
    let mut all = copies(data.path());
    all.sort();
    assert_eq!(all, ["station.before-2.2.db", "station.before-2.db"]);
    let copy = Connection::open(data.path().join(&all[0])).unwrap();
    assert_eq!(names(&copy, "SELECT CAST(max(n) AS TEXT) FROM schema_version"), ["1"]);
}

/// The disk is full before the copy is complete.
#[test]
fn of_a_copy_that_was_not_made_nothing_is_left() {
    let data = left(1);
    let call = "trap '' XFSZ; ulimit -f 64; exec \"$0\" prune --operator weber --data \"$1\"";
    let did = Command::new("sh").args(["-c", call]).arg(program()).arg(data.path()).output().unwrap();
    let said = String::from_utf8(did.stderr).unwrap();
    assert_eq!(did.status.code(), Some(3), "{said}");
    assert!(said.contains("a copy before a new version"), "{said}");
    assert_eq!(copies(data.path()), Vec::<String>::new());
    assert_eq!(query(data.path(), "SELECT max(n) FROM schema_version"), ["1"]);
    // The control: with room it is brought up to date.
    drop(Store::open(&Folder::new(data.path())).unwrap());
    assert_eq!(copies(data.path()), before(1));
}

/// A kill in between leaves these files.
#[test]
fn of_a_copy_that_was_not_finished_nothing_is_left() {
    let data = left(1);
    for name in ["station.before-2.partial", "station.before-2.partial-journal"] {
        fs::write(data.path().join(name), "as far as it came").unwrap();
    }
    drop(Store::open(&Folder::new(data.path())).unwrap());
    assert_eq!(copies(data.path()), before(1));
}
