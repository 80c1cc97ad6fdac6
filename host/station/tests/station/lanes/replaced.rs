//! A station at work while one of its files is replaced: its program, as in an upgrade, or a file of its plan.

use std::fs;
use std::process::{Command, Stdio};

use serde_json::Value;

use super::ends::{connected, lane_of};
use super::floor::{Running, SERIALS, Station};
use crate::common::{Did, instead, program, script, silent_board};

/// Starts the station by a program file of its own; returns that file as well.
fn started(station: &Station) -> (Running, std::path::PathBuf) {
    let own = station.path("halfrow-station");
    // A link, since a copy might still be open for writing in a process of another test.
    fs::hard_link(program(), &own).unwrap();
    (station.started(Command::new(&own)), own)
}

#[test]
fn a_station_judges_by_the_program_that_it_is_though_its_file_is_another_one_or_gone() {
    let station = Station::with(&["mock"], "");
    let (mut running, own) = started(&station);
    let mut verdict_of = |serial| {
        running.test("1", serial);
        running.wait("a verdict", |news| news["shown"]["serial"] == serial)["shown"]["verdict"].clone()
    };
    fs::rename(script(&station.path(""), "newer", "exit 2\n"), &own).unwrap();
    assert_eq!(verdict_of(SERIALS[0]), "PASS", "replaced");
    fs::remove_file(&own).unwrap();
    assert_eq!(verdict_of(SERIALS[1]), "PASS", "removed");
    assert_eq!(running.end().0, Some(0));
    station.assert_well();
}

/// `ps` and `top` show whose process it is.
#[test]
fn a_lane_s_process_has_the_program_s_name() {
    let (listener, silent) = silent_board();
    let station = Station::with(&[&silent], "");
    let (mut running, own) = started(&station);
    running.test("1", SERIALS[0]);
    let begun = running.wait("a step", |news| news["news"] == "doing");
    connected(&listener);
    let lane = lane_of(&station, &begun["run"]);
    let read = |name: &str| fs::read_to_string(format!("/proc/{lane}/{name}")).unwrap();
    assert_eq!(read("comm"), "halfrow-station\n");
    assert_eq!(read("cmdline"), format!("{}\0lane\0", own.display()));
}

/// A plan that is changed without a new version: nobody could tell its runs from those before.
#[test]
fn a_start_warns_of_a_plan_that_is_another_one_than_runs_were_judged_by_under_its_version() {
    let station = Station::with(&["mock"], "");
    let mut running = station.start();
    running.scan(SERIALS[0]);
    running.state("1", "PASS");
    running.end();
    let warns = |plan: &str| {
        fs::write(station.path("plan.toml"), plan).unwrap();
        let mut call = Command::new(program());
        let call =
            call.args(["lanes", "--operator", "weber", "--settings"]).arg(station.path("station.toml"));
        let did: Did = call.stdin(Stdio::null()).output().unwrap().into();
        assert_eq!(did.code, Some(0), "{did:?}");
        did.complained.contains("runs were judged here by another plan CAM-T/quick 1")
    };
    let plan = fs::read_to_string(station.path("plan.toml")).unwrap();
    let other = format!("{plan}\n# other\n");
    let newer = other.replace("version = \"1\"", "version = \"2\"");
    assert_eq!([&plan, &other, &newer].map(|plan| warns(plan)), [false, true, false]);
    // By an ERROR nothing was judged.
    station.change("UPDATE run SET verdict = 'ERROR', cause = 'link'");
    assert!(!warns(&other));
}

/// The lane says which file it is, and takes boards again once it is put back.
#[test]
fn a_file_of_the_plan_that_becomes_another_one_at_work_judges_no_board() {
    let station = Station::with(&["mock"], "");
    let picture = |level: u8| {
        let bytes = [b"P5\n64 8\n255\n".as_slice(), &[level; 512]].concat();
        fs::write(station.path("a.pgm"), bytes).unwrap();
    };
    picture(7);
    instead(station.path("plan.toml"), "builtin:noise", "a.pgm");
    let mut running = station.start();
    running.state("1", "READY");
    picture(9);
    running.test("1", SERIALS[0]);
    let said = "the file a.pgm, which the plan names, has changed since the station started; put it back";
    let is_told = |news: &Value| news["note"].as_str().is_some_and(|note| note.contains(said));
    let told = running.wait("why no run begins", is_told);
    assert_eq!((&told["state"], &told["shown"]), (&"READY".into(), &Value::Null), "{told}");
    fs::remove_file(station.path("a.pgm")).unwrap();
    running.test("1", SERIALS[0]);
    running.state("1", "RUNNING");
    running.wait("why no run begins", is_told);
    picture(7);
    running.test("1", SERIALS[0]);
    running.state("1", "PASS");
    assert_eq!(running.end().0, Some(0));
    assert_eq!(station.query("SELECT verdict FROM run"), ["PASS"]);
    station.assert_well();
}
