//! What a run does beside its store.

use std::fs;
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

use halfrow::Verdict;
use halfrow_station::store::{SharedStore, Store};

use super::bench::{PLAN, Station};
use super::killed_lane::run_in;
use crate::common::{held_up, script};
use crate::lanes::floor::HANG;

/// A lane whose log comes to no end.
const ENDLESS_LOG: &str = "read -r job\nlog=$(readlink /proc/$$/fd/2)\nrm \"$log\" && mkfifo \"$log\"\n";

#[test]
fn the_evidence_of_one_run_keeps_no_other_from_the_store() {
    let station = Station::with(PLAN);
    let lane = script(&station.path(""), "endless", ENDLESS_LOG);
    let store = SharedStore::new(Store::open(&station.store()).unwrap());
    let saved = thread::scope(|scope| {
        let run = scope.spawn(|| run_in(&store, &station, "1", "CAT00001", &lane));
        let log = held_up(&spool(&station).join("lane.log"));
        let (other, (told, got)) = (store.clone(), mpsc::channel());
        scope.spawn(move || told.send(other.with(|store| store.open_runs().unwrap().len())));
        let got = got.recv_timeout(HANG);
        drop(log);
        assert_eq!(got, Ok(1), "the store, in which the run is open");
        run.join().unwrap()
    });
    assert_eq!(saved.record.conclusion.verdict, Verdict::Error);
    drop(store);
    assert_eq!(station.check().code, Some(0), "{:?}", station.check());
}

/// What the run of the station writes down.
fn spool(station: &Station) -> std::path::PathBuf {
    let begun = Instant::now();
    loop {
        let run = fs::read_dir(station.data().join("spool")).unwrap().next();
        if let Some(run) = run {
            return run.unwrap().path();
        }
        assert!(begun.elapsed() < HANG, "no run");
        thread::sleep(Duration::from_millis(10));
    }
}
