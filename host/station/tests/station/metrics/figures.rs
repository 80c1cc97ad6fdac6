//! A station's figures while it works.

use std::fs;
use std::path::Path;
use std::process::Command;

use nix::sys::signal::Signal;

use super::text::{Figures, assert_sound, promtool, told};
use crate::common::{self, lane_process, signal, silent_board, until_found};
use crate::lanes::ends::connected;
use crate::pages::station::{PUBLIC, SERIALS, Serving, Station};
use crate::plant::server::Server;

/// The labels of runs in this lane.
fn of_lane(lane: &str) -> String {
    format!("product=\"CAM-T\",plan=\"quick\",lane=\"{lane}\"")
}

pub(super) fn scan(serving: &Serving, lane: &str, serial: &str) {
    let fields = [("text", serial), ("lane", lane), ("counter", "1")];
    let answer = serving.here().post("/scan", &fields).with("accept", "application/json").send();
    assert!(answer.text().contains("\"is_taken\":true"), "{}", answer.text());
}

/// The figures, as soon as this one has this value.
pub(super) fn once(serving: &Serving, name: &str, value: f64) -> Figures {
    until_found(&format!("{name} to be {value}"), || {
        let figures = Figures::of(serving);
        let found = figures.at(name);
        if found == value { Ok(figures) } else { Err(found) }
    })
}

pub(super) fn in_state(serving: &Serving, lane: &str, state: &str) -> Figures {
    once(serving, &format!("halfrow_lane_state{{lane=\"{lane}\",state=\"{state}\"}}"), 1.0)
}

/// Asserts that the figures of a lane agree with the store.
fn agrees(station: &Station, figures: &Figures, lane: &str) {
    for verdict in ["PASS", "FAIL", "ERROR"] {
        let counted = figures.at(&format!("halfrow_runs_total{{{},verdict=\"{verdict}\"}}", of_lane(lane)));
        let kept = format!("SELECT count(*) FROM run WHERE lane = '{lane}' AND verdict = '{verdict}'");
        assert_eq!(station.query(&kept), [counted.to_string()], "{verdict} in lane {lane}");
    }
    let run_ms = station.query(&format!("SELECT ended_ms - started_ms FROM run WHERE lane = '{lane}'"));
    let (counted, run_ms) = (of_lane(lane), run_ms[0].parse::<f64>().unwrap());
    assert_eq!(figures.at(&format!("halfrow_run_seconds_count{{{counted}}}")), 1.0);
    let seconds = figures.at(&format!("halfrow_run_seconds_sum{{{counted}}}"));
    assert!((0.0..=run_ms / 1000.0 + 0.002).contains(&seconds), "{seconds} s of {run_ms} ms");
    assert_eq!(figures.at(&format!("halfrow_lane_kills_total{{lane=\"{lane}\"}}")), 0.0);
}

/// Whoever collects the figures of many stations sends a token to all of them.
#[test]
fn a_station_that_asks_nobody_who_they_are_looks_at_no_token() {
    let station = Station::private(1);
    let serving = station.serve();
    for _ in 0..11 {
        let asked = serving.here().get("/metrics").with("authorization", "Bearer of-another-station");
        assert_eq!(asked.send().status, 200);
    }
    assert_eq!(station.query("SELECT act FROM audit"), Vec::<String>::new());
}

#[test]
fn what_lanes_did_is_counted_and_promtool_finds_nothing_wrong() {
    let station = Station::private(3)
        .where_instead("station.toml", "name = \"12\"", "name = 'line \"A\" \\ 1'")
        .where_instead("station.toml", "mock,serial=2", "mock,serial=2,fault=stuck-data")
        .where_instead("station.toml", "mock,serial=3", "tcp:127.0.0.1:1");
    let serving = station.serve();
    let before = Figures::of(&serving);
    assert_sound(&before);
    assert_eq!(before.shapes().keys().collect::<Vec<_>>(), told("A station").keys().collect::<Vec<_>>());
    assert_eq!(before.at("halfrow_station_info{station=\"line \\\"A\\\" \\\\ 1\"}"), 1.0);
    assert_eq!(before.at(&format!("halfrow_runs_total{{{},verdict=\"FAIL\"}}", of_lane("1"))), 0.0);
    for ((lane, state), serial) in [("1", "pass"), ("2", "fail"), ("3", "error")].into_iter().zip(SERIALS) {
        scan(&serving, lane, serial);
        in_state(&serving, lane, state);
    }
    let figures = Figures::of(&serving);
    assert_sound(&figures);
    ["1", "2", "3"].into_iter().for_each(|lane| agrees(&station, &figures, lane));
    let units = |name: &str, lane: &str| figures.at(&format!("{name}{{{}}}", of_lane(lane)));
    let [judged, passed] = ["halfrow_units_judged", "halfrow_units_first_passed"]
        .map(|name| ["1", "2", "3"].map(|lane| units(name, lane)));
    assert_eq!((judged, passed), ([1.0, 1.0, 0.0], [1.0, 0.0, 0.0]));
    assert_eq!(figures.at("halfrow_commit_seconds_count"), 3.0);
    assert_eq!(figures.at("halfrow_commit_seconds_bucket{le=\"+Inf\"}"), 3.0);
    assert!(figures.at("halfrow_commit_seconds_sum") > 0.0);
    assert_eq!((figures.at("halfrow_engine_well"), figures.at("halfrow_store_readable")), (1.0, 1.0));
    for serial in SERIALS {
        assert!(!figures.text.contains(serial) && !figures.text.contains("weber"), "{}", figures.text);
    }
    // The control: promtool notices a counter without its ending, and a text that it cannot parse.
    for (was, is) in [("halfrow_runs_total", "halfrow_runs"), ("lane=\"1\"", "lane=\"1")] {
        let wrong = promtool(&["check", "metrics"], Path::new("/"), &figures.text.replace(was, is));
        assert_ne!(wrong.code, Some(0), "{wrong:?}");
    }
}

#[test]
fn a_lane_that_was_killed_and_a_result_that_is_not_saved_are_told() {
    let (listener, target) = silent_board();
    let station = Station::private(2)
        .where_instead("station.toml", "data = \"data\"", "data = \"data\"\nsilence = 15")
        .where_instead("station.toml", "mock,serial=1", &target);
    let serving = station.serve();
    scan(&serving, "1", SERIALS[0]);
    connected(&listener);
    let run = station.query("SELECT id FROM run").remove(0);
    let lane = lane_process(&station.path("data/spool").join(run));
    signal(lane.unwrap(), Signal::SIGSTOP);
    let killed = in_state(&serving, "1", "error");
    assert_eq!(killed.at("halfrow_lane_kills_total{lane=\"1\"}"), 1.0);
    assert_eq!(killed.at("halfrow_lane_kills_total{lane=\"2\"}"), 0.0);
    assert_eq!(killed.at("halfrow_unsaved_results"), 0.0);
    // First the evidence of a run cannot be stored, then it can.
    let blobs = station.path("data/blobs");
    let aside = station.path("aside");
    fs::rename(&blobs, &aside).unwrap();
    fs::write(&blobs, "no folder").unwrap();
    scan(&serving, "2", SERIALS[1]);
    let unsaved = in_state(&serving, "2", "unsaved");
    assert_eq!(unsaved.at("halfrow_unsaved_results"), 1.0);
    assert_eq!(unsaved.at("halfrow_lane_awaits_plant{lane=\"2\"}"), 0.0);
    fs::remove_file(&blobs).unwrap();
    fs::rename(&aside, &blobs).unwrap();
    let saved = once(&serving, "halfrow_unsaved_results", 0.0);
    assert_eq!(saved.at("halfrow_commit_seconds_count"), 2.0, "it was saved late");
    // The station tries again every two seconds.
    assert!(saved.at("halfrow_commit_seconds_sum") >= 2.0, "{}", saved.text);
}

/// As on a full disk: neither a run nor a line of the audit can be entered.
#[test]
fn boards_that_are_not_tested_because_of_the_station_are_counted() {
    let station = Station::private(1);
    let serving = station.serve();
    in_state(&serving, "1", "ready");
    assert_eq!(Figures::of(&serving).at("halfrow_refusals_total{reason=\"store\"}"), 0.0);
    let full = "CREATE TRIGGER no_run BEFORE INSERT ON run BEGIN SELECT RAISE(FAIL, 'the disk is full'); END";
    station.change(full);
    scan(&serving, "1", SERIALS[0]);
    once(&serving, "halfrow_refusals_total{reason=\"store\"}", 1.0);
    station.change(common::NO_AUDIT);
    assert_eq!(serving.here().post("/scan", &[("text", SERIALS[0])]).send().status, 503);
    let figures = Figures::of(&serving);
    assert_eq!(figures.at("halfrow_refusals_total{reason=\"store\"}"), 2.0);
    for reason in ["clock", "plan", "plant", "other"] {
        assert_eq!(figures.at(&format!("halfrow_refusals_total{{reason=\"{reason}\"}}")), 0.0, "{reason}");
    }
}

/// Whoever is called at night then checks the plant, not the disk.
#[test]
fn a_verdict_that_waits_for_the_plant_is_told_from_a_result_that_is_not_saved() {
    let mut server = Server::prepared();
    server.kill();
    let web = format!(
        "[web]\nlisten = \"127.0.0.1:0\"\n{}green = \"plant\"\n",
        common::plant_settings(&server.url())
    );
    let station = Station::with(1, &web);
    let serving = station.serve();
    scan(&serving, "1", SERIALS[0]);
    let waits = in_state(&serving, "1", "unsaved");
    let of_lane = "halfrow_lane_awaits_plant{lane=\"1\"}";
    assert_eq!((waits.at(of_lane), waits.at("halfrow_unsaved_results")), (1.0, 0.0));
    server.again();
    assert_eq!(in_state(&serving, "1", "pass").at(of_lane), 0.0);
}

#[test]
fn the_room_on_the_disk_is_told_as_df_counts_it() {
    let station = Station::private(1);
    let figures = Figures::of(&station.serve());
    let mut df = Command::new("df");
    df.args(["--block-size=1", "--output=used,avail"]).arg(station.path("data"));
    let said = String::from_utf8(df.output().unwrap().stdout).unwrap();
    let bytes = said.lines().nth(1).unwrap().split_whitespace().map(|bytes| bytes.parse().unwrap());
    let [used, free]: [f64; 2] = bytes.collect::<Vec<_>>().try_into().unwrap();
    assert_eq!(figures.at("halfrow_store_size_bytes"), used + free);
    // Other programs write to the disk meanwhile.
    let told = figures.at("halfrow_store_free_bytes");
    assert!((told - free).abs() < (used + free) / 10.0, "{told} bytes, not {free}");
}

/// What the lanes do is reported even when nothing can be counted.
#[test]
fn a_store_that_cannot_be_read_is_said_to_be() {
    let station = Station::private(1);
    let serving = station.serve();
    let (there, aside) = (station.path("data/station.db"), station.path("data/aside.db"));
    fs::rename(&there, &aside).unwrap();
    let figures = Figures::of(&serving);
    assert_eq!((figures.at("halfrow_store_readable"), figures.at("halfrow_engine_well")), (0.0, 1.0));
    assert!(!figures.text.contains("halfrow_runs_total{"), "{}", figures.text);
    assert_eq!(figures.at("halfrow_lane_state{lane=\"1\",state=\"out\"}"), 0.0);
    assert_sound(&figures);
    fs::rename(&aside, &there).unwrap();
    assert_eq!(Figures::of(&serving).at("halfrow_store_readable"), 1.0);
}

#[test]
fn a_plant_that_is_away_is_behind_and_says_for_how_long() {
    let plant = common::plant_settings("postgres://nobody@127.0.0.1:1/plant");
    let station = Station::with(1, &format!("[web]\nlisten = \"127.0.0.1:0\"\n{plant}"));
    let serving = station.serve();
    let none = Figures::of(&serving);
    for name in ["entries", "results", "dead_letters", "oldest_seconds"] {
        assert_eq!(none.at(&format!("halfrow_outbox_{name}{{sink=\"plant\"}}")), 0.0, "{name}");
    }
    assert_eq!(none.shapes(), told("A station"), "docs/metrics.md lists what is served");
    scan(&serving, "1", SERIALS[0]);
    in_state(&serving, "1", "pass");
    // The run, and the audit's line about its scan.
    let entries = station.query("SELECT count(*) FROM outbox WHERE done_ms IS NULL").remove(0);
    let behind = once(&serving, "halfrow_outbox_entries{sink=\"plant\"}", entries.parse().unwrap());
    let age = behind.at("halfrow_outbox_oldest_seconds{sink=\"plant\"}");
    let results = behind.at("halfrow_outbox_results{sink=\"plant\"}");
    assert_eq!(results, 1.0, "the run, and not the line of the audit");
    // docs/plant.md: what the settings say if they say nothing.
    assert_eq!(behind.at("halfrow_outbox_results_limit{sink=\"plant\"}"), 10_000.0);
    assert!(entries != "0" && (0.0..60.0).contains(&age) && age > 0.0, "{entries} entries, {age} s");
    assert_sound(&behind);
}

/// Prometheus asks for this format: it has the same figures, read here by the reference implementation, and a machine with a
/// token may ask for it.
#[test]
#[ignore = "for scripts/soak"]
fn openmetrics_is_what_its_reference_reads() {
    let venv = Path::new(env!("CARGO_TARGET_TMPDIR")).join("prometheus-client-0.22.1");
    let python = venv.join("bin/python");
    if !python.exists() {
        assert!(Command::new("python3").args(["-m", "venv"]).arg(&venv).status().unwrap().success());
    }
    let install =
        ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "prometheus-client==0.22.1"];
    assert!(Command::new(&python).args(install).status().unwrap().success());
    let station = Station::private(2);
    let serving = station.serve();
    scan(&serving, "1", SERIALS[0]);
    in_state(&serving, "1", "pass");
    let answer = serving.here().get("/metrics").with("accept", "application/openmetrics-text").send();
    let folder = common::folder();
    let (open, plain) = (folder.path().join("open"), folder.path().join("plain"));
    fs::write(&open, answer.text()).unwrap();
    fs::write(&plain, Figures::of(&serving).text).unwrap();
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/station/metrics/read_openmetrics.py");
    let read = || Command::new(&python).arg(script).arg(&open).arg(&plain).output().unwrap();
    let right = read();
    assert!(right.status.success(), "{}", String::from_utf8_lossy(&right.stderr));
    for (was, is) in [("# EOF\n", ""), ("halfrow_runs_total", "halfrow_runs"), ("le=\"1.0\"", "le=\"1e0\"")] {
        fs::write(&open, answer.text().replace(was, is)).unwrap();
        assert!(!read().status.success(), "the control: {was}");
    }
}

#[test]
fn a_machine_with_a_token_reads_them_in_the_format_that_it_asks_for() {
    let station = Station::public(1);
    let token = String::from_utf8(station.token(&["add", "prometheus", "--scope", "read"]).stdout).unwrap();
    let serving = station.serve();
    let stranger = serving.browser(PUBLIC).get("/metrics").without("cookie");
    assert_eq!(stranger.send().status, 401);
    let ask = |accept: &str| {
        let bearer = format!("Bearer {}", token.trim());
        stranger.clone().with("authorization", &bearer).with("accept", accept).send()
    };
    // The header that Prometheus 2.42 sends.
    let open = ask(
        "application/openmetrics-text;version=1.0.0,application/openmetrics-text;version=0.0.1;q=0.75,text/plain;version=0.0.4;q=0.5,*/*;q=0.1",
    );
    let media_type = "application/openmetrics-text; version=1.0.0; charset=utf-8";
    assert_eq!((open.status, open.header("content-type")), (200, Some(media_type)));
    let text = open.text();
    assert!(text.ends_with("\n# EOF\n") && text.contains("# TYPE halfrow_runs counter\n"), "{text}");
    assert!(
        text.contains("# UNIT halfrow_commit_seconds seconds\n")
            && text.contains("# TYPE halfrow_build info\n")
    );
    let plain = ask("*/*");
    assert_eq!(plain.header("content-type"), Some("text/plain; version=0.0.4; charset=utf-8"));
    assert!(plain.text().contains("# TYPE halfrow_runs_total counter\n") && !plain.text().contains("EOF"));
}

/// It is not the machine that is wrong, so it is told to ask again, however often it asked.
#[test]
fn a_file_of_tokens_that_cannot_be_read_makes_no_token_wrong() {
    let station = Station::public(1);
    let token = String::from_utf8(station.token(&["add", "prometheus", "--scope", "read"]).stdout).unwrap();
    let serving = station.serve();
    let bearer = format!("Bearer {}", token.trim());
    let asked = serving.browser(PUBLIC).get("/metrics").without("cookie").with("authorization", &bearer);
    let file = station.path("tokens.toml");
    let right = fs::read(&file).unwrap();
    fs::write(&file, "no tokens\n").unwrap();
    for _ in 0..12 {
        assert_eq!(asked.send().status, 503);
    }
    fs::write(&file, right).unwrap();
    assert_eq!(asked.send().status, 200);
    let noted = "SELECT act FROM audit WHERE act LIKE 'token%'";
    assert_eq!(station.query(noted), ["token"]);
    // The control.
    assert_eq!(asked.with("authorization", "Bearer 00").send().status, 401);
    assert_eq!(station.query(noted), ["token", "token refused"]);
}
