//! What the store guarantees.

use std::path::Path;
use std::process::Command;

use halfrow_station::record::Record;
use halfrow_station::store::{Store, StoreError};
use rusqlite::Connection;
use rusqlite::config::DbConfig;

use super::bench::{PLAN, Station, program};
use crate::history::made::{End, Made, Run, record};

#[test]
fn only_one_program_writes() {
    let station = Station::with(PLAN);
    let held = Store::open(&station.store()).unwrap();
    let did = station.run("CAT00001", "mock");
    assert_eq!(did.code, Some(4), "{did:?}");
    assert!(did.complained.contains("another halfrow-station works in"), "{did:?}");
    assert!(matches!(Store::open(&station.store()), Err(StoreError::InUse { .. })));
    drop(held);
    assert_eq!(station.run("CAT00001", "mock").code, Some(0));
}

/// Nobody killed it; a user would look for a crash.
#[test]
fn a_log_that_stayed_because_somebody_read_is_not_blamed_on_a_kill_alone() {
    let station = Station::with(PLAN);
    station.run("CAT00001", "mock");
    let reader = Connection::open(station.data().join("station.db")).unwrap();
    // As those of the program, which only read.
    reader.set_db_config(DbConfig::SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, true).unwrap();
    reader.execute_batch("BEGIN; SELECT count(*) FROM run").unwrap();
    let did = station.run("CAT00002", "mock");
    assert_eq!(did.code, Some(0), "{did:?}");
    drop(reader);
    let did = station.run("CAT00003", "mock");
    assert_eq!(did.code, Some(0), "{did:?}");
    let complained = &did.complained;
    assert!(complained.contains("or ended while another one read station.db"), "{complained}");
}

/// The system calls of a run, in order: the record and its name are on the disk before the database's log mentions it, and the
/// log is on the disk before the verdict is printed. In the controls, one of these is left out, and the same checks notice it.
#[test]
fn the_verdict_is_said_after_record_and_log_are_on_the_disk() {
    let station = Station::with(PLAN);
    station.run("CAT00001", "mock");
    for beginning in 0..=255 {
        // As runs leave them that are killed before they bring the folders' names to the disk.
        std::fs::create_dir_all(station.data().join(format!("blobs/{beginning:02x}"))).unwrap();
    }
    let trace = station.path("trace");
    let traced = Command::new("strace")
        .args(["-y", "-e", "trace=pwrite64,fdatasync,fsync,renameat2,write", "-o"])
        .arg(&trace)
        .arg(program())
        .args(station.run_arguments("CAT00002", "mock"))
        .output()
        .unwrap();
    assert!(traced.status.success(), "{traced:?}");
    let lines = std::fs::read_to_string(trace).unwrap();
    let lines: Vec<_> = lines.lines().collect();
    assert!(is_safe(&lines), "{}", lines.join("\n"));
    let without = |path: &str| {
        let kept = |line: &&str| !(line.contains("sync(") && line.contains(path));
        lines.iter().copied().filter(kept).collect::<Vec<_>>()
    };
    assert!(!is_safe(&without("station.db-wal")), "the control");
    assert!(is_kept(&lines), "{}", lines.join("\n"));
    assert!(!is_kept(&without(".aside>")), "the control");
    assert!(!is_kept(&without("/data/blobs/")), "the control");
    assert!(!is_kept(&without("/data/blobs>")), "the control");
}

/// Whether the record is brought to the disk before it gets its name, and before anything more is written to the log also that name
/// and the name of its folder.
fn is_kept(lines: &[&str]) -> bool {
    let is_renamed = |line: &&str| line.starts_with("renameat2(") && line.contains("/data/blobs/");
    let named = lines.iter().position(is_renamed).unwrap();
    let is_synced = |line: &&str| line.starts_with("fsync(") && line.contains("/data/blobs/");
    let behind = &lines[named..];
    let told = behind.iter().position(|line| line.contains("station.db-wal")).unwrap();
    lines[..named].iter().any(|line| is_synced(line) && line.contains(".aside>"))
        && behind[..told].iter().any(|line| is_synced(line) && !line.contains(".aside>"))
        && behind[..told].iter().any(|line| line.starts_with("fsync(") && line.contains("/data/blobs>"))
}

/// Whether the last write to the log before the verdict is brought to the disk before the verdict.
fn is_safe(lines: &[&str]) -> bool {
    let said = lines.iter().position(|line| line.starts_with("write(1") && line.contains("PASS")).unwrap();
    let last = |call: &str| {
        lines[..said].iter().rposition(|line| line.starts_with(call) && line.contains("station.db-wal"))
    };
    let synced = last("fdatasync(").max(last("fsync("));
    last("pwrite64(").is_some_and(|written| synced > Some(written))
}

/// Makes the database enter a run that ends with these values, whatever it is given.
fn enter_otherwise(database: &Path, values: &str) {
    let otherwise = format!(
        "CREATE TRIGGER otherwise AFTER UPDATE OF state ON run BEGIN
            UPDATE run SET {values} WHERE id = new.id;
        END"
    );
    Connection::open(database).unwrap().execute_batch(&otherwise).unwrap();
}

#[test]
fn a_verdict_that_reads_back_otherwise_is_not_shown() {
    let station = Station::with(PLAN);
    assert_eq!(station.run("CAT00001", "mock").code, Some(0));
    enter_otherwise(&station.store().database(), "verdict = 'FAIL', cause = 'board', exit_code = 1");
    let did = station.run("CAT00002", "mock");
    assert_eq!(did.code, Some(3), "{did:?}");
    assert!(did.said.contains("UNSAVED CAT00002: keep this board apart"), "{did:?}");
    assert!(!did.said.contains("PASS") && !did.said.contains("FAIL"), "{did:?}");
    assert!((did.said + &did.complained).contains("reads back otherwise than it was written"));
}

#[test]
fn a_run_that_got_another_record_of_itself_has_no_verdict() {
    let mut made = Made::new();
    let run = Run::of("S1", End::Pass);
    let (head, plan) = made.begin(&run);
    let other = Record { seconds: Some(9.5), ..record(head.clone(), plan.clone(), &run) };
    let other = made.folder().blobs().put(&other.bytes(2).unwrap()).unwrap();
    enter_otherwise(&made.folder().database(), &format!("record_sha256 = '{other}'"));
    let read = made.try_finish(&run, head, plan);
    assert!(matches!(read, Err(StoreError::ReadsOtherwise { .. })), "{read:?}");
}
