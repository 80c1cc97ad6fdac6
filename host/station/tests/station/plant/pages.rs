//! The plant's pages: what a station's pages show, for all stations, from the other engine.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use halfrow_station::store::{Plant, PlantError};
use halfrow_station::store::{Waiter, Wanted};

use super::sent::{introduction, send};
use super::server::Server;
use crate::common::{Did, engel, now_ms, program, query, reason};
use crate::history::made::Made;
use crate::history::released::history;
use crate::jobs::{board, job, plan, worker};
use crate::pages::station::{Browser, Serving};

/// The pages of the plant, and the folder that they use.
pub(crate) fn served(server: &Server) -> (tempfile::TempDir, Serving) {
    let folder = crate::common::folder();
    let serving = Serving::of(&mut command(&settings(server, folder.path(), "")));
    (folder, serving)
}

/// Settings of the plant's pages in this folder, with `more` after the first lines of `[web]`.
pub(crate) fn settings(server: &Server, folder: &Path, more: &str) -> PathBuf {
    let web = format!("[web]\nlisten = \"127.0.0.1:0\"\n{more}\n");
    let plant = crate::common::plant_settings(&server.url());
    let text = format!("schema = 1\n[station]\nname = \"north\"\ndata = \"data\"\n{web}{plant}");
    let settings = folder.join("plant.toml");
    fs::write(&settings, text).unwrap();
    settings
}

/// The program that serves the plant's pages.
pub(crate) fn command(settings: &Path) -> Command {
    let mut command = Command::new(program());
    command.args(["plant", "serve", "--settings"]).arg(settings);
    command
}

pub(crate) fn text(browser: &Browser, path: &str) -> String {
    let answer = browser.get(path).with("accept", "text/html").send();
    assert_eq!(answer.status, 200, "{path}: {}", answer.text());
    answer.text()
}

/// The yield of one station must not be that of all.
#[test]
fn yields_and_failures_are_of_the_station_that_is_asked_for() {
    let server = Server::prepared();
    let (_made, _) = send(history(), server.address());
    let (_folder, serving) = served(&server);
    let browser = serving.here();
    for (path, counted) in [("/yield", "<table class=\"yields\">"), ("/pareto", "<table class=\"pareto\">")] {
        let page = |station: &str| text(&browser, &format!("{path}?station={station}"));
        let here = page("station+7");
        assert!(here.contains("name=\"station\" value=\"station 7\""), "{path}: {here}");
        assert!(here.contains(counted), "{path}: {here}");
        assert!(!page("station+8").contains(counted), "{path} of a station that judged nothing");
    }
}

/// Everything that other programs read has the same bytes from both engines.
#[test]
fn what_is_exported_has_the_same_bytes_at_the_station_and_at_the_plant() {
    let server = Server::prepared();
    let (made, _) = send(history(), server.address());
    let (_folder, serving) = served(&server);
    let browser = serving.here();
    let runs = query(made.as_ref(), "SELECT id FROM run WHERE state = 'final' ORDER BY id");
    assert_eq!(runs.len(), 7);
    for run in &runs {
        for format in ["record", "junit", "openhtf", "csv"] {
            let theirs = browser.get(&format!("/runs/{run}/export/{format}")).send();
            assert_eq!(theirs.status, 200);
            let ours = exported(&made, &[run], format);
            assert_eq!(theirs.body, ours, "{format} of {run}");
        }
    }
    // The table of all runs, and of those that a filter selects.
    for (filter, arguments) in FILTERS {
        let theirs = text(&browser, &format!("/history.csv{filter}"));
        assert!(theirs.lines().count() > 1, "{filter}: {theirs}");
        let folder = tempfile::tempdir().unwrap();
        let to = folder.path().join("runs.csv");
        exported(&made, &[arguments, &["--to", to.to_str().unwrap()]].concat(), "csv");
        assert_eq!(theirs, fs::read_to_string(to).unwrap(), "{filter}");
    }
    assert_eq!(text(&browser, "/history.csv?station=other").lines().count(), 1);
}

/// Filters of a table, as an address and as the station's program has them.
const FILTERS: [(&str, &[&str]); 6] = [
    ("", &[]),
    ("?lane=2", &["--lane", "2"]),
    ("?verdict=FAIL", &["--verdict", "fail"]),
    ("?plan=final&from=2026-11-02", &["--plan", "final", "--from", "2026-11-02"]),
    ("?station=station+7", &["--station", "station 7"]),
    ("?serial=S1", &["--serial", "S1"]),
];

fn exported(made: &Made, which: &[&str], format: &str) -> Vec<u8> {
    let mut command = Command::new(program());
    command.arg("export").args(which).args(["--format", format, "--data"]).arg(made.folder().path());
    let output = command.output().unwrap();
    assert!(output.status.success(), "{output:?}");
    output.stdout
}

/// What these pages have of the history whose story `released::is_true_of` tells.
const CELLS: [(&str, [&str; 2]); 7] = [
    ("/", ["<a href=\"/history?station=station+7\"><b>station 7</b>", "/history?station=station+8"]),
    (
        "/yield?by=station&lane=1",
        [
            "/history?product=CAM-T&amp;plan=final&amp;station=station+7&amp;lane=1\"><b>station 7</b>",
            ">1/3</span>",
        ],
    ),
    ("/unit?serial=S1", ["<span class=\"verdict pass\"", "Suspected: memory, bit 3."]),
    ("/yield", [">2/4</span>", ">3/4</span>"]),
    ("/yield?by=lane", [">1/3</span>", ">1/1</span>"]),
    ("/pareto", ["<th scope=\"row\">memory</th>", "</svg> 1</td>"]),
    ("/pareto?by=check", ["<th scope=\"row\">latency.clocks</th>", "</svg> 1</td>"]),
];

#[test]
fn the_pages_show_every_station_and_only_look() {
    let server = Server::prepared();
    let (made, _) = send(history(), server.address());
    let mut plant = Plant::connect(&server.address()).unwrap();
    let other = "018f0000-0000-7000-8000-000000000000".to_owned();
    plant.see(&introduction("station 8", other.clone())).unwrap();
    // A second station of the same name is refused, and changes nothing.
    let twin = plant.see(&introduction("station 7", other)).unwrap_err();
    assert!(matches!(&twin, PlantError::OtherStation { name } if name == "station 7"), "{twin:?}");
    let (_folder, serving) = served(&server);
    let browser = serving.here();
    let stations = text(&browser, "/");
    assert!(stations.contains("station 7") && stations.contains("station 8"), "{stations}");
    assert!(stations.contains("CAM-T intake 1") && !stations.contains("○ not heard from"), "{stations}");
    let listed = text(&browser, "/history");
    assert!(listed.contains("S1") && listed.contains("station 7") && !listed.contains("S6"), "{listed}");
    let failed =
        query(made.as_ref(), "SELECT id FROM run WHERE verdict = 'FAIL' AND nth = 1 ORDER BY id").remove(0);
    let run = text(&browser, &format!("/runs/{failed}"));
    assert!(run.contains("memory") && !run.contains("<form class=\"change\""), "{run}");
    for (path, cells) in CELLS {
        let page = text(&browser, path);
        for cell in cells {
            assert!(page.contains(cell), "{path}: {cell}: {page}");
        }
    }
    // What can be done at a station cannot be done here.
    for (method, path) in [("POST", "/scan"), ("POST", "/unit/rebind"), ("GET", "/live"), ("GET", "/outbox")]
    {
        let request = if method == "POST" { browser.post(path, &[]) } else { browser.get(path) };
        assert!([404, 405].contains(&request.send().status), "{method} {path}");
    }
    let waive = browser.post(&format!("/runs/{failed}/waive"), &[("reason", "because")]).send();
    assert!([404, 405].contains(&waive.status), "{waive:?}");
    assert_eq!(server.rows("SELECT count(*) FROM waiver"), [["1"]]);
}

#[test]
fn stations_that_are_silent_are_counted_and_come_first() {
    let server = Server::prepared();
    let mut plant = Plant::connect(&server.address()).unwrap();
    for (name, digit) in [("station 7", 7), ("station 8", 8)] {
        plant.see(&introduction(name, format!("018f0000-0000-7000-8000-00000000000{digit}"))).unwrap();
    }
    let (_folder, serving) = served(&server);
    // In all, 100 s and 121 s.
    for (ms, is_away) in [(100_000, false), (21_000, true)] {
        let silent = format!("UPDATE station SET seen_ms = seen_ms - {ms} WHERE name = 'station 8'");
        server.change(&silent);
        let page = text(&serving.here(), "/");
        let counted = format!("Stations not heard from: {} of 2.", u8::from(is_away));
        assert!(page.contains(&counted) && page.contains("○ not heard from") == is_away, "{ms}: {page}");
        let [seven, eight] = ["7", "8"].map(|name| page.find(&format!("<b>station {name}</b>")).unwrap());
        assert_eq!(eight < seven, is_away, "{page}");
    }
}

#[test]
fn a_version_of_which_runs_were_judged_by_different_plans_is_marked() {
    let server = Server::prepared();
    let (_made, _) = send(history(), server.address());
    let mut plant = Plant::connect(&server.address()).unwrap();
    plant.see(&introduction("station 8", "018f0000-0000-7000-8000-000000000000".to_owned())).unwrap();
    let (_folder, serving) = served(&server);
    // As jobs bring them that were added and have no run.
    let plans = "INSERT INTO plan (sha256, name, version, product, text, first_used_ms)
        SELECT repeat(digit, 64), 'intake', '1', 'CAM-T', '', 0 FROM unnest(ARRAY['0', '1']) AS digit";
    server.change(plans);
    let mark = "CAM-T intake 1 <span class=\"few\">different plans of this version";
    assert!(!text(&serving.here(), "/").contains(mark));
    for (digit, verdict, is_marked) in [('0', "PASS", false), ('1', "ERROR", false), ('1', "FAIL", true)] {
        let judged = format!(
            "UPDATE run SET plan_sha256 = repeat('{digit}', 64)
             WHERE id = (SELECT max(id) FROM run WHERE verdict = '{verdict}')"
        );
        server.change(&judged);
        let page = text(&serving.here(), "/");
        assert_eq!(page.contains(mark), is_marked, "{verdict}: {page}");
    }
}

#[test]
fn the_jobs_and_the_boards_that_are_shared_are_on_a_page_of_their_own() {
    let server = Server::prepared();
    let mut plant = Plant::connect(&server.address()).unwrap();
    let (_folder, serving) = served(&server);
    let browser = serving.here();
    assert!(text(&browser, "/jobs").contains("No board is shared"));
    plant.share(&board(1, "ulx3s"), "engel").unwrap();
    plant.share(&board(2, "<rare>"), "engel").unwrap();
    let (plan, wanted) = (plan(), Wanted::Kind("ulx3s".to_owned()));
    plant.add_jobs(&job(&plan, &wanted), 101).unwrap();
    plant.add_jobs(&job(&plan, &Wanted::Serial("CAT00007".to_owned())), 1).unwrap();
    plant.claim(&worker("north")).unwrap().unwrap();
    plant.take_out("shelf-2", engel(&reason("it smells"))).unwrap();
    plant.wait(&Waiter::new("ulx3s", "weber", "13", now_ms()).unwrap()).unwrap();
    let page = text(&browser, "/jobs");
    for expected in [
        "<td>CAT00007</td>",
        "<div class=\"soft\">engel</div>",
        "CAM-T quick 1",
        "any ulx3s",
        "shelf-1",
        "north 1",
        "it smells",
        "&lt;rare&gt;",
        "13 weber",
    ] {
        assert!(page.contains(expected), "{expected}: {page}");
    }
    assert_eq!(page.matches("any ulx3s").count(), 99, "a hundred are on a page");
    let after = page.split("&amp;after=").nth(1).unwrap().split('"').next().unwrap();
    let older = text(&browser, &format!("/jobs?state=&after={after}"));
    assert_eq!(older.matches("any ulx3s").count(), 2);
    for wrong in ["state=x%26after%3D0%23", "after=x"] {
        assert_eq!(browser.get(&format!("/jobs?{wrong}")).send().status, 400, "{wrong}");
    }
    let claimed = text(&browser, "/jobs?state=claimed");
    assert_eq!(claimed.matches("any ulx3s").count(), 1);
    assert!(text(&browser, "/jobs?state=done").contains("There is no such job"));
}

#[test]
fn a_page_that_is_just_full_leads_no_further_and_a_unit_without_runs_leads_nowhere() {
    let server = Server::prepared();
    let mut plant = Plant::connect(&server.address()).unwrap();
    let (_folder, serving) = served(&server);
    let browser = serving.here();
    plant.add_jobs(&job(&plan(), &Wanted::Serial("CAT00007".to_owned())), 100).unwrap();
    let link = "<a href=\"/unit?serial=CAT00007\">CAT00007</a>";
    let untested = text(&browser, "/jobs");
    assert!(untested.matches("CAT00007").count() == 100 && !untested.contains("after="), "{untested}");
    assert!(!untested.contains(link), "{untested}");
    server.change("INSERT INTO unit (id, product, serial, first_seen_ms) VALUES (gen_random_uuid()::text, 'CAM-T', 'CAT00007', 0)");
    let tested = text(&browser, "/jobs");
    assert!(tested.contains(link), "{tested}");
}

#[test]
fn the_page_of_jobs_begins_with_what_is_not_settled() {
    let server = Server::prepared();
    let mut plant = Plant::connect(&server.address()).unwrap();
    let (_folder, serving) = served(&server);
    let plan = plan();
    let ids = plant.add_jobs(&job(&plan, &Wanted::Kind("ulx3s".to_owned())), 4).unwrap();
    plant.cancel_job(&ids[0], engel(&reason("a mistake"))).unwrap();
    for (id, state) in [(&ids[1], "dead"), (&ids[2], "done")] {
        server.change(&format!("UPDATE job SET state = '{state}', attempts = 1 WHERE id = '{id}'"));
    }
    let lists = |path: &str| {
        let page = text(&serving.here(), path);
        ids.iter().map(|id| page.contains(&format!("title=\"{id}\""))).collect::<Vec<_>>()
    };
    assert_eq!(lists("/jobs"), [false, true, false, true]);
    assert_eq!(lists("/jobs?state=cancelled"), [true, false, false, false]);
    assert_eq!(lists("/jobs?state=dead"), [false, true, false, false]);
    assert_eq!(lists("/jobs?state=all"), [true; 4]);
    let page = text(&serving.here(), "/jobs");
    let counted = [
        "Not settled</a> 2 ",
        "waiting</a> 1 ",
        "being judged</a> 0 ",
        "came to nothing</a> 1 ",
        "cancelled</a> 1 ",
    ];
    for counted in counted {
        assert!(page.contains(counted), "{counted}: {page}");
    }
    assert!(page.find("Shared boards").unwrap() < page.find("Not settled").unwrap(), "{page}");
}

#[test]
fn a_plant_that_is_away_is_said_to_be_and_is_shown_again_when_it_is_back() {
    let mut server = Server::prepared();
    let (_made, _) = send(history(), server.address());
    let (_folder, serving) = served(&server);
    let browser = serving.here();
    text(&browser, "/history");
    server.kill();
    let away = browser.get("/history").with("accept", "text/html").send();
    assert_eq!(away.status, 503, "{}", away.text());
    assert!(away.text().contains("check that it is there"), "{}", away.text());
    let german = browser.get("/history").with("accept", "text/html").with("accept-language", "de").send();
    let german = german.text();
    assert!(german.contains("lehnt ab: eine ") && german.contains("prüfen, ob es da ist"), "{german}");
    server.again();
    text(&browser, "/history");
}

#[test]
fn the_history_of_a_plant_names_the_station_of_each_run() {
    let server = Server::prepared();
    let (made, _) = send(history(), server.address());
    let folder = crate::common::folder();
    let settings = settings(&server, folder.path(), "");
    for (of, path, is_named) in [("--plant", &*settings, true), ("--data", made.as_ref(), false)] {
        let did: Did = Command::new(program()).arg("history").arg(of).arg(path).output().unwrap().into();
        let header: Vec<_> = did.said.lines().next().unwrap().split_whitespace().collect();
        assert_eq!(
            (header.contains(&"station"), did.said.contains("station 7")),
            (is_named, is_named),
            "{did:?}"
        );
    }
}
