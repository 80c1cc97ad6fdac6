//! Lanes whose boards labgrid lends, with a script in the place of the program that reaches labgrid; `scripts/labgrid` tests the
//! real ones.

use std::fs;
use std::process::Command;

use halfrow_station::record::Record;
use halfrow_station::store::Folder;
use nix::sys::signal::Signal;

use super::ends::connected;
use super::floor::{HANG, SERIALS, Station};
use super::held::{Board, long_plan};
use crate::common::{program, program_of, signal, silent_board, until_found};

/// Prints what is in `answer`, and keeps a diary of its arguments and of the end of its stdin.
const LENDER: &str = r#"#!/bin/sh
cd "$(dirname "$0")"
echo "$@" >> diary
if [ "$1" = free ]; then echo '"freed"'; exit; fi
[ ! -s answer ] || { cat answer; echo; }
cat > /dev/null
sleep 0.2
echo given back >> diary
"#;

/// A station whose lane 1 is the place cam-1, about which the script prints `answer`.
fn station(answer: &str, more: &str) -> Station {
    let lender = format!("[labgrid]\nprogram = \"./lender\"\ncoordinator = \"bench:20408\"\n{more}");
    let station = Station::with(&["labgrid:cam-1"], &lender);
    program_of(&station.path(""), "lender", LENDER);
    fs::write(station.path("answer"), answer).unwrap();
    station
}

fn diary(station: &Station) -> Vec<String> {
    let diary = fs::read_to_string(station.path("diary")).unwrap_or_default();
    diary.lines().map(str::to_owned).collect()
}

/// Waits until the diary has this many lines.
fn written(station: &Station, lines: usize) -> Vec<String> {
    until_found(&format!("{lines} lines of the diary"), || {
        let diary = diary(station);
        if diary.len() >= lines { Ok(diary) } else { Err(diary) }
    })
}

const FREE: &str = "free --place cam-1 --user halfrow-12.1 --coordinator bench:20408";
const HOLD: &str = "hold --place cam-1 --user halfrow-12.1 --coordinator bench:20408";

#[test]
fn the_board_of_a_place_is_judged_where_labgrid_says_and_the_place_given_back() {
    let station = station(r#"{"held": {"host": "127.0.0.1", "port": 1, "speed": 9600}}"#, "");
    let mut running = station.start();
    running.state("1", "READY");
    for serial in &SERIALS[..2] {
        running.test("1", serial);
        let ended = running.state("1", "ERROR");
        assert_eq!(ended["shown"]["finding"]["code"], "tcp-refused", "{ended}");
    }
    assert_eq!(running.end().0, Some(0));
    assert_eq!(diary(&station), [FREE, HOLD, "given back", HOLD, "given back"]);
    assert_eq!(station.query("SELECT DISTINCT target FROM run"), ["labgrid:cam-1"]);
    station.assert_well();
}

/// The board may be somebody else's for long, and the run is judged by what was done with it.
#[test]
fn the_wait_for_a_place_does_not_count_as_time_of_the_run() {
    let station = station(r#"{"held": {"host": "127.0.0.1", "port": 1, "speed": 9600}}"#, "");
    let late = LENDER.replace("[ ! -s answer ]", "sleep 0.3\n[ ! -s answer ]");
    program_of(&station.path(""), "lender", &late);
    let mut running = station.start();
    running.test("1", SERIALS[0]);
    running.state("1", "ERROR");
    assert_eq!(running.end().0, Some(0));
    let hash = station.query("SELECT record_sha256 FROM run").remove(0);
    let bytes = Folder::new(&station.path("data")).blobs().get(&hash).unwrap();
    let record = Record::parse(&bytes).unwrap();
    let measured = record.measurements.iter().find(|one| one.name == "run.seconds").unwrap();
    let (run, whole) = (measured.value.unwrap(), record.seconds.unwrap());
    assert!(run >= 0.0 && whole - run >= 0.3, "{run} s of {whole} s");
}

/// What the script answers, and the code and the beginning of the sentence that are shown then.
const REFUSALS: [(&str, &str, &str); 8] = [
    (
        r#"{"refused": {"why": "held", "holder": "bench/alice"}}"#,
        "labgrid-place-held",
        "bench/alice has labgrid's place cam-1; wait",
    ),
    (
        r#"{"refused": {"why": "unknown", "known": "cam-2"}}"#,
        "labgrid-place-unknown",
        "labgrid knows no place cam-1; write one of: cam-2",
    ),
    (
        r#"{"refused": {"why": "no-port"}}"#,
        "labgrid-place-without-port",
        "labgrid's place cam-1 has no NetworkSerialPort; give it",
    ),
    (
        r#"{"refused": {"why": "not-acquired", "said": "reserved"}}"#,
        "labgrid-place-not-given",
        "labgrid does not give the place cam-1: reserved; see",
    ),
    (
        r#"{"refused": {"why": "several-ports", "ports": "a, b"}}"#,
        "labgrid-place-with-several-ports",
        "labgrid's place cam-1 has several ports (a, b); call",
    ),
    (
        r#"{"refused": {"why": "port-away"}}"#,
        "labgrid-port-away",
        "the port of labgrid's place cam-1 is not there; look at its exporter",
    ),
    (
        r#"{"refused": {"why": "protocol", "protocol": "rfc2217"}}"#,
        "labgrid-port-not-raw",
        "the port of labgrid's place cam-1 is exported by rfc2217, and",
    ),
    (
        r#"{"refused": {"why": "coordinator-away", "coordinator": "bench:20408"}}"#,
        "labgrid-coordinator-away",
        "labgrid's coordinator bench:20408 does not answer; start it",
    ),
];

#[test]
fn a_place_that_is_not_had_is_an_error_that_says_what_to_do() {
    for (answer, code, sentence) in REFUSALS {
        let station = station(answer, "");
        let mut running = station.start();
        running.test("1", SERIALS[0]);
        let ended = running.state("1", "ERROR");
        let shown = &ended["shown"];
        assert_eq!(shown["finding"]["code"], code, "{ended}");
        assert!(shown["headline"].as_str().unwrap().starts_with(sentence), "{ended}");
        let run = shown["run"].as_str().unwrap();
        assert_eq!(station.query(&format!("SELECT cause FROM run WHERE id = '{run}'")), ["station"]);
    }
}

#[test]
fn what_is_wrong_with_the_program_is_told_by_its_code() {
    let codes = [
        ("#!/bin/sh\necho no labgrid here >&2\nexit 1\n", "", "labgrid-program-failed", "no labgrid here"),
        ("#!/bin/sh\necho nonsense\n", "", "labgrid-program-failed", "nonsense"),
        ("#!/bin/sh\nexec sleep 1000\n", "deadline = 0.3", "labgrid-late", "within 0.3 s"),
        ("", "", "labgrid-program-not-started", "./lender"),
    ];
    for (lender, more, code, said) in codes {
        let station = station("", more);
        fs::remove_file(station.path("lender")).unwrap();
        if !lender.is_empty() {
            program_of(&station.path(""), "lender", lender);
        }
        let mut running = station.start();
        running.test("1", SERIALS[0]);
        let ended = running.state("1", "ERROR");
        assert_eq!(ended["shown"]["finding"]["code"], code, "{ended}");
        assert!(ended["shown"]["headline"].as_str().unwrap().contains(said), "{ended}");
    }
}

#[test]
fn a_station_that_is_killed_gives_the_place_back() {
    let (listener, target) = silent_board();
    let port = target.rsplit(':').next().unwrap();
    let answer = format!(r#"{{"held": {{"host": "127.0.0.1", "port": {port}, "speed": null}}}}"#);
    let station = station(&answer, "");
    let mut running = station.start();
    running.test("1", SERIALS[0]);
    connected(&listener);
    assert_eq!(diary(&station), [FREE, HOLD]);
    signal(running.id(), Signal::SIGKILL);
    assert_eq!(written(&station, 3), [FREE, HOLD, "given back"]);
    drop(running);
    let _again = station.start();
    assert_eq!(written(&station, 4)[3], FREE);
    assert_eq!(station.query("SELECT cause FROM run"), ["crash"]);
}

/// Neither needs it, and what they start would get it, too.
#[test]
fn neither_a_lane_nor_what_has_its_place_is_told_the_plant_s_password() {
    let (listener, target) = silent_board();
    let port = target.rsplit(':').next().unwrap();
    let answer = format!(r#"{{"held": {{"host": "127.0.0.1", "port": {port}}}}}"#);
    let station = station(&answer, "");
    let mut program = Command::new(program());
    program.env("HALFROW_PLANT_PASSWORD", "rosebud-5e1f");
    let mut running = station.started(program);
    running.test("1", SERIALS[0]);
    connected(&listener);
    let children = format!("/proc/{}/task", running.id());
    let children = fs::read_dir(children).unwrap().map(|task| task.unwrap().path().join("children"));
    let children: String = children.filter_map(|task| fs::read_to_string(task).ok()).collect();
    assert!(children.split_whitespace().count() >= 2, "{children}");
    for child in children.split_whitespace() {
        let environment = fs::read(format!("/proc/{child}/environ")).unwrap();
        assert!(!String::from_utf8_lossy(&environment).contains("rosebud"), "{child}");
    }
    running.test("1", "HR:ABORT");
    running.state("1", "ERROR");
}

/// Somebody else may have the board then.
#[test]
fn a_run_ends_when_what_has_its_place_ends() {
    let board = Board::new();
    let port = board.target.rsplit(':').next().unwrap();
    let answer = format!(r#"{{"held": {{"host": "127.0.0.1", "port": {port}}}}}"#);
    let station = station(&answer, "");
    let lender = LENDER.replace("cat > /dev/null", "while [ ! -e gone ]; do sleep 0.1; done\nexit 7");
    program_of(&station.path(""), "lender", &lender);
    fs::write(station.path("plan.toml"), long_plan()).unwrap();
    let mut running = station.start();
    running.test("1", SERIALS[0]);
    board.slowed.recv_timeout(HANG).unwrap();
    fs::write(station.path("gone"), "").unwrap();
    let ended = running.state("1", "ERROR");
    assert_eq!(ended["shown"]["finding"]["code"], "labgrid-place-lost", "{ended}");
    let headline = ended["shown"]["headline"].as_str().unwrap();
    assert!(headline.starts_with("labgrid's place cam-1 is no longer held for this station"), "{ended}");
    assert_eq!(station.query("SELECT cause FROM run"), ["station"]);
}

#[test]
fn a_run_that_waits_for_its_place_can_be_ended() {
    let station = station("", "deadline = 600.0");
    let mut running = station.start();
    running.test("1", SERIALS[0]);
    running.wait("the wait", |news| news["what"] == "waiting for the place cam-1");
    running.test("1", "HR:ABORT");
    let ended = running.state("1", "ERROR");
    assert_eq!(ended["shown"]["finding"]["code"], "run-stopped-before", "{ended}");
    assert_eq!(station.query("SELECT cause || exit_code FROM run"), ["operator130"]);
}
