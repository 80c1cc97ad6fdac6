//! What no row of the database names is removed after a day, and nothing else.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, SystemTime};

use halfrow_station::check::{Fault, check};
use halfrow_station::kept::{Copied, Pruned, Unnamed, backup, prune, prune_unnamed, restore};
use halfrow_station::record::RunCause;
use halfrow_station::run::{recover, recover_run};
use halfrow_station::store::{Folder, SharedStore};
use serde_json::json;

use super::commands::did;
use super::made::{BEGIN_MS, End, HOUR_MS, Made, Run, id};
use crate::common::{Over, query, untold};
use crate::runs::bench::{PLAN, Station};

const HOUR: Duration = Duration::from_secs(3600);

/// Sets a file's time to this long ago.
fn aged(path: &Path, age: Duration) {
    File::options().append(true).open(path).unwrap().set_modified(SystemTime::now() - age).unwrap();
}

/// Stores evidence of this age; returns its hash.
fn evidence(folder: &Folder, bytes: &str, age: Duration) -> String {
    let hash = folder.blobs().put(bytes.as_bytes()).unwrap();
    aged(&folder.blobs().path(&hash), age);
    hash
}

/// Makes the spool of the run `run`, of this age.
fn spool(folder: &Folder, run: &str, age: Duration) {
    let path = folder.spool(run);
    fs::create_dir(&path).unwrap();
    let events = path.join("events.jsonl");
    fs::write(&events, "{}\n").unwrap();
    aged(&events, age);
    File::open(&path).unwrap().set_modified(SystemTime::now() - age).unwrap();
}

fn is_sound(folder: &Folder) {
    let checked = check(folder, &mut untold).unwrap();
    assert!(checked.faults.is_empty(), "{:?}", checked.faults);
}

#[test]
fn what_no_row_names_goes_when_it_is_a_day_old() {
    let mut made = Made::new();
    made.run(&Run { evidence: vec!["seen"], ..Run::of("S1", End::Fail(&["memory"])) });
    let folder = made.folder();
    // Named files stay, however old they are.
    for hash in query(made.as_ref(), "SELECT sha256 FROM attachment UNION SELECT record_sha256 FROM run") {
        aged(&folder.blobs().path(&hash), 1000 * HOUR);
    }
    let old = evidence(&folder, "nobody's", 25 * HOUR);
    let young = evidence(&folder, "whose?", 23 * HOUR);
    // Written while the clock was ahead, which then was set right.
    let ahead = folder.blobs().put(b"tomorrow's").unwrap();
    let tomorrow = SystemTime::now() + 25 * HOUR;
    File::open(folder.blobs().path(&ahead)).unwrap().set_modified(tomorrow).unwrap();
    let mine = folder.blobs().path(&old).with_file_name("notes.txt");
    fs::write(&mine, "of a technician").unwrap();
    aged(&mine, 1000 * HOUR);
    let removed = prune_unnamed(&mut made.store, "engel").unwrap();
    assert_eq!(removed, Unnamed { pieces: 1, spools: 0, bytes: 8 });
    assert!(folder.blobs().get(&old).unwrap_err().is_gone());
    assert!(folder.blobs().get(&young).is_ok() && folder.blobs().get(&ahead).is_ok() && mine.is_file());
    let noted = "SELECT act || ' ' || subject || ' ' || operator_id FROM audit";
    assert_eq!(query(made.as_ref(), noted), [format!("prune unnamed {old} engel")]);
    is_sound(&folder);
    assert_eq!(prune_unnamed(&mut made.store, "engel").unwrap(), Unnamed::default());
}

/// The index was lost or restored from an older copy: what it does not name may be all that is left of a run.
#[test]
fn a_record_that_no_row_names_stays_and_what_it_names() {
    let mut made = Made::new();
    made.run(&Run { evidence: vec!["seen"], ..Run::of("S1", End::Fail(&["memory"])) });
    let theirs = query(made.as_ref(), "SELECT sha256 FROM attachment UNION SELECT record_sha256 FROM run");
    let folder = made.closed();
    // An older copy of the database, made before all runs.
    fs::copy(Made::new().closed().path().join("station.db"), folder.path().join("station.db")).unwrap();
    let mut made = Made::at(folder);
    for hash in &theirs {
        aged(&made.folder().blobs().path(hash), 1000 * HOUR);
    }
    let old = evidence(&made.folder(), "nobody's", 25 * HOUR);
    assert_eq!(prune_unnamed(&mut made.store, "engel").unwrap().pieces, 1);
    assert!(made.folder().blobs().get(&old).is_err());
    for hash in &theirs {
        made.folder().blobs().get(hash).unwrap();
    }
}

/// The row of the younger run that has the evidence, too, is lost with an older copy of the database that was put back.
#[test]
fn what_a_record_without_a_row_names_does_not_go_with_the_old_run_that_has_it_too() {
    let mut made = Made::new();
    let run = |serial, hour| Run {
        evidence: vec!["seen"],
        ..Run::of(serial, End::Fail(&["memory"])).at_hour(hour)
    };
    made.run(&run("S1", 0));
    let folder = made.closed();
    let earlier = fs::read(folder.path().join("station.db")).unwrap();
    let mut made = Made::at(folder);
    made.numbered(2, &run("S2", 48));
    let folder = made.closed();
    fs::write(folder.path().join("station.db"), earlier).unwrap();
    let mut made = Made::at(folder);
    assert_eq!(prune(&mut made.store, BEGIN_MS + 24 * HOUR_MS, "engel").unwrap(), Pruned::default());
    assert!(made.folder().blobs().get(&halfrow::result::sha256(["seen"])).is_ok());
}

/// The power failed between the record and its row, and the run was closed with another record of the same evidence.
#[test]
fn a_record_that_another_one_of_its_run_took_the_place_of_keeps_nothing_from_going_by_age() {
    let mut made = Made::new();
    made.run(&Run { started_ms: BEGIN_MS, evidence: vec!["seen"], ..Run::of("S1", End::Fail(&["memory"])) });
    let blobs = made.folder().blobs();
    let hashes = query(made.as_ref(), "SELECT record_sha256 FROM run");
    let mut record: serde_json::Value = serde_json::from_slice(&blobs.get(&hashes[0]).unwrap()).unwrap();
    record["conclusion"]["verdict"] = "PASS".into();
    blobs.put(record.to_string().as_bytes()).unwrap();
    assert_eq!(prune(&mut made.store, BEGIN_MS + 24 * HOUR_MS, "engel").unwrap().pieces, 1);
    assert!(blobs.get(&halfrow::result::sha256(["seen"])).is_err());
}

#[test]
fn what_a_record_names_stays_and_is_copied_where_its_rows_are_lost() {
    let mut made = Made::new();
    for (serial, evidence, hour) in [("S1", vec!["shared"], 0), ("S2", vec!["shared", "seen"], 48)] {
        made.run(&Run { evidence, ..Run::of(serial, End::Fail(&["memory"])).at_hour(hour) });
    }
    let folder = made.folder();
    for hash in query(made.as_ref(), "SELECT sha256 FROM attachment UNION SELECT record_sha256 FROM run") {
        aged(&folder.blobs().path(&hash), 1000 * HOUR);
    }
    let database = rusqlite::Connection::open(folder.database()).unwrap();
    let lost = "DELETE FROM attachment WHERE run_id = (SELECT max(id) FROM run)";
    assert_eq!(database.execute(lost, []).unwrap(), 2);
    assert_eq!(prune(&mut made.store, BEGIN_MS + 24 * HOUR_MS, "engel").unwrap(), Pruned::default());
    assert_eq!(prune_unnamed(&mut made.store, "engel").unwrap(), Unnamed::default());
    let place = tempfile::tempdir().unwrap();
    let copy = place.path().join("copy");
    assert_eq!(backup(&folder, &copy, &mut untold).unwrap().evidence, 4);
    for folder in [folder, Folder::new(&copy)] {
        assert_eq!(
            check(&folder, &mut untold).unwrap().evidence,
            5,
            "the shared piece is looked at with each of its runs"
        );
    }
}

/// A database of last night that is put back lies next to today's records, and goes on without their runs.
#[test]
fn a_record_whose_run_has_no_row_is_told_and_is_in_every_copy() {
    let mut made = Made::new();
    let run = made.run(&Run { evidence: vec!["seen"], ..Run::of("S1", End::Fail(&["memory"])) });
    let [seen] = &query(made.as_ref(), "SELECT sha256 FROM attachment")[..] else { panic!() };
    let [record] = &query(made.as_ref(), "SELECT record_sha256 FROM run")[..] else { panic!() };
    let folder = made.closed();
    fs::copy(Made::new().closed().path().join("station.db"), folder.path().join("station.db")).unwrap();
    let place = tempfile::tempdir().unwrap();
    let [copy, again] = ["copy", "again"].map(|name| place.path().join(name));
    let copied = Copied { runs: 0, evidence: 2, unknown: 1, left_out: Vec::new() };
    assert_eq!(backup(&Folder::new(folder.path()), &copy, &mut untold).unwrap(), copied);
    assert_eq!(restore(&Folder::new(&copy), &again, &mut untold).unwrap(), copied);
    for place in [folder.path(), &copy, &again] {
        let checked = check(&Folder::new(place), &mut untold).unwrap();
        let [Fault::Unnamed { run: told, sha256 }] = &checked.faults[..] else { panic!("{checked:?}") };
        assert_eq!((told, sha256), (&run, record));
        Folder::new(place).blobs().get(seen).unwrap();
    }
    let (code, said, _) = did(&folder, &["check"]);
    assert!(code == 3 && said.contains(&run) && said.contains(record), "{said}");
    let copied = did(&folder, &["backup", place.path().join("third").to_str().unwrap()]).1;
    assert!(copied.contains("1 record of runs that no row names"), "{copied}");
}

/// A bad sector below what is left of one run is no reason to have no copy of all the rest.
#[test]
fn a_copy_lacks_what_no_row_names_and_is_damaged_and_says_so() {
    let mut made = Made::new();
    made.run(&Run { evidence: vec!["seen"], ..Run::of("S1", End::Fail(&["memory"])) });
    made.run(&Run { lane: "2".to_owned(), ..Run::of("S2", End::Pass) });
    let [seen] = &query(made.as_ref(), "SELECT sha256 FROM attachment")[..] else { panic!() };
    let record = query(made.as_ref(), "SELECT record_sha256 FROM run WHERE verdict = 'PASS'").remove(0);
    let [seen, record] = [seen, &record].map(|hash| made.folder().blobs().path(hash));
    let folder = made.closed();
    fs::copy(Made::new().closed().path().join("station.db"), folder.path().join("station.db")).unwrap();
    fs::write(&seen, "other").unwrap();
    fs::write(&record, fs::read_to_string(&record).unwrap() + " ").unwrap();
    let place = tempfile::tempdir().unwrap();
    let [copy, again] = ["copy", "again"].map(|name| place.path().join(name));
    let (code, said, complained) = did(&folder, &["backup", copy.to_str().unwrap()]);
    assert_eq!((code, complained.as_str()), (3, ""), "{said}");
    for damaged in [seen, record] {
        let told = format!("fault: {} holds other bytes", damaged.display());
        assert!(said.lines().any(|line| line.starts_with(&told)), "{said}");
    }
    let rest = "0 runs and 1 piece of evidence are in ";
    assert!(said.contains(rest) && said.contains("; with them 1 record of runs that no row names"), "{said}");
    assert!(said.ends_with("; without 2 pieces that no row names\n"), "{said}");
    assert_eq!(restore(&Folder::new(&copy), &again, &mut untold).unwrap().unknown, 1);
}

/// The power failed between the record and its row: the next start ends the run as ERROR, with another record.
#[test]
fn a_record_that_came_to_no_row_is_no_fault() {
    let mut made = Made::new();
    let run = made.run(&Run::of("S1", End::Open));
    let left = serde_json::json!({ "schema": 1, "run": { "id": run }, "attachments": [] }).to_string();
    made.folder().blobs().put(left.as_bytes()).unwrap();
    is_sound(&made.folder());
    recover(&mut made.store).unwrap();
    is_sound(&made.folder());
    let place = tempfile::tempdir().unwrap();
    assert_eq!(backup(&made.folder(), &place.path().join("copy"), &mut untold).unwrap().unknown, 0);
}

/// Stores a record of `run` that says PASS and that no row names; returns its file.
fn left_pass(folder: &Folder, run: &str) -> PathBuf {
    let conclusion = json!({ "verdict": "PASS" });
    let left = json!({ "schema": 1, "run": { "id": run }, "conclusion": conclusion, "attachments": [] });
    folder.blobs().path(&folder.blobs().put(left.to_string().as_bytes()).unwrap())
}

/// It is known then what was shown: the ERROR.
#[test]
fn a_record_whose_run_was_saved_too_late_contradicts_nothing() {
    let mut made = Made::new();
    let run = made.run(&Run::of("S1", End::Open));
    let folder = made.folder();
    left_pass(&folder, &run);
    let told = || check(&folder, &mut untold).unwrap().superseded.len();
    assert_eq!(told(), 1, "the control");
    let (_folder, store) = made.parts();
    recover_run(&SharedStore::new(store), &run).unwrap();
    assert_eq!(told(), 0);
}

#[test]
fn a_record_that_is_damaged_says_nothing_of_its_run() {
    let mut made = Made::new();
    let run = made.run(&Run::of("S1", End::Open));
    let left = left_pass(&made.folder(), &run);
    let told = || check(&made.folder(), &mut untold).unwrap().superseded.len();
    assert_eq!(told(), 1, "the control");
    fs::write(&left, [fs::read(&left).unwrap(), b" ".to_vec()].concat()).unwrap();
    assert_eq!(told(), 0);
}

/// A copy made while runs were under way is put back after they ended: nothing on the disk tells that from a power cut before the
/// COMMIT.
#[test]
fn a_verdict_whose_run_is_open_or_another_in_the_database_is_told_and_is_no_fault() {
    let mut made = Made::new();
    let runs = [("1", End::Pass), ("2", End::Fail(&["memory"])), ("3", End::Error(RunCause::Link))];
    let runs = runs.map(|(lane, end)| Run { lane: lane.to_owned(), ..Run::of(&format!("S{lane}"), end) });
    let begun = runs.each_ref().map(|run| made.begin(run));
    let place = tempfile::tempdir().unwrap();
    let copy = place.path().join("copy");
    backup(&made.folder(), &copy, &mut untold).unwrap();
    for (run, (head, plan)) in runs.iter().zip(begun) {
        made.finish(run, head, plan);
    }
    let kept =
        "SELECT id || ' ' || record_sha256 || ' ' || verdict FROM run WHERE verdict <> 'ERROR' ORDER BY lane";
    let kept = query(made.as_ref(), kept);
    let notes =
        |said: &str| said.lines().filter(|line| line.starts_with("note: ")).map(str::to_owned).collect();
    let folder = made.closed();
    let (code, said, _) = did(&folder, &["check"]);
    assert_eq!((code, notes(&said)), (0, Vec::<String>::new()), "{said}");
    fs::copy(copy.join("station.db"), folder.path().join("station.db")).unwrap();
    let mut folder = Some(folder);
    for row in ["open", "ERROR"] {
        let data = folder.take().unwrap();
        let (code, said, _) = did(&data, &["check"]);
        let told: Vec<String> = notes(&said);
        assert_eq!((code, told.len()), (0, 2), "{said}");
        for (note, kept) in told.iter().zip(&kept) {
            let [run, record, verdict] = kept.split(' ').collect::<Vec<_>>()[..] else { panic!("{kept}") };
            let begins = format!("note: run {run} is {row} here, and its record {record} says {verdict}: ");
            assert!(note.starts_with(&begins), "{note}");
        }
        let (_, said, _) = did(&data, &["check", "--json"]);
        let said: serde_json::Value = serde_json::from_str(&said).unwrap();
        assert_eq!(said["superseded"][1]["code"], "run-record-superseded", "{said}");
        let mut made = Made::at(data);
        recover(&mut made.store).unwrap();
        folder = Some(made.closed());
    }
}

#[test]
fn a_spool_goes_a_day_after_its_run_was_lost_and_that_of_an_open_run_stays() {
    let mut made = Made::new();
    let open = made.run(&Run::of("S1", End::Open));
    let over = made.run(&Run { lane: "2".to_owned(), ..Run::of("S2", End::Pass) });
    let [old, young, written] = [7, 8, 9].map(|number| id(BEGIN_MS, number));
    let folder = made.folder();
    for (run, hours) in [(&open, 100), (&over, 100), (&old, 25), (&young, 23)] {
        spool(&folder, run, hours * HOUR);
    }
    // Its folder is as old as its first file, but the file was written to later.
    spool(&folder, &written, 25 * HOUR);
    aged(&folder.spool(&written).join("events.jsonl"), HOUR);
    let removed = prune_unnamed(&mut made.store, "engel").unwrap();
    assert_eq!(removed, Unnamed { pieces: 0, spools: 1, bytes: 3 });
    let is_there = |run: &str| folder.spool(run).exists();
    let are_there = || [&open, &over, &old, &young, &written].map(|run| is_there(run));
    assert_eq!(are_there(), [true, true, false, true, true]);
    // The next start closes the open run with what is in its spool, and has no use for the other one's.
    spool(&folder, &old, 25 * HOUR);
    assert_eq!(recover(&mut made.store).unwrap().closed[0].record.attachments[0].name, "events.jsonl");
    assert_eq!(are_there(), [false, false, false, true, true]);
    is_sound(&folder);
}

/// The run finds that its evidence already exists, old enough to be removed, and its row comes later.
#[test]
fn evidence_of_a_run_without_its_row_stays_however_long_it_lay_there() {
    let mut made = Made::new();
    let hash = evidence(&made.folder(), "seen", 100 * HOUR);
    let run = Run { evidence: vec!["seen"], ..Run::of("S1", End::Fail(&["memory"])) };
    let (head, plan) = made.begin(&run);
    made.folder().blobs().put(b"seen").unwrap();
    assert_eq!(prune_unnamed(&mut made.store, "engel").unwrap(), Unnamed::default());
    made.finish(&run, head, plan);
    assert_eq!(query(made.as_ref(), "SELECT sha256 FROM attachment"), [hash]);
    is_sound(&made.folder());
}

/// Runs are recorded while one thread removes what no row names as fast as it can, and another makes all of it look old. What has
/// no row yet is still safe, since only one program at a time has the folder.
#[test]
fn runs_that_are_recorded_meanwhile_lose_nothing() {
    let station = Station::with(PLAN);
    station.run("CAT00000", "mock,fault=stuck-data");
    let (is_over, removals) = (AtomicBool::new(false), AtomicUsize::new(0));
    let go_on = || !is_over.load(Ordering::Relaxed);
    thread::scope(|scope| {
        let _over = Over(&is_over);
        scope.spawn(|| {
            while go_on() {
                let old = SystemTime::now() - 25 * HOUR;
                for path in crate::runs::checked::evidence(&station) {
                    // It may be gone by now.
                    let _ = File::open(path).map(|file| file.set_modified(old));
                }
            }
        });
        let pruning = scope.spawn(|| {
            while go_on() {
                station.store().blobs().put(b"nobody's").unwrap();
                let (code, said, complained) = did(&station.data(), &["prune", "--operator", "weber"]);
                assert!([0, 4].contains(&code), "{complained}");
                removals.fetch_add(usize::from(said.starts_with("1 piece ")), Ordering::Relaxed);
            }
        });
        let mut serials = (1..).map(|number| format!("CAT{number:05}"));
        let mut serial = serials.next().unwrap();
        let mut failed = 0;
        while (failed < 5 || removals.load(Ordering::Relaxed) == 0) && !pruning.is_finished() {
            match station.run(&serial, "mock,fault=stuck-data").code {
                Some(1) => {
                    failed += 1;
                    serial = serials.next().unwrap();
                }
                busy => assert_eq!(busy, Some(4)),
            }
        }
    });
    let checked = station.check();
    assert_eq!(checked.code, Some(0), "{checked:?}");
}

#[test]
fn the_command_says_what_it_removed() {
    let mut made = Made::new();
    made.run(&Run { evidence: vec!["seen"], ..Run::of("S1", End::Fail(&["memory"])) });
    made.run(&Run { started_ms: BEGIN_MS + 25 * HOUR_MS, ..Run::of("S2", End::Pass) });
    evidence(&made.folder(), "nobody's", 25 * HOUR);
    spool(&made.folder(), &id(BEGIN_MS, 7), 25 * HOUR);
    let folder = made.closed();
    let (code, said, _) = did(&folder, &["prune", "--operator", "weber"]);
    let expected = "1 piece and 1 spool that no row names were removed, 11 bytes; every record is kept\n";
    assert_eq!((code, said.as_str()), (0, expected));
    let (code, said, _) = did(&folder, &["prune", "--older-than", "1", "--operator", "weber"]);
    let expected = "1 piece of evidence was removed, 4 bytes; 0 pieces and 0 spools that no row names were removed, 0 bytes; every record is kept\n";
    assert_eq!((code, said.as_str()), (0, expected));
}
