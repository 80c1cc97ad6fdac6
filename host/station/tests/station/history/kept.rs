//! Backups, and evidence that is removed.

use std::fs;
use std::os::unix::fs::{MetadataExt as _, PermissionsExt as _};
use std::path::Path;

use halfrow_station::check::{Checked, check};
use halfrow_station::history::runs::{Filter, Page, page};
use halfrow_station::kept::{Copied, CopyError, Pruned, backup, prune, restore};
use halfrow_station::store::{Folder, Snapshot, Store, StoreError};
use tempfile::TempDir;

use super::commands::did;
use super::made::{BEGIN_MS, End, HOUR_MS, Made, Run, id};
use crate::common::untold;

/// A PASS, two FAILs with evidence, of which the later one shares one piece with the earlier, and an open run.
fn made() -> Made {
    let mut made = Made::new();
    made.run(&Run::of("S1", End::Pass));
    for (serial, evidence, hour) in [("S2", vec!["old", "shared"], 1), ("S3", vec!["new", "shared"], 48)] {
        made.run(&Run { evidence, ..Run::of(serial, End::Fail(&["memory"])).at_hour(hour) });
    }
    made.run(&Run::of("S4", End::Open).at_hour(49));
    made
}

fn runs(folder: &Folder) -> Page {
    page(&Snapshot::take(folder).unwrap(), &Filter::default(), None, 100).unwrap()
}

/// Counts runs that ended, open runs, pieces of evidence, and pieces that were removed.
fn sound(folder: &Folder) -> [usize; 4] {
    let Checked { runs, open, evidence, pruned, superseded, faults, .. } =
        check(folder, &mut untold).unwrap();
    assert!(faults.is_empty() && superseded.is_empty(), "{faults:?} {superseded:?}");
    [runs, open, evidence, pruned]
}

fn hash_of(bytes: &str) -> String {
    halfrow::result::sha256([bytes.as_bytes()])
}

#[test]
fn a_backup_is_of_its_moment_while_runs_go_on() {
    let mut made = made();
    let place = tempfile::tempdir().unwrap();
    let to = place.path().join("copy");
    assert_eq!(
        backup(&made.folder(), &to, &mut untold).unwrap(),
        Copied { runs: 3, evidence: 6, unknown: 0, left_out: Vec::new() }
    );
    let copy = Folder::new(&to);
    let then = runs(&made.folder());
    made.run(&Run { lane: "2".to_owned(), ..Run::of("S5", End::Pass) });
    assert_eq!(sound(&copy), [3, 1, 7, 0], "the shared piece is looked at with each of its runs");
    assert_eq!(runs(&copy), then);
    assert_ne!(runs(&made.folder()), then);
    assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1, "nothing else is left there");
}

/// Lanes begin runs at the same time, and the store takes one after another.
#[test]
fn runs_are_sound_that_are_entered_in_another_order_than_they_began_in() {
    let mut made = Made::new();
    for (serial, lane, started_ms) in [("S1", "1", BEGIN_MS + 1), ("S2", "2", BEGIN_MS)] {
        made.run(&Run { lane: lane.to_owned(), started_ms, ..Run::of(serial, End::Pass) });
    }
    assert_eq!(sound(&made.folder()), [2, 0, 2, 0]);
}

#[test]
fn a_restored_folder_is_the_one_that_was_saved() {
    let made = made();
    let place = tempfile::tempdir().unwrap();
    let (copy, again) = (place.path().join("copy"), place.path().join("again"));
    backup(&made.folder(), &copy, &mut untold).unwrap();
    restore(&Folder::new(&copy), &again, &mut untold).unwrap();
    assert_eq!(sound(&Folder::new(&again)), [3, 1, 7, 0]);
    assert_eq!(runs(&Folder::new(&again)), runs(&made.folder()));
    // A station can work in the folder: the open run is closed, and another one can begin.
    let mut store = Store::open(&Folder::new(&again)).unwrap();
    assert_eq!(halfrow_station::run::recover(&mut store).unwrap().closed.len(), 1);
}

/// The folder may be a disk of its own, whose file system has a lost+found folder.
#[test]
fn a_folder_that_is_there_stays_the_one_that_it_is() {
    let (made, place) = (made(), tempfile::tempdir().unwrap());
    let [copy, disk] = ["copy", "disk"].map(|name| place.path().join(name));
    backup(&made.folder(), &copy, &mut untold).unwrap();
    fs::create_dir_all(disk.join("lost+found")).unwrap();
    fs::set_permissions(&disk, fs::Permissions::from_mode(0o750)).unwrap();
    let before = fs::metadata(&disk).unwrap();
    restore(&Folder::new(&copy), &disk, &mut untold).unwrap();
    assert_eq!(sound(&Folder::new(&disk)), [3, 1, 7, 0]);
    let after = fs::metadata(&disk).unwrap();
    assert_eq!((after.ino(), after.mode()), (before.ino(), before.mode()));
    assert!(disk.join("lost+found").is_dir() && !disk.join(".partial").exists());
    assert_eq!(fs::read_dir(place.path()).unwrap().count(), 2, "nothing else is left there");
}

/// A kill leaves what was copied so far, and a station that began anew next to it would be in the copy's way.
#[test]
fn no_station_begins_where_a_restore_has_not_ended() {
    let (made, place) = (made(), tempfile::tempdir().unwrap());
    let [copy, data] = ["copy", "data"].map(|name| place.path().join(name));
    backup(&made.folder(), &copy, &mut untold).unwrap();
    fs::create_dir_all(data.join(".partial/blobs")).unwrap();
    let refused = Store::open(&Folder::new(&data)).unwrap_err().to_string();
    assert!(refused.contains("a restore in ") && refused.contains(".partial"), "{refused}");
    assert_eq!(fs::read_dir(&data).unwrap().count(), 1, "nothing was begun");
    fs::remove_dir_all(data.join(".partial")).unwrap();
    restore(&Folder::new(&copy), &data, &mut untold).unwrap();
    // What a restore that was interrupted at its very end has left, or a backup, is in no station's way.
    fs::create_dir(data.join(".partial")).unwrap();
    drop(Store::open(&Folder::new(&data)).unwrap());
}

/// A service manager may start a station again in the folder that is being restored.
#[test]
fn a_restore_keeps_a_start_out_and_comes_to_no_folder_in_which_one_works() {
    let (made, place) = (made(), tempfile::tempdir().unwrap());
    let [copy, data] = ["copy", "data"].map(|name| place.path().join(name));
    backup(&made.folder(), &copy, &mut untold).unwrap();
    fs::create_dir(&data).unwrap();
    let lock = fs::File::create(data.join("station.lock")).unwrap();
    lock.lock().unwrap();
    let refused = restore(&Folder::new(&copy), &data, &mut untold).unwrap_err();
    assert!(matches!(refused, CopyError::Store(StoreError::InUse { .. })), "{refused:?}");
    drop(lock);
    // What is left of the lock of a killed restore is in no other's way.
    restore(&Folder::new(&copy), &data, &mut untold).unwrap();
    assert_eq!(sound(&Folder::new(&data)), [3, 1, 7, 0]);
    drop(Store::open(&Folder::new(&data)).unwrap());
}

/// The permissions of group and others on what is in `folder`, by name, where there are any.
fn open_to_others(folder: &Path) -> Vec<(String, u32)> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| {
        let entry = entry.unwrap();
        (entry.file_name().into_string().unwrap(), entry.metadata().unwrap().mode() & 0o077)
    });
    entries.filter(|(_, mode)| *mode != 0).collect()
}

/// Like the packaged station's own folder, wherever the copy is and whoever makes it.
#[test]
fn a_copy_and_what_is_restored_of_it_are_for_nobody_else() {
    let (made, place) = (made(), tempfile::tempdir().unwrap());
    let [copy, into, again] = ["copy", "into", "again"].map(|name| place.path().join(name));
    fs::create_dir(&into).unwrap();
    fs::set_permissions(&into, fs::Permissions::from_mode(0o755)).unwrap();
    backup(&made.folder(), &copy, &mut untold).unwrap();
    backup(&made.folder(), &into, &mut untold).unwrap();
    restore(&Folder::new(&copy), &again, &mut untold).unwrap();
    for folder in [&copy, &into, &again] {
        assert!(folder.join("station.db").is_file() && folder.join("blobs").is_dir());
        assert_eq!(open_to_others(folder), [], "{}", folder.display());
    }
    // A folder that existed keeps its permissions.
    assert_eq!(open_to_others(place.path()), [("into".to_owned(), 0o055)]);
}

#[test]
fn nothing_is_restored_into_the_copy_itself() {
    let (made, place) = (made(), tempfile::tempdir().unwrap());
    let copy = place.path().join("copy");
    backup(&made.folder(), &copy, &mut untold).unwrap();
    let before = fs::read_dir(&copy).unwrap().count();
    for inside in ["in", "blobs/in", "."] {
        let refused = restore(&Folder::new(&copy), &copy.join(inside), &mut untold).unwrap_err();
        assert!(refused.to_string().contains("inside the copy that is restored"), "{refused}");
    }
    assert_eq!(fs::read_dir(&copy).unwrap().count(), before);
}

#[test]
fn nothing_is_overwritten_and_damage_is_not_copied() {
    let made = made();
    let place = tempfile::tempdir().unwrap();
    let full = place.path().join("full");
    fs::create_dir(&full).unwrap();
    fs::write(full.join("thesis.txt"), "years").unwrap();
    assert!(matches!(backup(&made.folder(), &full, &mut untold), Err(CopyError::Exists { .. })));
    assert_eq!(fs::read_dir(&full).unwrap().count(), 1);
    let copy = place.path().join("copy");
    backup(&made.folder(), &copy, &mut untold).unwrap();
    fs::write(Folder::new(&copy).blobs().path(&hash_of("new")), "other").unwrap();
    let again = place.path().join("again");
    let refused = restore(&Folder::new(&copy), &again, &mut untold).unwrap_err();
    assert!(matches!(refused, CopyError::Faulty { faults: 1, .. }), "{refused:?}");
    assert!(refused.to_string().contains("holds other bytes"), "{refused}");
    assert_eq!(fs::read_dir(place.path()).unwrap().count(), 2, "what was begun is removed");
}

#[test]
fn old_evidence_is_removed_and_no_record_or_row() {
    let mut made = made();
    let before = runs(&made.folder());
    let first = prune(&mut made.store, BEGIN_MS + 24 * HOUR_MS, "engel").unwrap();
    assert_eq!(first, Pruned { pieces: 1, bytes: 3 });
    let blobs = made.folder().blobs();
    assert!(!blobs.path(&hash_of("old")).exists());
    assert!(blobs.path(&hash_of("shared")).exists(), "a later run has it, too");
    assert_eq!(sound(&made.folder()), [3, 1, 6, 1]);
    assert_eq!(runs(&made.folder()), before);
    let rest = prune(&mut made.store, BEGIN_MS + 72 * HOUR_MS, "engel").unwrap();
    assert_eq!(rest.pieces, 2);
    assert_eq!(sound(&made.folder()), [3, 1, 3, 4]);
    let place = tempfile::tempdir().unwrap();
    let to = place.path().join("copy");
    assert_eq!(
        backup(&made.folder(), &to, &mut untold).unwrap(),
        Copied { runs: 3, evidence: 3, unknown: 0, left_out: Vec::new() }
    );
    assert_eq!(sound(&Folder::new(&to)), [3, 1, 3, 4]);
}

/// A computer without a battery starts in 1970, until its clock is set.
#[test]
fn evidence_of_a_run_that_ended_by_a_clock_from_long_ago_is_no_older_for_it() {
    let mut made = made();
    let (began_ms, evidence) = (BEGIN_MS + 240 * HOUR_MS, vec!["new by its id"]);
    let id = id(began_ms, 99);
    let lane = "2".to_owned();
    let run = Run { started_ms: 1000, lane, evidence, ..Run::of("S7", End::Fail(&["memory"])) };
    made.run_as(id.clone(), &run);
    let place = tempfile::tempdir().unwrap();
    let to = place.path().join("kept");
    let copied = |made: &Made| did(made, &["evidence", &id, "--to", to.to_str().unwrap()]);
    assert_eq!(prune(&mut made.store, began_ms - HOUR_MS, "engel").unwrap().pieces, 3);
    assert_eq!(copied(&made).0, 0);
    assert_eq!(prune(&mut made.store, began_ms + HOUR_MS, "engel").unwrap().pieces, 1);
    fs::remove_dir_all(&to).unwrap();
    let (code, _, complained) = copied(&made);
    assert!(code == 3 && complained.contains("removed since older evidence is not kept"), "{complained}");
}

/// The control: without the line in the audit the evidence counts as lost.
#[test]
fn evidence_that_was_not_removed_by_age_is_missed() {
    let made = made();
    fs::remove_file(made.folder().blobs().path(&hash_of("old"))).unwrap();
    assert_eq!(check(&made.folder(), &mut untold).unwrap().faults.len(), 1);
}

/// What was removed with its run was written anew with a later one, and is now lost.
#[test]
fn evidence_of_a_later_run_is_missed_though_an_earlier_one_s_was_removed() {
    let mut made = made();
    assert_eq!(prune(&mut made.store, i64::MAX, "engel").unwrap().pieces, 3);
    assert_eq!(sound(&made.folder()), [3, 1, 3, 4]);
    let started_ms = 2 * BEGIN_MS;
    let lane = "2".to_owned();
    made.run(&Run { started_ms, lane, evidence: vec!["old"], ..Run::of("S6", End::Fail(&["memory"])) });
    assert_eq!(sound(&made.folder()), [4, 1, 6, 3]);
    fs::remove_file(made.folder().blobs().path(&hash_of("old"))).unwrap();
    assert_eq!(check(&made.folder(), &mut untold).unwrap().faults.len(), 1);
}

#[test]
fn evidence_that_was_removed_twice_is_not_missed() {
    let mut made = made();
    assert_eq!(prune(&mut made.store, i64::MAX, "engel").unwrap().pieces, 3);
    let database = rusqlite::Connection::open(made.folder().database()).unwrap();
    let (removed_ms, started_ms) = (BEGIN_MS + 100 * HOUR_MS, BEGIN_MS + 101 * HOUR_MS);
    assert_eq!(database.execute("UPDATE audit SET at_ms = $1 WHERE act = 'prune'", [removed_ms]).unwrap(), 3);
    let lane = "2".to_owned();
    made.run(&Run { started_ms, lane, evidence: vec!["old"], ..Run::of("S6", End::Fail(&["memory"])) });
    assert_eq!(prune(&mut made.store, i64::MAX, "engel").unwrap().pieces, 1);
    assert_eq!(sound(&made.folder()), [4, 1, 4, 5]);
}

#[test]
fn a_record_is_kept_even_where_a_row_calls_it_an_attachment() {
    let mut made = made();
    let record = runs(&made.folder()).runs.last().unwrap().record_sha256.clone().unwrap();
    let database = rusqlite::Connection::open(made.folder().database()).unwrap();
    let text =
        "INSERT INTO attachment SELECT id, 'x', record_sha256, 1, 'x' FROM run WHERE record_sha256 = $1";
    assert_eq!(database.execute(text, [&record]).unwrap(), 1);
    assert_eq!(prune(&mut made.store, i64::MAX, "engel").unwrap().pieces, 3);
    assert!(made.folder().blobs().get(&record).is_ok());
}

#[test]
fn the_commands_say_what_they_did() {
    let made = made();
    let place = tempfile::tempdir().unwrap();
    let copy = place.path().join("copy");
    let copy_name = copy.to_str().unwrap();
    let (code, said, _) = did(&made, &["backup", copy_name]);
    assert_eq!(code, 0, "{said}");
    assert!(said.starts_with("3 runs and 6 pieces of evidence are in "), "{said}");
    assert_eq!(did(&made, &["backup", copy_name]).0, 2, "it is there already");
    let restored: TempDir = tempfile::tempdir().unwrap();
    let (code, said, complained) = did(&restored, &["restore", copy_name]);
    assert_eq!((code, complained.as_str()), (0, ""), "{said}");
    let (code, said, _) = did(&restored, &["prune", "--older-than", "1", "--operator", "weber"]);
    assert_eq!(code, 0, "{said}");
    assert!(said.ends_with("every record is kept\n"), "{said}");
    let (code, said, _) = did(&restored, &["check"]);
    assert_eq!(code, 0, "{said}");
    assert_eq!(did(&made, &["prune", "--older-than", "1", "--operator", "weber"]).0, 4, "this test writes");
}

/// Whoever makes a copy each night learns of it at once, not on the day when the copy is needed.
#[test]
fn a_copy_that_would_not_be_restored_is_kept_and_told() {
    let made = made();
    let place = tempfile::tempdir().unwrap();
    let [whole, copy, again] = ["whole", "copy", "again"].map(|name| place.path().join(name));
    assert_eq!(did(&made, &["backup", whole.to_str().unwrap()]).0, 0);
    assert_eq!(made.change("UPDATE run SET headline = 'all is well' WHERE verdict = 'FAIL'"), 2);
    let (code, said, complained) = did(&made, &["backup", copy.to_str().unwrap()]);
    assert_eq!((code, complained.as_str()), (3, ""), "{said}");
    let lines: Vec<_> = said.lines().collect();
    let [first, second, told] = &lines[..] else { panic!("{said}") };
    assert!([first, second].iter().all(|line| line.starts_with("fault: table run, row ")), "{said}");
    assert!(told.contains(" are in ") && told.contains("; `restore` refuses it for 2 faults"), "{said}");
    let refused = restore(&Folder::new(&copy), &again, &mut untold).unwrap_err();
    assert!(matches!(refused, CopyError::Faulty { faults: 2, .. }), "{refused:?}");
    restore(&Folder::new(&whole), &again, &mut untold).unwrap();
}

/// The folder of a station that judged one unit, without these of its files.
fn kept_without(files: &[&str]) -> (TempDir, Folder) {
    let mut made = Made::new();
    let folder = made.folder();
    made.run(&Run::of("S1", End::Pass));
    let kept = made.closed();
    for file in files {
        let _ = fs::remove_file(kept.path().join(file));
    }
    (kept, folder)
}

#[test]
fn a_file_that_is_no_database_is_told_from_a_disk_that_is_full_or_locked() {
    let (_kept, folder) = kept_without(&["station.db-wal", "station.db-shm"]);
    let whole = fs::read(folder.database()).unwrap();
    let refused = || {
        [Store::open(&folder).map(drop), check(&folder, &mut untold).map(drop)]
            .map(|opened| opened.unwrap_err())
    };
    for damaged in [b"another file of this name ".repeat(40), [&[0; 512], &whole[512..]].concat()] {
        fs::write(folder.database(), damaged).unwrap();
        for error in refused() {
            assert!(matches!(error, StoreError::Damaged { .. }), "{error:?}");
        }
    }
    fs::remove_file(folder.database()).unwrap();
    fs::create_dir(folder.database()).unwrap();
    for error in refused() {
        assert!(matches!(error, StoreError::Database { .. }), "{error}");
    }
}

/// What a flipped bit in the name leaves: SQLite finds nothing wrong, but every query of the column fails.
#[test]
fn a_column_that_has_lost_its_name_is_a_fault_of_the_database() {
    let (_kept, folder) = kept_without(&["station.db-wal", "station.db-shm"]);
    let database = rusqlite::Connection::open(folder.database()).unwrap();
    database.execute_batch("ALTER TABLE retest RENAME COLUMN last_ms TO lsst_ms").unwrap();
    drop(database);
    let faults = check(&folder, &mut untold).unwrap().faults;
    let [fault] = &faults[..] else { panic!("{faults:?}") };
    assert!(fault.to_string().starts_with("the database is damaged (there is no retest.last_ms)"), "{fault}");
    let place = tempfile::tempdir().unwrap();
    let refused = restore(&folder, &place.path().join("restored"), &mut untold).unwrap_err();
    assert!(matches!(refused, CopyError::Faulty { .. }), "{refused:?}");
}

/// Otherwise the records, and the decisions based on them, would be gone without notice.
#[test]
fn nothing_begins_anew_beside_the_evidence_of_earlier_runs() {
    let (kept, folder) = kept_without(&["station.db", "station.db-wal", "station.db-shm"]);
    let refused = |folder: &Folder| {
        let opened = [Store::open(folder).map(drop), check(folder, &mut untold).map(drop)];
        opened.map(|opened| matches!(opened, Err(StoreError::DatabaseGone { .. })))
    };
    assert_eq!(refused(&folder), [true, true]);
    fs::write(folder.database(), "").unwrap();
    assert_eq!(refused(&folder), [true, true]);
    let copied = rusqlite::Connection::open(folder.database()).unwrap();
    // The state of the file while its tables are in the write-ahead log alone.
    copied
        .execute_batch(
            "PRAGMA journal_mode = WAL; CREATE TABLE t (n); DROP TABLE t; PRAGMA wal_checkpoint(TRUNCATE)",
        )
        .unwrap();
    drop(copied);
    assert_eq!(refused(&folder), [true, true]);
    // Without evidence there is nothing to lose.
    fs::remove_dir_all(kept.path().join("blobs")).unwrap();
    assert_eq!(refused(&folder), [false, false]);
}
