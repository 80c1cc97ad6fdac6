//! A unit that is known to be good and one that is known to be bad check a lane before its production counts.

use std::fs;

use super::floor::{SERIALS, Station, plan};

const SHIFT: &str = "[shift]\ngood = \"CA0131103628\"\nbad = \"CA0201134373\"\nhours = 8\n[tables]";

#[test]
fn a_lane_is_out_until_the_good_unit_passed_and_the_bad_one_failed() {
    // One lane is right; in the other the judge finds nothing, or the units were exchanged.
    let station = Station::with(&["mock", "mock,fault=stuck-data"], "");
    fs::write(station.path("plan.toml"), plan().replace("[tables]", SHIFT)).unwrap();
    let [good, bad, product, _] = SERIALS;
    let mut running = station.start();
    let out = running.state("1", "OUT");
    assert!(
        out["note"].as_str().unwrap().contains("the good unit CA0131103628 is to come to PASS first"),
        "{out}"
    );
    for early in [product, bad] {
        running.test("1", early);
        assert!(running.answer(early).1.contains("lane 1 is out of service: the good unit"));
    }
    running.test("1", good);
    let out = running
        .wait("the bad unit", |news| news["note"].as_str().is_some_and(|note| note.contains("the bad")));
    assert_eq!((&out["state"], &out["shown"]["verdict"]), (&"OUT".into(), &"PASS".into()));
    // The good board under the bad one's number passes, so the lane finds nothing.
    running.test("1", bad);
    running.wait("a bad unit that passed", |news| {
        news["note"].as_str().is_some_and(|note| note.contains("the bad unit CA0201134373 came to PASS"))
    });
    running.test("1", product);
    assert!(!running.answer(product).0);
    // In the other lane the good unit fails.
    running.test("2", good);
    running.wait("a good unit that failed", |news| {
        news["lane"] == "2" && news["note"].as_str().is_some_and(|note| note.contains("came to FAIL"))
    });
    running.end();
    station.assert_well();
}

#[test]
fn a_checked_lane_takes_products_until_the_check_is_over() {
    let station = Station::with(&["mock"], "");
    let plan = plan().replace("[tables]", SHIFT);
    fs::write(station.path("plan.toml"), &plan).unwrap();
    let settings = fs::read_to_string(station.path("station.toml")).unwrap();
    let board = |board: &str| {
        fs::write(station.path("station.toml"), settings.replace("\"mock\"", &format!("\"{board}\"")))
            .unwrap();
    };
    // The fixture holds one board after the other.
    for (name, serial) in [("mock", SERIALS[0]), ("mock,fault=stuck-data", SERIALS[1])] {
        board(name);
        let mut running = station.start();
        running.scan(serial);
        running.end();
    }
    board("mock");
    let mut running = station.start();
    running.state("1", "READY");
    running.scan(SERIALS[2]);
    running.state("1", "PASS");
    running.end();
    let database = rusqlite::Connection::open(station.path("data/station.db")).unwrap();
    database.execute("UPDATE run SET started_ms = started_ms - 8 * 3600 * 1000", []).unwrap();
    drop(database);
    let mut running = station.start();
    let out = running.state("1", "OUT");
    assert!(out["note"].as_str().unwrap().contains("the good unit"), "{out}");
    running.end();
}
