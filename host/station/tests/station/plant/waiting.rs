//! Lanes of a station whose plant is away.

use std::fs;

use halfrow_station::store::{Deed, Folder, Store};

use super::server::Server;
use crate::common::{instead, plant_settings, until, until_found};
use crate::lanes::floor::{SERIALS, Station, plan};

/// A station of this name, with `more` under `[plant]` in its settings.
pub(crate) fn station(server: &Server, name: &str, more: &str) -> Station {
    let station = Station::with(&["mock"], "");
    let path = station.path("station.toml");
    instead(&path, "name = \"12\"", &format!("name = \"{name}\""));
    instead(path, "[[lane]]", &format!("{}{more}\n[[lane]]", plant_settings(&server.url())));
    station
}

/// Waits until the station has nothing more to send.
pub(super) fn await_sent(station: &Station) {
    until_found("an outbox with nothing to send", || {
        let unsent = station.query("SELECT kind || ' ' || subject FROM outbox WHERE done_ms IS NULL");
        if unsent.is_empty() { Ok(()) } else { Err(unsent) }
    });
}

#[test]
fn a_plant_that_is_away_holds_up_only_lines_that_want_it_so() {
    let mut server = Server::prepared();
    server.kill();
    let waits = station(&server, "12", "green = \"plant\"");
    let goes_on = station(&server, "13", "");
    // The control: a station without that line.
    let mut running = goes_on.start();
    running.scan(SERIALS[0]);
    running.state("1", "PASS");
    let mut waiting = waits.start();
    waiting.scan(SERIALS[0]);
    let unsaved = waiting.state("1", "UNSAVED");
    assert!(unsaved["shown"].is_null(), "{unsaved}");
    assert!(unsaved["note"].as_str().unwrap().contains("not at the plant yet"), "{unsaved}");
    // It is saved here, and would not be lost if the station ended meanwhile.
    assert_eq!(waits.query("SELECT verdict FROM run"), ["PASS"]);
    server.again();
    let shown = waiting.state("1", "PASS");
    assert_eq!(shown["shown"]["serial"], SERIALS[0]);
    assert_eq!(waiting.end().0, Some(0));
    assert_eq!(running.end().0, Some(0));
    for station in [&waits, &goes_on] {
        station.assert_well();
    }
    let ours = waits.query("SELECT record_sha256 FROM run").remove(0);
    let theirs = server.rows("SELECT record_sha256 FROM run");
    assert!(theirs.contains(&vec![ours]), "{theirs:?}");
}

#[test]
fn no_more_is_judged_than_may_be_unsent() {
    let mut server = Server::prepared();
    server.kill();
    let station = station(&server, "12", "most_unsent = 1");
    // What people did is sent, too, but is no result.
    let mut store = Store::open(&Folder::new(&station.path("data"))).unwrap();
    for _ in 0..5 {
        store.note(Deed { operator: "weber", act: "login", subject: "", detail: "" }).unwrap();
    }
    drop(store);
    let mut running = station.start();
    for serial in &SERIALS[..2] {
        running.scan(serial);
        running.state("1", "PASS");
    }
    running.scan(SERIALS[2]);
    let (is_taken, said) = running.answer(SERIALS[2]);
    assert!(
        !is_taken && said.contains("2 results are not at the plant yet, and at most 1 may wait"),
        "{said}"
    );
    assert_eq!(station.query("SELECT count(*) FROM run"), ["2"]);
    // The plant is back, and gets what waits before another scan would be refused.
    server.again();
    until("two runs at the plant", || server.rows("SELECT id FROM run").len() >= 2);
    // The station learns of it a moment later.
    await_sent(&station);
    running.scan(SERIALS[2]);
    running.state("1", "PASS");
    assert_eq!(running.end().0, Some(0));
}

#[test]
fn nothing_is_judged_beside_unsent_results_on_a_full_disk() {
    let mut server = Server::prepared();
    server.kill();
    let station = station(&server, "12", "");
    // Any disk with the program on it is that full.
    instead(station.path("station.toml"), "most_filled = 100", "most_filled = 1");
    let mut running = station.start();
    running.scan(SERIALS[0]);
    running.state("1", "PASS");
    running.scan(SERIALS[1]);
    let (is_taken, said) = running.answer(SERIALS[1]);
    assert!(!is_taken && said.starts_with("the disk is "), "{said}");
    assert_eq!(station.query("SELECT count(*) FROM run"), ["1"]);
    // Nothing waits now.
    server.again();
    await_sent(&station);
    running.scan(SERIALS[1]);
    running.state("1", "PASS");
    assert_eq!(running.end().0, Some(0));
}

/// A person has to act then, and no time that passes helps.
#[test]
fn a_lane_that_waits_for_a_plant_says_why_the_plant_never_takes_its_result() {
    let server = Server::prepared();
    server.never_holds("run");
    let waits = station(&server, "12", "green = \"plant\"");
    let mut running = waits.start();
    running.scan(SERIALS[0]);
    let unsaved = running.state("1", "UNSAVED");
    assert!(unsaved["note"].as_str().unwrap().contains("no such character"), "{unsaved}");
    assert_eq!(running.end().0, Some(0));
}

/// A station that is started again does not know which board was kept apart.
#[test]
fn a_board_that_passed_is_kept_apart_until_the_plant_has_that() {
    let mut server = Server::prepared();
    server.kill();
    let stations = [("12", "refuse"), ("13", "ask")].map(|(name, again)| {
        let station = station(&server, name, "green = \"plant\"");
        let plan = plan().replace("device = ", &format!("again = \"{again}\"\ndevice = "));
        fs::write(station.path("plan.toml"), plan).unwrap();
        let mut running = station.start();
        running.scan(SERIALS[0]);
        running.state("1", "UNSAVED");
        assert_eq!(running.end().0, Some(0));
        let mut running = station.start();
        // Nor does it help to scan it once more.
        for _ in 0..2 {
            running.scan(SERIALS[0]);
            let (is_taken, said) = running.answer(SERIALS[0]);
            assert!(!is_taken && said.contains("the plant does not have that result yet"), "{said}");
            assert!(said.contains("; keep this board apart"), "{said}");
        }
        (station, running)
    });
    server.again();
    let then = ["put it with the boards that passed", "scan it once more to test it again"];
    for ((station, mut running), then) in stations.into_iter().zip(then) {
        await_sent(&station);
        running.scan(SERIALS[0]);
        let (is_taken, said) = running.answer(SERIALS[0]);
        assert!(!is_taken && said.ends_with(then), "{said}");
        assert_eq!(running.end().0, Some(0));
        assert_eq!(station.query("SELECT count(*) FROM run"), ["1"]);
    }
}
