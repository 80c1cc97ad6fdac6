//! What the store promises.

use std::process::Command;

use halfrow_station::store::{Store, StoreError};

use super::bench::{PLAN, Station, program};

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

/// The system calls of a run in their order: the log of the database is on the disk before the verdict is said. In the
/// control, where nothing is brought to the disk, the same look finds that it is not.
#[test]
fn the_verdict_is_said_after_the_log_is_on_the_disk() {
    let station = Station::with(PLAN);
    station.run("CAT00001", "mock");
    let trace = station.path("trace");
    let traced = Command::new("strace")
        .args(["-y", "-e", "trace=pwrite64,fdatasync,fsync,write", "-o"])
        .arg(&trace)
        .arg(program())
        .args(station.run_arguments("CAT00002", "mock"))
        .output()
        .unwrap();
    assert!(traced.status.success(), "{traced:?}");
    let lines = std::fs::read_to_string(trace).unwrap();
    let lines: Vec<_> = lines.lines().collect();
    assert!(is_safe(&lines), "{}", lines.join("\n"));
    let unsynced: Vec<_> = lines.iter().copied().filter(|line| !line.contains("sync(")).collect();
    assert!(!is_safe(&unsynced), "the control");
}

/// Whether the last write to the log before the verdict is followed by bringing it to the disk.
fn is_safe(lines: &[&str]) -> bool {
    let said = lines.iter().position(|line| line.starts_with("write(1") && line.contains("PASS")).unwrap();
    let last = |call: &str| {
        lines[..said].iter().rposition(|line| line.starts_with(call) && line.contains("station.db-wal"))
    };
    let synced = last("fdatasync(").max(last("fsync("));
    last("pwrite64(").is_some_and(|written| synced > Some(written))
}
