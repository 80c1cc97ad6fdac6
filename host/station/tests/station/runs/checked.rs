//! `check` finds everything that is not as it was written.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use serde_json::Value;

use super::bench::{Did, PLAN, Station, program};
use crate::common::replaced_by_pipe;

/// A station with a PASS, a FAIL and an ERROR.
fn station() -> Station {
    let station = Station::with(PLAN);
    for (serial, board) in
        [("CAT00001", "mock"), ("CAT00002", "mock,fault=stuck-data"), ("CAT00003", "tcp:127.0.0.1:1")]
    {
        station.run(serial, board);
    }
    let did = station.check();
    assert_eq!(did.code, Some(0), "{did:?}");
    assert!(did.said.contains("3 runs and 8 pieces of evidence were read, 0 faults found"), "{did:?}");
    station
}

/// All files of evidence.
pub(crate) fn evidence(station: &Station) -> Vec<PathBuf> {
    let folders = fs::read_dir(station.data().join("blobs")).unwrap();
    folders
        .flat_map(|folder| fs::read_dir(folder.unwrap().path()).unwrap())
        .map(|file| file.unwrap().path())
        .collect()
}

#[test]
fn a_flipped_bit_in_any_piece_of_evidence_is_found() {
    let station = station();
    let all = evidence(&station);
    // Three records, the messages of two lanes, and the frame of the FAIL in three views.
    assert_eq!(all.len(), 8);
    for path in all {
        let right = fs::read(&path).unwrap();
        for place in [0, right.len() / 2, right.len() - 1] {
            let mut wrong = right.clone();
            wrong[place] ^= 1;
            fs::write(&path, wrong).unwrap();
            let did = station.check();
            assert_eq!(did.code, Some(3), "{did:?}");
            assert!(did.said.contains("holds other bytes than its name says"), "{did:?}");
        }
        fs::remove_file(&path).unwrap();
        assert!(station.check().said.contains("cannot be read"));
        fs::write(&path, right).unwrap();
    }
    assert_eq!(station.check().code, Some(0));
}

/// Nobody may ever write to a pipe.
#[test]
fn a_pipe_in_the_place_of_evidence_is_found_and_nobody_waits_for_it() {
    let station = station();
    let hash = station.query("SELECT record_sha256 FROM run ORDER BY id").remove(0);
    let path = station.store().blobs().path(&hash);
    replaced_by_pipe(&path);
    let (data, to) = (station.data(), station.path("out"));
    for (command, more) in [("check", None), ("backup", Some(&to)), ("export", Some(&to))] {
        let mut call = Command::new("timeout");
        call.arg("120").arg(program()).args([command, "--data"]).arg(&data);
        call.args(more.filter(|_| command == "export").map(|_| "--to")).args(more);
        let did: Did = call.output().unwrap().into();
        assert_eq!(did.code, Some(3), "{command}: {did:?}");
        assert!([did.said, did.complained].concat().contains("cannot be read"), "{command}");
    }
}

/// Changes that the schema allows.
#[test]
fn a_changed_row_is_found_in_every_table() {
    for (change, table) in [
        ("UPDATE plan SET version = '2'", "plan"),
        ("UPDATE unit SET serial = 'CAT99999' WHERE serial = 'CAT00002'", "unit"),
        ("UPDATE run SET verdict = 'PASS', cause = 'none' WHERE verdict = 'FAIL'", "run"),
        ("UPDATE run SET nth = 7 WHERE verdict = 'FAIL'", "run"),
        ("UPDATE step SET outcome = 'passed' WHERE outcome = 'failed'", "step"),
        ("UPDATE measurement SET value = value + 1 WHERE name = 'latency.clocks'", "measurement"),
        ("DELETE FROM suspect WHERE rank = 1", "suspect"),
        ("UPDATE attachment SET bytes = bytes + 1", "attachment"),
        ("UPDATE day_count SET passed = passed + 1", "day_count"),
        ("UPDATE failure SET name = 'x' WHERE kind = 'part'", "failure"),
        ("INSERT INTO unit VALUES ('017f22e2-79b0-7cc3-98c4-dc0c0c07398f', 'CAM-T', 'CAT77777', 1)", "unit"),
    ] {
        let station = station();
        assert!(station.change(change) > 0, "{change}");
        let did = station.check();
        assert_eq!(did.code, Some(3), "{change}: {did:?}");
        assert!(did.said.contains(&format!("fault: table {table}")), "{change}: {did:?}");
    }
}

/// The tables follow from the records, so most of what differs then follows from the one that is lost.
#[test]
fn what_may_only_follow_from_a_record_that_cannot_be_read_is_told_as_that() {
    let station = station();
    let hash = station.query("SELECT record_sha256 FROM run WHERE verdict = 'FAIL'").remove(0);
    let record = station.store().blobs().path(&hash);
    let aside = station.path("aside");
    let lines = |did: &Did| did.said.lines().map(str::to_owned).collect::<Vec<_>>();
    let note = "note: the faults below may all follow from the 1 record that cannot be read; mend it first, and check again";
    fs::rename(&record, &aside).unwrap();
    let did = lines(&station.check());
    assert!(did[0].starts_with("fault: evidence of run ") && did[0].contains("cannot be read"), "{did:?}");
    assert_eq!(did[1], note, "{did:?}");
    assert!(did[2..].iter().filter(|line| line.starts_with("fault: table ")).count() > 10, "{did:?}");
    fs::rename(&aside, &record).unwrap();
    // The control: of these, neither follows from a record.
    let attached = station.query("SELECT sha256 FROM attachment").remove(0);
    fs::remove_file(station.store().blobs().path(&attached)).unwrap();
    station.change("UPDATE day_count SET passed = passed + 1");
    let did = lines(&station.check());
    assert!(did[0].starts_with("fault: evidence of run ") && did[1].starts_with("fault: table "), "{did:?}");
    assert!(!did.iter().any(|line| line.starts_with("note: ")), "{did:?}");
}

/// No record has a waiver; the audit has.
#[test]
fn a_waiver_that_was_changed_moved_or_removed_is_found() {
    let station = station();
    let [passed, failed, _] = &station.query("SELECT id FROM run ORDER BY id")[..] else { panic!() };
    let data = station.data();
    let mut waive = Command::new(program());
    waive.args(["waive", failed, "--reason", "used as it is", "--operator", "engel", "--data"]).arg(&data);
    assert!(waive.output().unwrap().status.success());
    assert_eq!(station.check().code, Some(0), "{:?}", station.check());
    let database = rusqlite::Connection::open(station.store().database()).unwrap();
    let copy = station.path("station.db");
    database.execute("VACUUM INTO ?1", [copy.to_str()]).unwrap();
    drop(database);
    for change in [
        format!("UPDATE waiver SET run_id = '{passed}'"),
        "UPDATE waiver SET reason = 'sound'".to_owned(),
        "UPDATE waiver SET at_ms = at_ms - 1".to_owned(),
        "DELETE FROM waiver".to_owned(),
        "DELETE FROM audit WHERE act = 'waive'".to_owned(),
    ] {
        fs::copy(&copy, station.store().database()).unwrap();
        assert!(station.change(&change) > 0, "{change}");
        let did = station.check();
        assert_eq!(did.code, Some(3), "{change}: {did:?}");
        assert!(did.said.contains(&format!("the waiver of run {failed} is not as the audit")), "{did:?}");
    }
}

/// The index, and the record's own hash, agree with the record.
#[test]
fn a_record_with_another_plan_than_its_hash_is_of_is_found() {
    let station = Station::with(PLAN);
    let (stored, _, mut record) = station.saved(&station.run("CAT00001", "mock"));
    let easier = PLAN.replace("width = 64", "width = 66");
    record["plan"]["text"] = easier.as_str().into();
    let hash = station.store().blobs().put(record.to_string().as_bytes()).unwrap();
    fs::remove_file(station.store().blobs().path(&stored.record_sha256)).unwrap();
    let database = rusqlite::Connection::open(station.store().database()).unwrap();
    database.execute("UPDATE run SET record_sha256 = $1", [hash]).unwrap();
    database.execute("UPDATE plan SET text = $1", [easier]).unwrap();
    let did = station.check();
    assert_eq!(did.code, Some(3), "{did:?}");
    assert!(
        did.said.contains("1 fault found") && did.said.contains("has another hash than it says"),
        "{did:?}"
    );
}

/// Adds a key to every object of a record, except to those whose keys are not the station's.
fn add_key(to: &mut Value) {
    match to {
        Value::Object(members) => {
            let ours =
                members.iter_mut().filter(|(key, _)| !["evidence", "parameters"].contains(&key.as_str()));
            ours.for_each(|(_, value)| add_key(value));
            members.insert("moon".to_owned(), 1.into());
        }
        Value::Array(all) => all.iter_mut().for_each(add_key),
        _ => {}
    }
}

/// Makes this the record of a station's only run.
fn records(station: &Station, record: &Value) -> PathBuf {
    let hash = station.store().blobs().put(format!("{record:#}\n").as_bytes()).unwrap();
    let database = rusqlite::Connection::open(station.store().database()).unwrap();
    assert_eq!(database.execute("UPDATE run SET record_sha256 = $1", [&hash]).unwrap(), 1);
    station.store().blobs().path(&hash)
}

/// After going back to an earlier program, a station has records of a later one.
#[test]
fn a_record_with_keys_that_a_newer_program_added_is_read_and_held_to_its_hash() {
    let station = Station::with(PLAN);
    let did = station.run("CAT00001", "mock,fault=stuck-data");
    let (stored, before, mut record) = station.saved(&did);
    let unnamed = station.store().blobs().path(&stored.record_sha256);
    add_key(&mut record);
    let path = records(&station, &record);
    fs::remove_file(unnamed).unwrap();
    assert_eq!(station.check().code, Some(0), "{:?}", station.check());
    assert_eq!(station.saved(&did).1, before);
    let run = before.run.id.as_str();
    let data = station.data().display().to_string();
    for format in ["record", "junit", "csv", "openhtf"] {
        let export = ["export", run, "--format", format, "--data", &data];
        let output = Command::new(program()).args(export).output().unwrap();
        assert!(output.status.success(), "{format}: {output:?}");
        assert!(format != "record" || output.stdout == fs::read(&path).unwrap(), "the record's very bytes");
    }
    fs::write(&path, fs::read_to_string(&path).unwrap().replacen("\"moon\": 1", "\"moon\": 2", 1)).unwrap();
    let did = station.check();
    assert_eq!(did.code, Some(3), "{did:?}");
    assert!(did.said.contains("holds other bytes than its name says"), "{did:?}");
}

#[test]
fn a_record_of_another_schema_is_refused_by_its_number() {
    let station = Station::with(PLAN);
    let (.., mut record) = station.saved(&station.run("CAT00001", "mock"));
    record["schema"] = 2.into();
    for _ in 0..2 {
        records(&station, &record);
        let did = station.check();
        assert_eq!(did.code, Some(3), "{did:?}");
        assert!(did.said.contains("is of schema 2, and this program reads schema 1"), "{did:?}");
        // It may just as well lack a key that schema 1 has.
        record.as_object_mut().unwrap().remove("device");
    }
}

/// The schema itself refuses what no program may write.
#[test]
fn the_tables_take_no_result_that_cannot_be() {
    let station = station();
    let database = rusqlite::Connection::open(station.store().database()).unwrap();
    database.execute_batch("PRAGMA foreign_keys = ON").unwrap();
    for refused in [
        "UPDATE run SET verdict = NULL",
        "UPDATE run SET verdict = 'GREEN'",
        "UPDATE run SET verdict = 'PASS' WHERE verdict = 'FAIL'",
        "UPDATE run SET record_sha256 = NULL",
        "UPDATE run SET cause = 'none' WHERE verdict = 'ERROR'",
        "UPDATE run SET state = 'open'",
        "UPDATE run SET unit_id = 'nobody'",
        "UPDATE measurement SET value = 'much'",
    ] {
        assert!(database.execute(refused, []).is_err(), "{refused}");
    }
}
