//! A database that is put back: under a station at work, and next to the log of one that was killed.

use std::fs::{self, File};
use std::os::unix::fs::MetadataExt as _;
use std::path::Path;
use std::process::Command;

use halfrow_station::check::check;
use halfrow_station::kept::backup;
use halfrow_station::store::{Folder, Snapshot, Store};
use rusqlite::Connection;
use rusqlite::config::DbConfig;
use tempfile::TempDir;

use super::commands::did;
use super::made::{End, Made, Run};
use crate::common::{Did, folder, program, query, untold};

/// Puts a file back as `mv`, `rsync` and most programs do: another file gets the name.
fn renamed_to(from: &Path, to: &Folder) {
    let aside = to.path().join("aside");
    fs::copy(from, &aside).unwrap();
    fs::rename(&aside, to.database()).unwrap();
}

/// A copy of a station's folder as a kill at this moment would leave it.
pub(super) fn killed(made: &Made) -> TempDir {
    let left = folder();
    let from = made.folder().path().join(".");
    assert!(Command::new("cp").arg("-r").args([&from, left.path()]).status().unwrap().success());
    left
}

/// A station in its second session, after it judged S1 in its first; the database as it was in between; and the run that judged
/// S2 in the second session.
fn in_its_second_session() -> (Made, TempDir, String) {
    let mut made = Made::new();
    made.run(&Run::of("S1", End::Pass));
    let kept = made.closed();
    let earlier = folder();
    fs::copy(kept.path().join("station.db"), earlier.path().join("station.db")).unwrap();
    let mut made = Made::at(kept);
    made.count_from(2);
    let run = made.run(&Run::of("S2", End::Fail(&["memory"])));
    (made, earlier, run)
}

/// The units that were judged, as the database in `data` has them.
fn units(data: &Path) -> Vec<String> {
    query(data, "SELECT serial FROM run JOIN unit ON unit.id = unit_id ORDER BY 1")
}

#[test]
fn no_verdict_counts_that_is_in_another_file_than_the_one_of_this_name() {
    let (mut made, earlier, saved) = in_its_second_session();
    let [database, kept] = ["station.db", "kept.db"].map(|name| made.folder().path().join(name));
    let run = Run { lane: "2".to_owned(), ..Run::of("S3", End::Pass) };
    let (head, plan) = made.begin(&run);
    fs::hard_link(&database, &kept).unwrap();
    for is_there in [true, false] {
        if is_there {
            renamed_to(&earlier.path().join("station.db"), &made.folder());
        } else {
            fs::remove_file(&database).unwrap();
        }
        let refused = [
            made.try_finish(&run, head.clone(), plan.clone()).unwrap_err(),
            made.try_begin(&Run { lane: "3".to_owned(), ..Run::of("S4", End::Open) }).unwrap_err(),
        ];
        for refused in refused {
            assert!(refused.to_string().contains("was replaced or removed while this program"), "{refused}");
        }
        assert!(made.store.saved(&saved).is_err(), "though it is read back");
    }
    fs::rename(&kept, &database).unwrap();
    made.store.saved(&saved).unwrap();
    made.try_finish(&run, head, plan).unwrap();
    assert_eq!(units(made.closed().path()), ["S1", "S2", "S3"]);
}

/// `cp` puts a file back this way: it is the same file with other bytes.
#[test]
fn a_database_that_is_written_over_is_not_gone_on_with_nor_spoilt() {
    let (mut made, earlier, saved) = in_its_second_session();
    let data = made.folder();
    fs::copy(earlier.path().join("station.db"), data.database()).unwrap();
    let refused = made.try_begin(&Run { lane: "3".to_owned(), ..Run::of("S4", End::Open) }).unwrap_err();
    assert!(refused.to_string().contains("was replaced or removed while this program"), "{refused}");
    assert!(made.store.saved(&saved).is_err());
    // As the station does when it ends.
    made.store.fold_log();
    let kept = made.closed();
    let refused = Store::open(&data).unwrap_err().to_string();
    assert!(refused.contains("is the log of another database"), "{refused}");
    for log in ["station.db-wal", "station.db-shm"] {
        fs::remove_file(kept.path().join(log)).unwrap();
    }
    drop(Store::open(&data).unwrap());
    assert_eq!(units(kept.path()), ["S1"]);
}

/// The control: a second connection alone does read the verdict back, and yet it is lost.
#[test]
fn a_verdict_is_read_back_out_of_the_log_of_a_file_without_a_name() {
    let (mut made, earlier, saved) = in_its_second_session();
    renamed_to(&earlier.path().join("station.db"), &made.folder());
    let folder = made.folder();
    assert!(folder.verdict_of(&saved).unwrap().is_some());
    // As the station does when it ends.
    made.store.fold_log();
    let kept = made.closed();
    assert!(folder.verdict_of(&saved).unwrap().is_none());
    assert_eq!(units(kept.path()), ["S1"]);
}

/// How a database comes to be next to the log of another one, and whether a station may start on it.
#[test]
fn a_database_is_not_opened_with_the_log_of_another_one() {
    let (made, earlier, _) = in_its_second_session();
    let copy = folder();
    backup(&made.folder(), &copy.path().join("copy"), &mut untold).unwrap();
    let [of_before, of_now] = [earlier.path(), &copy.path().join("copy")].map(|data| data.join("station.db"));
    let open = |left: &TempDir| Store::open(&Folder::new(left.path())).map(drop);
    // What a kill leaves is whole, however often it is opened.
    let left = killed(&made);
    for _ in 0..2 {
        open(&left).unwrap();
        assert_eq!(units(left.path()), ["S1", "S2"]);
    }
    for (from, units_of_it) in [(&of_before, &["S1"][..]), (&of_now, &["S1", "S2"])] {
        for is_renamed in [false, true] {
            let left = killed(&made);
            let data = Folder::new(left.path());
            if is_renamed {
                renamed_to(from, &data);
            } else {
                fs::copy(from, data.database()).unwrap();
            }
            let refused = open(&left).unwrap_err().to_string();
            assert!(refused.contains("station.db-wal beside it is the log of another database"), "{refused}");
            assert!(open(&left).is_err(), "it was changed by nobody");
            let refused = Snapshot::take(&data).unwrap_err().to_string();
            assert!(refused.contains("is the log of another database"), "{refused}");
            for log in ["station.db-wal", "station.db-shm"] {
                fs::remove_file(left.path().join(log)).unwrap();
            }
            open(&left).unwrap();
            assert_eq!(units(left.path()), units_of_it);
            Snapshot::take(&data).unwrap();
        }
    }
}

/// A reader of the state before the start keeps the start's number from being written into the file itself.
#[test]
fn an_earlier_copy_is_told_apart_as_soon_as_nobody_reads_what_was_before_the_start() {
    let mut made = Made::new();
    made.run(&Run::of("S1", End::Pass));
    let kept = made.closed();
    let earlier = fs::read(kept.path().join("station.db")).unwrap();
    let reader = Snapshot::take(&Folder::new(kept.path())).unwrap();
    let mut made = Made::at(kept);
    let open = |left: &TempDir| Store::open(&Folder::new(left.path())).map(drop);
    // The control: neither number prevents a start yet.
    let left = killed(&made);
    fs::write(left.path().join("station.db"), &earlier).unwrap();
    open(&left).unwrap();
    drop(reader);
    made.count_from(2);
    made.run(&Run::of("S2", End::Pass));
    let left = killed(&made);
    open(&left).unwrap();
    assert_eq!(units(left.path()), ["S1", "S2"]);
    let left = killed(&made);
    fs::write(left.path().join("station.db"), &earlier).unwrap();
    let refused = open(&left).unwrap_err().to_string();
    assert!(refused.contains("is the log of another database"), "{refused}");
}

#[test]
fn a_log_of_another_database_is_not_shown_while_a_start_has_the_folder() {
    let (made, earlier, _) = in_its_second_session();
    let left = killed(&made);
    let data = Folder::new(left.path());
    let lock = File::options().write(true).open(left.path().join("station.lock")).unwrap();
    lock.lock().unwrap();
    Snapshot::take(&data).unwrap();
    fs::copy(earlier.path().join("station.db"), data.database()).unwrap();
    let refused = Snapshot::take(&data).unwrap_err().to_string();
    assert!(refused.contains("is the log of another database"), "{refused}");
}

/// A folder may be put back from a copy of its files while the old lock stays.
#[test]
fn a_database_and_its_log_that_were_put_there_together_count_without_the_lock_of_the_others() {
    let (made, ..) = in_its_second_session();
    let copied = killed(&made);
    let kept = Made::at(made.closed()).closed();
    for name in ["station.db", "station.db-wal"] {
        fs::copy(copied.path().join(name), kept.path().join(name)).unwrap();
    }
    let refused = Store::open(&Folder::new(kept.path())).unwrap_err().to_string();
    assert!(refused.contains("; if both files were put there together, or"), "{refused}");
    assert!(refused.contains("move station.lock out of the folder, or else"), "{refused}");
    fs::rename(kept.path().join("station.lock"), copied.path().join("moved")).unwrap();
    drop(Store::open(&Folder::new(kept.path())).unwrap());
    assert_eq!(units(kept.path()), ["S1", "S2"]);
}

/// `rsync` and `tar` put a whole folder back this way: nobody holds the new lock, and another station could start.
#[test]
fn a_station_whose_lock_is_another_file_goes_on_with_nothing_and_lets_no_lock_go() {
    let (mut made, _, saved) = in_its_second_session();
    let [lock, aside, kept] = ["station.lock", "aside", "kept"].map(|name| made.folder().path().join(name));
    let locks = |database: &Path| {
        let inode = format!(":{} ", fs::metadata(database).unwrap().ino());
        let locks = fs::read_to_string("/proc/locks").unwrap();
        locks.lines().filter(|line| line.contains("POSIX") && line.contains(&inode)).count()
    };
    let database = made.folder().database();
    let held = locks(&database);
    assert!(held > 0, "SQLite holds none");
    fs::hard_link(&lock, &kept).unwrap();
    fs::copy(&lock, &aside).unwrap();
    fs::rename(&aside, &lock).unwrap();
    // The station's pages read the database this way.
    drop(made.now());
    assert_eq!(locks(&database), held);
    let next = Run { lane: "3".to_owned(), ..Run::of("S4", End::Open) };
    let refused = made.try_begin(&next).unwrap_err().to_string();
    assert!(refused.contains("station.lock was replaced or removed while this program"), "{refused}");
    assert!(made.store.saved(&saved).is_err());
    fs::rename(&kept, &lock).unwrap();
    made.store.saved(&saved).unwrap();
    made.try_begin(&next).unwrap();
    // The control: closing any descriptor of the file gives the locks up.
    drop(File::open(&database).unwrap());
    assert_eq!(locks(&database), 0);
}

#[test]
fn a_start_says_once_that_its_database_was_put_back() {
    let (made, earlier, _) = in_its_second_session();
    let copy = folder();
    backup(&made.folder(), &copy.path().join("copy"), &mut untold).unwrap();
    let kept = made.closed();
    let is_said = |data: &Path| {
        let (code, _, said) = did(&data, &["prune", "--operator", "weber"]);
        assert_eq!(code, 0, "{said}");
        let is_said = said.contains("station.db was put back, or is another one");
        assert_eq!(is_said, said.contains("`halfrow-station check` says what it lacks"), "{said}");
        is_said
    };
    assert!(!is_said(kept.path()));
    for from in [earlier.path().join("station.db"), copy.path().join("copy/station.db")] {
        fs::copy(from, kept.path().join("station.db")).unwrap();
        assert!(is_said(kept.path()));
        assert!(!is_said(kept.path()));
    }
    // A copy that became a station's folder was not put back.
    assert!(!is_said(&copy.path().join("copy")));
}

/// The control: without what the start wrote down, nothing tells that the log belongs to another database.
#[test]
fn sqlite_plays_any_log_into_any_database() {
    let (made, earlier, _) = in_its_second_session();
    let left = killed(&made);
    fs::copy(earlier.path().join("station.db"), left.path().join("station.db")).unwrap();
    assert_eq!(units(left.path()), ["S1", "S2"]);
}

/// SQLite folds a log into the database many times while a station is at work. An earlier copy is then one of another database,
/// though no start lies in between. Here each copy is put next to each later log.
#[test]
fn a_copy_that_was_made_while_a_station_was_at_work_is_taken_whole_or_refused() {
    for is_read in [false, true] {
        let mut made = Made::new();
        let mut moments = Vec::new();
        let mut reader = None;
        for number in 1..=60 {
            made.run(&Run::of(&format!("S{number:02}"), End::Pass));
            match number {
                12 if is_read => reader = Some(made.now()),
                44 => drop(reader.take()),
                _ if number % 10 == 0 => moments.push((killed(&made), number)),
                _ => {}
            }
        }
        let mut found = [0, 0];
        for (later, (left, judged)) in moments.iter().enumerate() {
            for (copy, _) in &moments[..=later] {
                found[usize::from(is_taken(&copy.path().join("station.db"), left.path(), *judged))] += 1;
            }
        }
        let [refused, taken] = found;
        assert!(refused >= 8 && taken >= 8, "{found:?}: {is_read}");
    }
}

/// Whether a station starts on the database `copy` next to the log in `left`, where it `judged` this many units. If it does not,
/// nothing is shown and nothing is spoilt.
fn is_taken(copy: &Path, left: &Path, judged: usize) -> bool {
    let tried = folder();
    assert!(Command::new("cp").arg("-r").args([&left.join("."), tried.path()]).status().unwrap().success());
    let data = Folder::new(tried.path());
    fs::copy(copy, data.database()).unwrap();
    let taken = Store::open(&data).map(drop);
    if let Err(refused) = &taken {
        assert!(refused.to_string().contains("is the log of another database"), "{refused}");
        for refused in [Snapshot::take(&data).map(drop), check(&data, &mut untold).map(drop)] {
            let refused = refused.unwrap_err().to_string();
            assert!(refused.contains("is the log of another database"), "{refused}");
        }
        fs::copy(left.join("station.db"), data.database()).unwrap();
        Store::open(&data).unwrap();
    }
    assert_eq!(units(tried.path()).len(), judged, "{copy:?} {taken:?}");
    assert!(Snapshot::take(&data).unwrap().damage().unwrap().is_empty());
    taken.is_ok()
}

/// Whatever the reason of the failure, the log may still belong to another database.
#[test]
fn a_start_that_fails_leaves_the_log_that_it_found() {
    let (made, ..) = in_its_second_session();
    let left = killed(&made);
    let files = || ["station.db", "station.db-wal"].map(|name| fs::read(left.path().join(name)).unwrap());
    let newer = Connection::open(left.path().join("station.db")).unwrap();
    newer.set_db_config(DbConfig::SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, true).unwrap();
    newer.execute_batch("INSERT INTO schema_version VALUES (99, 'x', 1)").unwrap();
    drop(newer);
    let before = files();
    let refused = Store::open(&Folder::new(left.path())).unwrap_err().to_string();
    assert!(refused.contains("99"), "{refused}");
    assert!(files() == before, "it was folded");
}

/// A service is started again every second: what such a start noted would add up.
#[test]
fn a_start_on_a_full_disk_notes_nothing_for_the_next_one() {
    let (made, ..) = in_its_second_session();
    let left = killed(&made);
    let noted = || fs::read_to_string(left.path().join("station.lock")).unwrap();
    let before = noted();
    for _ in 0..2 {
        let mut full = Command::new("strace");
        full.args(["-qq", "-o", "/dev/null", "-e", "inject=pwrite64:error=ENOSPC", "-P"]);
        full.arg(left.path().join("station.db-wal")).arg(program()).args(["prune", "--operator", "weber"]);
        let did = Did::from(full.arg("--data").arg(left.path()).output().unwrap());
        assert!(did.code == Some(3) && did.complained.contains("refuses a new number"), "{did:?}");
        assert!(!did.complained.contains("all of station.db is looked at"), "{did:?}");
        assert_eq!(noted(), before);
    }
    assert_eq!(did(&left, &["prune", "--operator", "weber"]).0, 0);
    assert_eq!(units(left.path()), ["S1", "S2"]);
}

/// It may have been left by a program that did not write down which log it had.
#[test]
fn a_database_that_was_left_by_an_earlier_program_is_looked_at_before_its_log_counts() {
    let (made, ..) = in_its_second_session();
    let open = |left: &TempDir| Store::open(&Folder::new(left.path())).map(drop);
    let left = killed(&made);
    fs::write(left.path().join("station.lock"), "").unwrap();
    open(&left).unwrap();
    assert_eq!(units(left.path()), ["S1", "S2"]);
    let left = killed(&made);
    fs::write(left.path().join("station.lock"), "").unwrap();
    let mut database = fs::read(left.path().join("station.db")).unwrap();
    // A page of an index as an older copy has it.
    let page = query(left.path(), "SELECT rootpage FROM sqlite_schema WHERE name = 'binding_device'");
    let place = 4096 * (page[0].parse::<usize>().unwrap() - 1);
    database[place..place + 4096].fill(0);
    let left = killed(&made);
    fs::write(left.path().join("station.lock"), "").unwrap();
    fs::write(left.path().join("station.db"), &database).unwrap();
    let refused = open(&left).unwrap_err().to_string();
    assert!(refused.contains("is damaged, or no database at all"), "{refused}");
    assert!(fs::read(left.path().join("station.db")).unwrap() == database, "the log was not played into it");
}
