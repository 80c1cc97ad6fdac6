//! A database that is not whole, of which all that can be read is told, and nothing is changed.

use std::fs;

use halfrow_station::check::{Fault, check};
use halfrow_station::kept::{CopyError, backup, faults, restore};
use halfrow_station::store::{Folder, Snapshot, Store};

use super::commands::did;
use super::made::{End, Made, Run};
use super::put_back::killed;
use crate::common::{query, untold};

/// A station with a run of each verdict that counts, after these statements were executed in its database.
fn changed(statements: &str) -> Made {
    let mut made = Made::new();
    made.run(&Run::of("S1", End::Pass));
    made.run(&Run { lane: "2".to_owned(), ..Run::of("S2", End::Fail(&["memory"])) });
    made.change(statements);
    made
}

/// What `check` says of a database that is damaged, and how many other faults it has.
fn told(made: &Made) -> (Vec<String>, usize) {
    let mut faults = check(&made.folder(), &mut untold).unwrap().faults;
    let count = faults.len();
    faults.retain(|fault| matches!(fault, Fault::Database { .. }));
    let others = count - faults.len();
    (faults.iter().map(ToString::to_string).collect(), others)
}

fn damaged(what: &str) -> String {
    format!("the database is damaged ({what}); restore it from a copy")
}

/// SQLite would remove the log of a database without a page, with all runs that are only there.
#[test]
fn a_log_beside_a_database_that_is_empty_or_cut_off_stays_as_it_is() {
    let mut made = Made::new();
    made.run(&Run::of("S1", End::Pass));
    for (database, has_evidence, said) in [
        (&[][..], true, "no station.db that tells of them; bring back"),
        (&[], false, "no station.db that tells of them; bring back"),
        (&[b'x'; 63], true, "is damaged, or no database at all"),
        (&[b'x'; 63], false, "is damaged, or no database at all"),
    ] {
        let left = killed(&made);
        let folder = Folder::new(left.path());
        let files = || {
            ["station.db", "station.db-wal", "station.lock"].map(|name| fs::read(left.path().join(name)).ok())
        };
        fs::write(folder.database(), database).unwrap();
        if !has_evidence {
            fs::remove_dir_all(left.path().join("blobs")).unwrap();
        }
        let before = files();
        assert!(before[1].as_ref().is_some_and(|log| log.len() > 4096), "the control");
        for refused in [Snapshot::take(&folder).map(drop), Store::open(&folder).map(drop)] {
            let refused = refused.unwrap_err().to_string();
            assert!(refused.contains(said), "{refused}");
        }
        assert!(files() == before, "{} bytes, {has_evidence}", database.len());
    }
}

/// Whoever sees only the table would restore the database, and find the record wrong in the next check.
#[test]
fn a_table_that_is_lost_hides_no_record_that_is_damaged() {
    let made = changed("DROP TABLE retest");
    assert_eq!(told(&made), (vec![damaged("there is no retest")], 0));
    let record = query(made.as_ref(), "SELECT record_sha256 FROM run WHERE verdict = 'FAIL'").remove(0);
    fs::write(made.folder().blobs().path(&record), "other").unwrap();
    let (code, said, complained) = did(&made, &["check"]);
    let is_told = |said: &str| said.contains(&damaged("there is no retest")) && said.contains("other bytes");
    assert!(code == 3 && is_told(&said), "{said}{complained}");
    let place = tempfile::tempdir().unwrap();
    let (code, said, _) = did(&made, &["backup", place.path().join("copy").to_str().unwrap()]);
    assert!(code == 3 && said.contains(&damaged("there is no retest")), "{said}");
    for table in ["run", "attachment", "waiver", "audit"] {
        let made = changed(&format!("PRAGMA foreign_keys = OFF; DROP TABLE {table}"));
        assert_eq!(told(&made), (vec![damaged(&format!("there is no {table}"))], 0));
    }
}

#[test]
fn a_column_that_is_lost_is_one_fault_however_many_stand_after_it() {
    assert_eq!(
        told(&changed("ALTER TABLE run DROP COLUMN build")),
        (vec![damaged("there is no run.build")], 0)
    );
}

/// Two runs of one unit, or in one lane, would be open at once, and nothing would say so.
#[test]
fn an_index_that_is_lost_or_another_one_is_a_fault_and_is_not_restored() {
    for (statements, said) in [
        ("DROP INDEX run_open_unit", "there is no index run_open_unit"),
        (
            "DROP INDEX run_open_lane; CREATE INDEX run_open_lane ON run (station, lane) WHERE state = 'open'",
            "the index run_open_lane is another one",
        ),
    ] {
        let made = changed(statements);
        assert_eq!(told(&made), (vec![damaged(said)], 0));
        let place = tempfile::tempdir().unwrap();
        let [copy, again] = ["copy", "again"].map(|name| place.path().join(name));
        backup(&made.folder(), &copy, &mut untold).unwrap();
        assert_eq!(faults(&Folder::new(&copy), &mut untold).unwrap().len(), 1);
        assert!(matches!(
            restore(&Folder::new(&copy), &again, &mut untold),
            Err(CopyError::Faulty { faults: 1, .. })
        ));
    }
    // What somebody adds to look something up faster is in nobody's way.
    assert_eq!(told(&changed("CREATE INDEX mine ON run (headline)")), (Vec::new(), 0));
}
