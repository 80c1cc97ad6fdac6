//! A system that has no thread left.

use std::process::Command;

use super::floor::{Running, SERIALS, Station};
use crate::common::program;

/// In each of the station's threads, the sixth start of a thread or a process fails. Only the engine's own thread starts that
/// many: two for each run, for its lane and then for its hooks or its recovery.
fn without_the_sixth(station: &Station) -> Running {
    let mut traced = Command::new("strace");
    // Lanes and hooks are not traced.
    traced.args(["-f", "-b", "execve", "-qq", "-o"]).arg(station.path("calls"));
    traced.args(["-e", "trace=clone3", "-e", "signal=none", "-e", "inject=clone3:error=EAGAIN:when=6"]);
    traced.arg(program());
    let mut running = station.started(traced);
    for serial in &SERIALS[..2] {
        running.scan(serial);
        running.state("1", "PASS");
    }
    running
}

const HOOK: &str = "[[on-pass]]\nprogram = \"true\"\n";

#[test]
fn hooks_that_no_thread_is_there_for_are_told_as_hooks_that_failed() {
    let station = Station::with(&["mock"], HOOK);
    let mut running = without_the_sixth(&station);
    running.scan(SERIALS[2]);
    let news = running.wait("a hook that failed", |news| news["news"] == "hook");
    assert!(news["said"].as_str().unwrap().contains("no thread for it"), "{news}");
    assert_eq!(news["serial"], SERIALS[2], "{news}");
    running.end();
    assert_eq!(station.query("SELECT count(*) FROM run WHERE verdict = 'PASS'"), ["3"]);
    assert_one_failed(&station);
}

/// The station met exactly the failure that strace injected.
fn assert_one_failed(station: &Station) {
    let calls = std::fs::read_to_string(station.path("calls")).unwrap();
    assert_eq!(calls.matches("(INJECTED)").count(), 1, "{calls}");
}

#[test]
fn what_is_not_saved_is_tried_again_though_there_was_no_thread_for_it_once() {
    let station = Station::with(&["mock"], HOOK);
    let mut running = without_the_sixth(&station);
    let full = "CREATE TRIGGER full BEFORE UPDATE ON run BEGIN SELECT RAISE(ABORT, 'full'); END";
    station.change(full);
    running.scan(SERIALS[2]);
    running.state("1", "UNSAVED");
    station.change("DROP TRIGGER full");
    running.state("1", "ERROR");
    running.end();
    assert_one_failed(&station);
    station.assert_well();
}
