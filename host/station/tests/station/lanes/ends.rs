//! Every way in which runs in several lanes can end.

use std::io::{self, Read as _};
use std::net::TcpListener;
use std::thread;
use std::time::Duration;

use halfrow::verdict::StoppedBy;
use halfrow_station::engine::{Engine, LaneState};
use halfrow_station::floor::Word;
use halfrow_station::settings::Settings;
use halfrow_station::store::{Folder, Store};
use nix::sys::signal::Signal;
use serde_json::Value;

use super::floor::{Running, SERIALS, Station};
use crate::common::{accepted, exists, lane_process, program, signal, silent_board, until};

/// Waits until the lane has connected, and keeps the connection.
pub(crate) fn connected(listener: &TcpListener) {
    let mut connection = accepted(listener);
    assert_eq!(connection.read(&mut [0]).unwrap(), 1, "it greets");
    thread::spawn(move || while connection.read(&mut [0; 64]).is_ok_and(|read| read > 0) {});
}

/// The process id of the lane that has this run.
pub(super) fn lane_of(station: &Station, run: &Value) -> u32 {
    lane_process(&station.path("data/spool").join(run.as_str().unwrap())).unwrap()
}

#[test]
fn lanes_judge_at_once_and_every_verdict_has_its_record() {
    let station = Station::with(&["mock,serial=1", "mock,serial=2,fault=stuck-data", "tcp:127.0.0.1:1"], "");
    let mut running = station.start();
    for (lane, serial) in ["1", "2", "3"].into_iter().zip(SERIALS) {
        running.test(lane, serial);
    }
    let (code, heard) = running.end();
    assert_eq!(code, Some(0));
    let last =
        |lane: &str| heard.iter().rfind(|news| news["news"] == "lane" && news["lane"] == lane).unwrap();
    for (lane, verdict) in [("1", "PASS"), ("2", "FAIL"), ("3", "ERROR")] {
        let state = last(lane);
        assert_eq!(
            (&state["state"], &state["shown"]["verdict"]),
            (&verdict.into(), &verdict.into()),
            "{state}"
        );
        let run = state["shown"]["run"].as_str().unwrap();
        let stored =
            format!("SELECT verdict || record_sha256 FROM run WHERE id = '{run}' AND lane = '{lane}'");
        let hash = state["shown"]["record_sha256"].as_str().unwrap();
        assert_eq!(station.query(&stored), [format!("{verdict}{hash}")]);
    }
    let words = |lane: &str| -> Vec<String> {
        let of = heard.iter().filter(|news| news["news"] == "lane" && news["lane"] == lane);
        let mut words: Vec<_> = of.map(|news| news["state"].as_str().unwrap().to_owned()).collect();
        words.dedup();
        words
    };
    // Whether the board was seen before anybody listened is left to chance.
    let from_the_board: Vec<_> = words("1").into_iter().skip_while(|word| word == "EMPTY").collect();
    assert_eq!(from_the_board, ["READY", "RUNNING", "SAVING", "PASS"]);
    station.assert_well();
}

/// No other process has the board of the hung lane, and the lane next to it goes on.
#[test]
fn a_lane_that_hangs_is_killed_and_recorded_and_the_others_do_not_notice() {
    let (listener, target) = silent_board();
    let station = Station::with(&[&target, "mock,serial=1"], "").with_silence(15);
    let mut running = station.start();
    running.test("1", SERIALS[0]);
    connected(&listener);
    let hung = running.wait("a step", |news| news["news"] == "doing")["run"].clone();
    let lane = lane_of(&station, &hung);
    signal(lane, Signal::SIGSTOP);
    running.test("2", SERIALS[1]);
    running.state("2", "PASS");
    let ended = running.state("1", "ERROR");
    assert!(ended["shown"]["headline"].as_str().unwrap().contains("sent nothing for 15 s"), "{ended}");
    assert!(!exists(lane), "it is gone");
    assert_eq!(station.query("SELECT cause FROM run WHERE lane = '1'"), ["crash"]);
    running.test("2", SERIALS[1]);
    running.state("2", "RUNNING");
    running.state("2", "PASS");
    assert_eq!(running.end().0, Some(0));
    station.assert_well();
}

#[test]
fn a_run_is_ended_by_a_barcode() {
    let (listener, target) = silent_board();
    let station = Station::with(&[&target, "mock"], "");
    let mut running = station.start();
    running.test("1", SERIALS[0]);
    connected(&listener);
    running.test("1", "HR:ABORT");
    let ended = running.state("1", "ERROR");
    assert_eq!(station.query("SELECT cause FROM run"), ["operator"], "{ended}");
    running.end();
    station.assert_well();
}

/// Meanwhile the result of the other lane cannot be saved.
#[test]
fn no_board_is_taken_while_the_station_closes() {
    let (listener, target) = silent_board();
    let station = Station::with(&[&target, "mock"], "");
    let settings = Settings::load(&station.path("station.toml")).unwrap();
    let folder = Folder::new(&settings.data);
    let engine = Engine::start(settings, Store::open(&folder).unwrap(), program().to_owned()).unwrap();
    let is_ready = |lane: &LaneState| lane.state == Word::Ready;
    until("lanes that are ready", || engine.lanes().iter().all(is_ready));
    engine.label(1, Some(0), SERIALS[0], "weber", None);
    let mut board = accepted(&listener);
    let database = rusqlite::Connection::open(folder.database()).unwrap();
    database.execute_batch("BEGIN IMMEDIATE").unwrap();
    thread::scope(|scope| {
        scope.spawn(|| engine.close(Some(StoppedBy::Person)));
        // The lane closes its connection when the station has told it to end.
        let _ = io::copy(&mut board, &mut io::sink());
        engine.scan(2, SERIALS[1], "weber");
        engine.label(3, Some(1), SERIALS[1], "weber", None);
        database.execute_batch("COMMIT").unwrap();
    });
    assert_eq!(station.query("SELECT lane FROM run"), ["1"]);
    station.assert_well();
}

#[test]
fn a_signal_ends_all_runs_in_order() {
    let (listener, target) = silent_board();
    let station = Station::with(&[&target], "");
    let mut running = station.start();
    running.scan(SERIALS[0]);
    connected(&listener);
    signal(running.id(), Signal::SIGTERM);
    running.state("1", "ERROR");
    assert_eq!(running.end().0, Some(143));
    assert_eq!(station.query("SELECT verdict || ' ' || cause FROM run"), ["ERROR station"]);
    station.assert_well();
}

/// As on a computer that is busy with other things, or that was suspended.
#[test]
fn a_station_that_is_kept_waiting_for_seconds_goes_on_working() {
    let station = Station::with(&["mock,serial=1"], "");
    let mut running = station.start();
    running.state("1", "READY");
    let process = running.id();
    signal(process, Signal::SIGSTOP);
    // Longer than the five seconds after which its engine counts as silent.
    thread::sleep(Duration::from_secs(6));
    let before = waits(process);
    signal(process, Signal::SIGCONT);
    until("the station to have looked after its engine", || waits(process) > before + 1);
    test_again(&mut running);
    assert_eq!(running.end().0, Some(0));
}

/// How often the first thread of a process has waited for something.
fn waits(process: u32) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).unwrap();
    let count = status.lines().find_map(|line| line.strip_prefix("voluntary_ctxt_switches:"));
    count.unwrap().trim().parse().unwrap()
}

/// First the evidence of a run cannot be stored, then it can; the program runs all the time.
#[test]
fn what_cannot_be_saved_blocks_its_lane_until_the_disk_is_well() {
    let station = Station::with(&["mock,serial=1", "mock,serial=2"], "");
    let mut running = station.start();
    running.state("1", "READY");
    let blobs = station.path("data/blobs");
    std::fs::remove_dir(&blobs).unwrap();
    std::fs::write(&blobs, "no folder").unwrap();
    running.test("1", SERIALS[0]);
    let unsaved = running.state("1", "UNSAVED");
    assert!(unsaved["shown"].is_null() && unsaved["note"].as_str().unwrap().contains("could not be saved"));
    assert_eq!(station.query("SELECT state FROM run"), ["open"]);
    running.test("1", SERIALS[1]);
    assert!(running.answer(SERIALS[1]).1.contains("is not saved"));
    std::fs::remove_file(&blobs).unwrap();
    std::fs::create_dir(&blobs).unwrap();
    let ended = running.state("1", "ERROR");
    assert!(ended["shown"]["headline"].as_str().unwrap().contains("could not be saved"), "{ended}");
    assert_eq!(station.query("SELECT verdict || ' ' || cause FROM run"), ["ERROR crash"]);
    test_again(&mut running);
    station.assert_well();
}

fn test_again(running: &mut Running) {
    running.test("1", SERIALS[0]);
    running.state("1", "RUNNING");
    running.state("1", "PASS");
}
