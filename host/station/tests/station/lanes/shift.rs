//! A good unit and a bad one check a lane before its production counts.

use std::fs;
use std::process::Command;

use halfrow_station::plan::Plan;
use halfrow_station::store::{Checked, Folder, InLane};
use serde_json::Value;

use super::floor::{Running, SERIALS, Station, plan};
use crate::common::{Did, program};

const SHIFT: &str = "[shift]\ngood = \"CA0131103628\"\nbad = \"CA0201134373\"\nhours = 8\n[tables]";

#[test]
fn a_lane_is_out_until_the_good_unit_passed_and_the_bad_one_failed() {
    // One lane is right. In the other the judge finds nothing, or the units were exchanged.
    let station = Station::with(&["mock", "mock,fault=stuck-data"], "");
    fs::write(station.path("plan.toml"), plan().replace("[tables]", SHIFT)).unwrap();
    let [good, bad, product, _] = SERIALS;
    let mut running = station.start();
    let out = running.state("1", "OUT");
    assert!(
        out["note"].as_str().unwrap().contains("the good unit CA0131103628 must be judged PASS first"),
        "{out}"
    );
    for early in [product, bad] {
        running.test("1", early);
        assert!(
            running.answer(early).1.contains("lane 1 is out of service: to check this shift, the good unit")
        );
    }
    running.test("1", good);
    let out = running
        .wait("the bad unit", |news| news["note"].as_str().is_some_and(|note| note.contains("the bad")));
    assert_eq!((&out["state"], &out["shown"]["verdict"]), (&"PASS".into(), &"PASS".into()), "it stays");
    // The good board under the bad one's number passes, which looks like a lane that finds no fault.
    running.test("1", bad);
    running.wait("a bad unit that passed", |news| {
        news["note"].as_str().is_some_and(|note| note.contains("the bad unit CA0201134373 was judged PASS"))
    });
    running.test("1", product);
    assert!(!running.answer(product).0);
    // In the other lane the good unit fails.
    running.test("2", good);
    running.wait("a good unit that failed", |news| {
        news["lane"] == "2" && news["note"].as_str().is_some_and(|note| note.contains("was judged FAIL"))
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
    // The fixture holds one board after another.
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
    station.change("UPDATE run SET started_ms = started_ms - 8 * 3600 * 1000");
    let mut running = station.start();
    let out = running.state("1", "OUT");
    assert!(out["note"].as_str().unwrap().contains("the good unit"), "{out}");
    running.end();
}

/// [`SHIFT`] with the mock instead of the bad unit.
fn with_mock() -> String {
    plan().replace("[tables]", &SHIFT.replace(SERIALS[1], "HR:MOCK"))
}

/// Lets the lane judge the good unit; returns the state after that, in which the mock is due.
fn good_passes(running: &mut Running, lane: &str) -> Value {
    running.test(lane, SERIALS[0]);
    running.wait("the mock", |news| {
        news["lane"] == lane && news["note"].as_str().is_some_and(|note| note.contains("scan HR:MOCK"))
    })
}

/// Lets the lane judge the mock until a fault is drawn that the plan finds, as it does nearly all.
fn mock_fails(running: &mut Running, lane: &str) -> Value {
    loop {
        running.test(lane, "HR:MOCK");
        let (is_taken, said) = running.answer("HR:MOCK");
        assert!(is_taken, "{said}");
        let is_over = |news: &Value| {
            news["lane"] == lane
                && news["last"]["serial"].as_str().is_some_and(|of| of.starts_with("HR:MOCK"))
        };
        let ended = running.wait("a verdict on the mock", is_over);
        assert_eq!(ended["shown"], Value::Null, "the board in the lane was not judged: {ended}");
        if ended["last"]["verdict"] == "FAIL" {
            assert_eq!(ended["state"], "READY");
            return ended;
        }
    }
}

#[test]
fn the_mock_with_a_drawn_fault_may_be_what_is_known_to_be_bad() {
    let station = Station::with(&["mock", "mock"], "");
    fs::write(station.path("plan.toml"), with_mock()).unwrap();
    let product = SERIALS[2];
    let mut running = station.start();
    running.test("1", "HR:MOCK");
    assert!(running.answer("HR:MOCK").1.contains("the good unit"), "the good one is first");
    for lane in ["1", "2"] {
        assert_eq!(good_passes(&mut running, lane)["state"], "PASS");
    }
    running.test("1", product);
    assert!(running.answer(product).1.contains("with a random fault must be judged FAIL first"));
    let failed = mock_fails(&mut running, "1");
    assert_eq!(failed["last"]["serial"], "HR:MOCK:1");
    running.test("1", "HR:MOCK");
    assert!(running.answer("HR:MOCK").1.contains("no check by a mock board now"));
    running.test("1", product);
    running.state("1", "PASS");
    // This does not check the other lane.
    running.test("2", SERIALS[3]);
    assert!(!running.answer(SERIALS[3]).0);
    running.end();
    let mocks = "FROM run JOIN unit ON unit.id = unit_id WHERE serial = 'HR:MOCK:1'";
    let targets = station.query(&format!("SELECT target {mocks}"));
    assert!(
        !targets.is_empty() && targets.iter().all(|target| target.starts_with("mock,fault=")),
        "{targets:?}"
    );
    assert_eq!(station.query(&format!("SELECT sum(nth) {mocks}")), ["0"], "it is no judgement of a unit");
    assert_eq!(station.query(&format!("SELECT count(device) {mocks}")), ["0"], "it is bound to nothing");
    assert_eq!(station.query("SELECT sum(runs) FROM day_count"), ["1"], "the product alone");
    assert_eq!(station.query("SELECT count(*) FROM failure"), ["0"]);
    // Part of a day is counted by another statement than a whole day.
    let began: i64 = station.query("SELECT min(started_ms) FROM run")[0].parse().unwrap();
    let [from, until] = [began - 1, began + 3_600_000]
        .map(|moment| jiff::Timestamp::from_millisecond(moment).unwrap().to_string());
    let mut call = Command::new(program());
    let call = call.args(["yield", "--json", "--from", &from, "--until", &until, "--data"]);
    let did: Did = call.arg(station.path("data")).output().unwrap().into();
    let yielded: Value = serde_json::from_str(&did.said).unwrap();
    assert_eq!(yielded["lines"][0]["errors"]["of"], 1, "{yielded}");
    station.assert_well();
}

/// Judges this in lane 1 by the command `run`.
fn run(station: &Station, what: &[&str]) -> Did {
    let mut call = Command::new(program());
    let call = call.arg("run").args(what).args(["--station", "12", "--data"]).arg(station.path("data"));
    call.arg("--plan").arg(station.path("plan.toml")).output().unwrap().into()
}

fn run_mock(station: &Station) -> Did {
    run(station, &["--mock"])
}

/// No fault is known that the frames of this plan do not find, so the test itself changes the verdict.
#[test]
fn a_drawn_fault_that_the_plan_does_not_find_keeps_the_lane_out() {
    let station = Station::with(&["mock"], "");
    fs::write(station.path("plan.toml"), with_mock()).unwrap();
    let did = run_mock(&station);
    assert_eq!(did.code, Some(1), "{did:?}");
    // There is no board to be set aside.
    assert!(did.said.contains("\nas it should be: ") && !did.said.contains("aside"), "{did:?}");
    station.change("UPDATE run SET verdict = 'PASS', cause = 'none', exit_code = 0");
    let target = station.query("SELECT target FROM run")[0].clone();
    let mut running = station.start();
    running.test("1", SERIALS[0]);
    let said = format!("{target} was judged PASS, so the plan does not find this fault");
    let wants = |news: &Value| news["note"].as_str().is_some_and(|note| note.contains(&said));
    assert_eq!(running.wait("a mock that passed", wants)["state"], "PASS");
    running.test("1", SERIALS[2]);
    assert!(!running.answer(SERIALS[2]).0);
    mock_fails(&mut running, "1");
    running.test("1", SERIALS[2]);
    running.state("1", "PASS");
    running.end();
}

/// What the plan demands of boards, their clocks and their links is not demanded of the mock.
#[test]
fn a_plan_for_hardware_judges_the_mock_by_its_frames_alone() {
    let station = Station::with(&["mock"], "");
    let hardware = with_mock()
        .replace("require_hardware = false", "require_hardware = true")
        .replace("00000000", "99bff58a")
        .replace("if-present", "required")
        .replace("[[step]]", "[[step]]\nkind = \"link\"\nseconds = 0.01\n[[step]]");
    let limits = "[limits]\n\"link.together\" = { least = 1e15, unit = \"B/s\", blames = \"station\" }\n\
                  \"latency.clocks\" = { most = 1, blames = \"board\" }\n\
                  \"run.seconds\" = { most = 1e-9, blames = \"station\" }\n";
    fs::write(station.path("plan.toml"), format!("{hardware}{limits}")).unwrap();
    let did = run_mock(&station);
    assert_eq!(did.code, Some(1), "{did:?}");
    for said in ["HR:MOCK:1", "counts as no production", ", which is in no yield\n"] {
        assert!(did.said.contains(said), "{said}: {did:?}");
    }
    fs::write(station.path("plan.toml"), plan()).unwrap();
    let did = run_mock(&station);
    assert_eq!(did.code, Some(2), "{did:?}");
    assert!(did.complained.contains("no mock board checks the shifts of this plan"), "{did:?}");
}

/// The second lane shows that the station has checked its lanes meanwhile.
#[test]
fn a_checked_lane_asks_its_store_after_its_runs_alone() {
    let station = Station::with(&["mock"], "");
    let port = station.path("port");
    let other =
        format!("[[lane]]\nname = \"2\"\nboard = \"serial:{}\"\nplans = [\"other.toml\"]\n", port.display());
    let settings = fs::read_to_string(station.path("station.toml")).unwrap();
    fs::write(station.path("station.toml"), settings + &other).unwrap();
    fs::write(station.path("plan.toml"), with_mock()).unwrap();
    fs::write(station.path("other.toml"), plan().replace("CAM-T", "CAM-U")).unwrap();
    let mut running = station.start();
    good_passes(&mut running, "1");
    mock_fails(&mut running, "1");
    let [database, aside] = ["data/station.db", "data/aside.db"].map(|name| station.path(name));
    fs::rename(&database, &aside).unwrap();
    for round in 0..3 {
        let state = if round % 2 == 0 { "READY" } else { "EMPTY" };
        if round % 2 == 0 {
            fs::write(&port, "").unwrap();
        } else {
            fs::remove_file(&port).unwrap();
        }
        running.state("2", state);
    }
    fs::rename(&aside, &database).unwrap();
    running.test("1", SERIALS[2]);
    let passed = running.state("1", "PASS");
    assert_eq!(passed["shown"]["serial"], SERIALS[2]);
    let (_, heard) = running.end();
    let outs = heard.iter().filter(|news| news["state"] == "OUT").filter_map(|news| news["note"].as_str());
    let blind: Vec<_> = outs.filter(|note| note.contains("database")).collect();
    assert!(blind.is_empty(), "{blind:?}");
}

/// Each of them has its turn, and one whose plan asks for no check is not asked about at all.
#[test]
fn lanes_go_on_beside_those_about_which_their_store_fails() {
    let lanes = "[[lane]]\nname = \"5\"\nboard = \"mock\"\nplans = [\"other.toml\"]\n";
    let station = Station::with(&["mock"; 4], lanes);
    fs::write(station.path("plan.toml"), with_mock()).unwrap();
    fs::write(station.path("other.toml"), plan().replace("CAM-T", "CAM-U")).unwrap();
    let mut running = station.start();
    ["1", "2"].iter().for_each(|lane| drop(good_passes(&mut running, lane)));
    running.end();
    station.change("UPDATE run SET target = CAST(x'ff' AS TEXT)");
    let mut running = station.start();
    let mut note = |lane: &str, wanted: &str| {
        running.wait(wanted, |news| {
            news["lane"] == lane && news["note"].as_str().is_some_and(|note| note.contains(wanted))
        })
    };
    note("1", "station.db");
    ["3", "4"].iter().for_each(|lane| drop(note(lane, "the good unit")));
    good_passes(&mut running, "3");
    let (_, heard) = running.end();
    let out = |lane: &str| heard.iter().any(|news| news["lane"] == lane && news["state"] == "OUT");
    assert_eq!(["1", "2", "5"].map(out), [true, true, false]);
}

/// A station whose lane was checked at `started_ms`, an SQL expression, according to its database.
fn checked_at(started_ms: &str) -> Station {
    let station = Station::with(&["mock"], "");
    fs::write(station.path("plan.toml"), with_mock()).unwrap();
    let mut running = station.start();
    good_passes(&mut running, "1");
    mock_fails(&mut running, "1");
    running.end();
    station.change(&format!("UPDATE run SET started_ms = {started_ms}"));
    station
}

#[test]
fn what_failed_before_the_good_unit_passed_checks_no_shift() {
    let station = checked_at("started_ms");
    // The fixture breaks, and is repaired.
    for (board, code) in [("mock,fault=stuck-data", 1), ("mock", 0)] {
        let did = run(&station, &["--board", board, "--serial", SERIALS[0]]);
        assert_eq!(did.code, Some(code), "{did:?}");
    }
    let mut running = station.start();
    running.test("1", SERIALS[2]);
    let (is_taken, said) = running.answer(SERIALS[2]);
    assert!(
        !is_taken && said.contains("the mock board with a random fault must be judged FAIL first"),
        "{said}"
    );
    mock_fails(&mut running, "1");
    running.test("1", SERIALS[2]);
    running.state("1", "PASS");
    running.end();
    station.assert_well();
}

/// The clock was wrong then, or is now.
#[test]
fn what_is_dated_tomorrow_checks_no_shift() {
    let station = checked_at("started_ms + 86400000");
    let mut running = station.start();
    running.test("1", SERIALS[2]);
    let (is_taken, said) = running.answer(SERIALS[2]);
    assert!(!is_taken && said.contains("good unit"), "{said}");
    running.end();
}

/// The clock goes on, or is set right, while the station is at work.
#[test]
fn what_was_dated_ahead_checks_its_lane_from_the_moment_on_that_is_told() {
    let station = checked_at("started_ms + 1000000");
    let plan = Plan::load(&station.path("plan.toml")).unwrap();
    let (folder, place) = (Folder::new(&station.path("data")), InLane::of("12", "1", &plan));
    let owed = |now_ms| {
        let Checked { owed, until_ms } = folder.owed(&place, now_ms).unwrap();
        (owed.map(|owed| owed.why.to_string()), until_ms)
    };
    let mut now_ms = station.query("SELECT min(started_ms) FROM run")[0].parse::<i64>().unwrap() - 1_000_000;
    let mut before = owed(now_ms);
    assert!(before.0.as_ref().is_some_and(|why| why.contains("good unit")), "{before:?}");
    while before.0.is_some() {
        assert_eq!(owed(before.1), before, "up to then");
        now_ms = before.1.saturating_add(1);
        let next = owed(now_ms);
        assert!(next != before && next.1 > before.1, "{next:?} behind {before:?}");
        before = next;
    }
    let last: i64 = station.query("SELECT max(started_ms) FROM run")[0].parse().unwrap();
    assert!(now_ms <= last, "it counts as soon as it is not dated too far ahead any more");
}

#[test]
fn a_lane_is_out_as_soon_as_the_hours_of_its_shift_end() {
    // Eight hours have passed, except for some seconds.
    let station = checked_at("(unixepoch() - 8 * 3600 + 6) * 1000");
    let mut running = station.start();
    let out = running.state("1", "OUT");
    assert!(out["note"].as_str().unwrap().contains("the good unit"), "{out}");
    running.test("1", SERIALS[2]);
    assert!(!running.answer(SERIALS[2]).0);
    running.end();
}

/// A check of a lane is no check of another lane, station or plan.
#[test]
fn a_check_is_of_one_lane_and_of_one_plan() {
    let station = checked_at("started_ms");
    let path = station.path("plan.toml");
    let ours = Plan::load(&path).unwrap();
    fs::write(&path, with_mock().replace("version = \"1\"", "version = \"2\"")).unwrap();
    let other = Plan::load(&path).unwrap();
    let now_ms = station.query("SELECT max(started_ms) FROM run")[0].parse::<i64>().unwrap() + 1;
    let owed = |name, lane, plan| {
        let place = InLane::of(name, lane, plan);
        Folder::new(&station.path("data")).owed(&place, now_ms).unwrap().owed.map(|owed| owed.serial)
    };
    assert_eq!(owed("12", "1", &ours), None);
    for (name, lane, plan) in [("12", "2", &ours), ("13", "1", &ours), ("12", "1", &other)] {
        assert_eq!(owed(name, lane, plan).as_deref(), Some(SERIALS[0]), "station {name}, lane {lane}");
    }
}
