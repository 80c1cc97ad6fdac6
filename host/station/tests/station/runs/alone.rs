//! What a run does while it does not use its store, and with what it has started.

use std::fs;
use std::process::{Command, Stdio};
use std::sync::mpsc;
use std::thread;

use halfrow::Verdict;
use halfrow_station::store::{SharedStore, Store};

use super::bench::{Did, PLAN, Station, program};
use super::killed_lane::run_in;
use super::unsaved::calls;
use crate::clocks::Clocks;
use crate::common::{held_up, script, silent_board, until_found};
use crate::history::made::{End, Made, Run};
use crate::lanes::floor::HANG;

/// A lane whose log never ends.
const ENDLESS_LOG: &str = "read -r job\nlog=$(readlink /proc/$$/fd/2)\nrm \"$log\" && mkfifo \"$log\"\n";

#[test]
fn a_unit_that_is_being_judged_is_told_by_its_lane_and_not_as_a_full_disk() {
    let mut made = Made::new();
    let in_lane = |lane: &str, serial: &str| Run { lane: lane.to_owned(), ..Run::of(serial, End::Open) };
    made.run(&in_lane("1", "S1"));
    let mut refused = |lane, serial| made.try_begin(&in_lane(lane, serial)).unwrap_err().to_string();
    let expected = "S1 is being judged in lane 1; wait until that run is over";
    assert_eq!(refused("2", "S1"), expected, "the unit");
    assert_eq!(refused("1", "S2"), expected, "the lane");
    made.run(&in_lane("2", "S2"));
}

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

#[test]
fn a_run_ends_no_earlier_than_it_began_though_the_clock_is_set_back() {
    let station = Station::with(PLAN);
    station.run("CAT00017", "mock");
    let clocks = Clocks::in_folder(&station.path(""));
    let mut program = Command::new(program());
    let (board, target) = silent_board();
    program.args(station.run_arguments("CAT00001", &target)).stdout(Stdio::piped()).stderr(Stdio::piped());
    let run = clocks.of(&mut program).spawn().unwrap();
    spool(&station);
    clocks.ahead(-3600, 0);
    drop(board);
    let (_, record, _) = station.saved(&Did::from(run.wait_with_output().unwrap()));
    assert_eq!(record.ended_ms, record.run.started_ms, "{record:?}");
}

/// The spool of the station's run, once it exists.
fn spool(station: &Station) -> std::path::PathBuf {
    let spool = station.data().join("spool");
    until_found("a run", || fs::read_dir(&spool).unwrap().next().ok_or("none")).unwrap().path()
}

/// Its two threads are the last ones that a run starts.
#[test]
fn a_lane_without_a_thread_that_hears_it_or_gives_it_orders_is_killed_and_waited_for() {
    let station = Station::with(PLAN);
    let last = calls(&station, "CAT00001", "clone3").len();
    let trace = station.path("ended");
    for thread in [last - 1, last] {
        let traced = Command::new("strace")
            .args(["-qq", "-e", "trace=clone3,kill,wait4", "-e", "signal=none", "-e"])
            .arg(format!("inject=clone3:error=EAGAIN:when={thread}"))
            .arg("-o")
            .arg(&trace)
            .arg(program())
            .args(station.run_arguments("CAT00002", "mock"))
            .output();
        let did = Did::from(traced.unwrap());
        assert!(did.code == Some(3) && did.said.contains("the lane could not be started"), "{did:?}");
        let trace = fs::read_to_string(&trace).unwrap();
        let (_, behind) = trace.split_once("(INJECTED)").unwrap();
        // Its orders end with the thread that should give them, so it may be gone by itself before.
        assert!(behind.contains("SIGKILL") && behind.contains("[{WIF"), "{trace}");
    }
}
