//! `plant check` finds everything that is not as it was sent.

use std::path::Path;
use std::process::Command;

use halfrow_station::check::check_plant;
use halfrow_station::store::{Plant, PlantAddress, Snapshot};
use serde_json::Value;

use super::late::{drawn, parcels, shuffled};
use super::mismatch::{found, two};
use super::pages::settings;
use super::sent::{send, send_as};
use super::server::Server;
use crate::clocks::Clocks;
use crate::common::{Did, program};
use crate::history::generated::Draw;
use crate::history::made::{BEGIN_MS, DAY_MS, Run};
use crate::history::released::history;
use crate::jobs::claims::late;

/// A plant with a job that got two runs, the history of a station, late runs of three others, and conflicting bindings of two.
fn plant() -> Server {
    let (server, judged) = late(true);
    assert_eq!(judged, [["0"], ["1"]], "one run is superseded");
    send(history(), server.address());
    // In addition to those of the history, which began at the same moments.
    let runs: Vec<_> = drawn(&mut Draw(3));
    let runs: Vec<_> = runs.into_iter().map(|run| Run { started_ms: run.started_ms + 7, ..run }).collect();
    let parcels = parcels(&runs);
    let mut to = Plant::connect(&server.address()).unwrap();
    for place in shuffled(&parcels, &mut Draw(4)) {
        to.take(&parcels[place]).unwrap();
    }
    for (made, name) in two().into_iter().zip(["station 7b", "station 8"]) {
        send_as(name, made, server.address());
    }
    assert_eq!(found(&server).len(), 2);
    server
}

/// The faults of the server's database `name`, as sentences.
pub(crate) fn faults(server: &Server, name: &str) -> Vec<String> {
    let url = server.url().replace("/plant", &format!("/{name}"));
    let plant = Plant::connect(&PlantAddress::new(&url, None, None).unwrap()).unwrap();
    let mut read = 0;
    let checked =
        check_plant(&Snapshot::of_plant(plant).unwrap(), &mut |progress| read = progress.done).unwrap();
    assert_eq!(read, checked.runs);
    checked.faults.iter().map(ToString::to_string).collect()
}

/// The faults of a copy of the plant after `change`.
fn spoilt(server: &Server, change: &str) -> Vec<String> {
    let copy = "CREATE DATABASE spoilt TEMPLATE plant";
    let mut client = server.client("postgres");
    client.batch_execute("DROP DATABASE IF EXISTS spoilt WITH (FORCE)").unwrap();
    client.batch_execute(copy).unwrap();
    let changed = server.client("spoilt").execute(change, &[]).unwrap();
    assert!(changed > 0, "{change}");
    faults(server, "spoilt")
}

/// Whether a fault contains `expected`, which leaves out the run's id.
fn is_told(faults: &[String], expected: &str) -> bool {
    faults.iter().any(|fault| fault.contains(expected))
}

#[test]
fn whatever_came_in_whatever_order_is_found_to_be_as_it_was_sent() {
    let server = plant();
    assert_eq!(faults(&server, "plant"), [""; 0]);
}

/// As of stations with a newer program.
#[test]
fn records_with_a_key_more_are_no_fault() {
    let change = r#"WITH newer AS (
        SELECT sha256, replace(text, '"schema": 1,', '"schema": 1, "moon": 1,') AS text FROM record
    ), hashed AS (
        SELECT sha256 AS old, encode(sha256(convert_to(text, 'UTF8')), 'hex') AS new, text FROM newer
    ), named AS (
        UPDATE run SET record_sha256 = new FROM hashed WHERE record_sha256 = old
    )
    UPDATE record SET sha256 = new, text = hashed.text FROM hashed WHERE sha256 = old"#;
    assert_eq!(spoilt(&plant(), change), [""; 0]);
}

#[test]
fn a_record_that_is_gone_or_changed_is_found_with_its_run() {
    let server = plant();
    let of_run = |what: &str| {
        let rows =
            server.rows("SELECT id, record_sha256 FROM run WHERE verdict = 'FAIL' ORDER BY id LIMIT 1");
        let [run, hash] = &rows[0][..] else { panic!("{rows:?}") };
        what.replace("RUN", run).replace("HASH", hash)
    };
    let expected = of_run("the record HASH of run RUN is not there, or not as it was sent");
    for change in [
        "UPDATE record SET text = replace(text, '\"FAIL\"', '\"PASS\"') WHERE sha256 = 'HASH'",
        "UPDATE record SET text = text || ' ' WHERE sha256 = 'HASH'",
        "DELETE FROM record WHERE sha256 = 'HASH'",
    ] {
        let faults = spoilt(&server, &of_run(change));
        assert!(is_told(&faults, &expected), "{change}: {faults:?}");
        assert!(is_told(&faults, &of_run("table run has a row RUN, and no record has")), "{faults:?}");
    }
    let surplus = "INSERT INTO record VALUES (repeat('0', 64), '{}')";
    assert_eq!(
        spoilt(&server, surplus),
        [format!("table record has a row {}, and no record has", "0".repeat(64))]
    );
}

fn count(server: &Server, table: &str) -> String {
    server.rows(&format!("SELECT count(*) FROM {table}")).remove(0).remove(0)
}

fn prune(settings: &Path, days: i64) -> Did {
    pruning(settings, days).output().unwrap().into()
}

fn pruning(settings: &Path, days: i64) -> Command {
    let mut command = Command::new(program());
    command.args([
        "plant",
        "prune",
        "--older-than",
        &days.to_string(),
        "--reason",
        "old",
        "--operator",
        "engel",
    ]);
    command.arg("--settings").arg(settings);
    command
}

/// The rows of old runs may go, since the records contain them; a run that arrives late may still have rows.
#[test]
fn rows_of_old_runs_are_removed_and_nothing_else_is_missed() {
    let server = plant();
    let folder = crate::common::folder();
    let settings = settings(&server, folder.path(), "");
    let count = |table: &str| count(&server, table);
    let kept = ["run", "record", "failure", "suspect", "day_count", "retest"];
    let (before, rows) = (kept.map(count), ["step", "measurement"].map(count));
    let prune = |days: i64| prune(&settings, days);
    // The runs of the two stations began years ago, all others later.
    let years = (crate::common::now_ms() - BEGIN_MS) / DAY_MS + 1_500;
    let old = |table: &str| {
        let of = format!("SELECT id FROM run WHERE started_ms < {}", BEGIN_MS - 1_500 * DAY_MS);
        count(&format!("{table} WHERE run_id IN ({of})"))
    };
    let removed = ["step", "measurement"].map(old);
    assert_eq!(removed[0], "12", "two steps each of six runs");
    let done = prune(years);
    let number = |of: &[String; 2]| of.iter().map(|of| of.parse::<u32>().unwrap()).sum::<u32>();
    let said = format!("{} rows were removed; every record is kept\n", number(&removed));
    assert_eq!((done.code, done.said), (Some(0), said), "{}", done.complained);
    assert_eq!(number(&["step", "measurement"].map(count)), number(&rows) - number(&removed));
    assert_eq!(kept.map(count), before);
    assert_eq!(faults(&server, "plant"), [""; 0]);
    assert_eq!(prune(years).said, "0 rows were removed; every record is kept\n");
    assert_eq!(
        server.rows("SELECT operator_id, detail FROM audit WHERE act = 'prune rows'"),
        [["engel", "old"]; 2]
    );
    // Rows of newer runs that are missing are still reported.
    let faults =
        spoilt(&server, "DELETE FROM step WHERE run_id = (SELECT max(run_id) FROM step) AND seq = 1");
    assert_eq!(faults.len(), 1, "{faults:?}");
}

/// Otherwise rows of young runs would be gone, and from then on the audit would explain whatever else is missing.
#[test]
fn rows_are_as_old_as_the_plant_s_clock_says_whatever_that_of_the_office_says() {
    let server = plant();
    let folder = crate::common::folder();
    let pruning = |days: i64| pruning(&settings(&server, folder.path(), ""), days);
    let rows = || ["step", "measurement"].map(|table| count(&server, table));
    let before = rows();
    // All runs began later, by some years.
    let days = (crate::common::now_ms() - BEGIN_MS) / DAY_MS + 6_000;
    let clocks = Clocks::in_folder(folder.path());
    clocks.ahead(20 * 366 * 86_400, 0);
    let done: Did = clocks.of(&mut pruning(days)).output().unwrap().into();
    assert_eq!(done.said, "0 rows were removed; every record is kept\n", "{}", done.complained);
    assert_eq!(rows(), before);
    let missing = "DELETE FROM step WHERE run_id = (SELECT max(run_id) FROM step) AND seq = 1";
    let faults = spoilt(&server, missing);
    assert_eq!(faults.len(), 1, "{faults:?}");
}

/// Changes that the schema allows, and part of the fault that names each.
const CHANGES: [(&str, &str); 35] = [
    ("UPDATE plan SET version = '2' WHERE version = '1'", "table plan, row"),
    ("UPDATE plan SET first_used_ms = first_used_ms + 1 WHERE name = 'final'", "first_used_ms is"),
    ("UPDATE unit SET serial = 'S99' WHERE serial = 'S2'", "serial is `S99`, and the records say `S2`"),
    ("UPDATE unit SET first_seen_ms = first_seen_ms + 1", "first_seen_ms is"),
    ("INSERT INTO unit VALUES (repeat('u', 36), 'CAM-T', 'S77', 1)", "table unit has a row uuu"),
    ("UPDATE run SET verdict = 'PASS', cause = 'none' WHERE verdict = 'FAIL'", "verdict is `PASS`, and the records say `FAIL`"),
    ("UPDATE run SET headline = 'all is well'", "headline is `all is well`"),
    ("UPDATE run SET nth = 7 WHERE verdict = 'FAIL'", "nth is `7`"),
    ("UPDATE run SET nth = 1 WHERE nth = 0", "nth is `1`, and the records say `0`"),
    ("UPDATE run SET station = 'station 99' WHERE verdict = 'PASS'", "station is `station 99`"),
    ("UPDATE run SET device = repeat('a', 16)", "device is `aaaaaaaaaaaaaaaa`"),
    ("UPDATE run SET unit_id = (SELECT min(id) FROM unit) WHERE verdict = 'FAIL'", "unit_id is"),
    ("UPDATE run SET record_sha256 = (SELECT min(record_sha256) FROM run)", "table run has a row"),
    ("UPDATE step SET outcome = 'passed' WHERE outcome = 'failed'", "outcome is `passed`"),
    ("DELETE FROM step WHERE seq = 2", "table step has no row"),
    ("UPDATE measurement SET value = value + 1 WHERE name = 'latency.clocks'", "table measurement, row"),
    ("DELETE FROM suspect WHERE rank = 1", "table suspect has no row"),
    ("UPDATE attachment SET bytes = bytes + 1", "table attachment, row"),
    ("DELETE FROM binding WHERE reason = 'first judgement'", "table binding has no row"),
    ("DELETE FROM binding WHERE reason = 'a new FPGA'", "table binding has no row"),
    ("UPDATE binding SET to_ms = from_ms + 1", "table binding, row"),
    ("UPDATE binding SET device = repeat('b', 16) WHERE device = '00000000000000d4'", "device is `bbbbbbbbbbbbbbbb`"),
    ("INSERT INTO binding SELECT repeat('b', 36), repeat('b', 16), unit_id, 1, 2, 'x', 'y' FROM run LIMIT 1", "table binding has a row bbb"),
    ("UPDATE day_count SET passed = passed + 1", "table day_count, row"),
    ("DELETE FROM day_count WHERE passed > 0", "table day_count has no row"),
    ("UPDATE retest SET judgements = judgements + 1", "table retest, row"),
    ("DELETE FROM failure WHERE kind = 'part'", "table failure has no row"),
    ("UPDATE failure SET name = 'x' WHERE kind = 'check'", "x, and no record has"),
    ("INSERT INTO outbox VALUES ('plant', 'run', repeat('o', 36), 0, 0, NULL, NULL, NULL)", "table outbox has a row plant run ooo"),
    ("INSERT INTO origin VALUES (repeat('o', 36))", "table origin has a row ooo"),
    ("UPDATE job SET run_id = repeat('j', 36) WHERE state = 'done'", "is done, and its run is not there"),
    ("UPDATE waiver SET reason = 'sound'", "is not as the audit has it"),
    ("UPDATE audit SET operator_id = 'nobody' WHERE act = 'waive'", "is not as the audit has it"),
    ("UPDATE mismatch SET last_ms = last_ms + 1", "table mismatch has a row"),
    (
        "INSERT INTO run (id, station, lane, unit_id, plan_sha256, variant, operator_id, target, nth, fence, started_ms, state)
         SELECT repeat('r', 36), station, 'x', unit_id, plan_sha256, '', '', '', 0, 1, 1, 'open' FROM run LIMIT 1",
        "table run has a row rrr",
    ),
];

#[test]
fn a_changed_row_is_found_in_every_table() {
    let server = plant();
    for (change, expected) in CHANGES {
        let faults = spoilt(&server, change);
        assert!(is_told(&faults, expected), "{change}: {faults:?}");
    }
}

#[test]
fn the_command_says_what_is_wrong_and_its_exit_code_does() {
    let server = plant();
    let folder = crate::common::folder();
    let settings = settings(&server, folder.path(), "");
    let check = |more: &[&str]| -> Did {
        let mut command = Command::new(program());
        command.args(["plant", "check", "--settings"]).arg(&settings).args(more).output().unwrap().into()
    };
    let sound = check(&[]);
    let runs = server.rows("SELECT count(*) FROM run").remove(0).remove(0);
    let expected = format!("{runs} runs and {runs} pieces of evidence were read, 0 faults found\n");
    assert_eq!((sound.code, sound.said, sound.complained.as_str()), (Some(0), expected, ""));
    let change = "UPDATE step SET detail = 'x' WHERE run_id = (SELECT min(id) FROM run) AND seq = 1";
    server.change(change);
    let run = server.rows("SELECT min(id) FROM run").remove(0).remove(0);
    let wrong = check(&[]);
    assert!(
        wrong.code == Some(3)
            && wrong.said.contains(&format!("fault: table step, row {run} 1 1: detail is `x`")),
        "{wrong:?}"
    );
    let document: Value = serde_json::from_str(&check(&["--json"]).said).unwrap();
    let fault = &document["faults"][0];
    assert_eq!(
        (&document["exit_code"], &fault["code"]),
        (&3.into(), &"table-row-differs".into()),
        "{document}"
    );
    assert_eq!(
        (&fault["parameters"]["table"], &fault["parameters"]["column"]),
        (&"step".into(), &"detail".into())
    );
    drop(server);
    let away: Value = serde_json::from_str(&check(&["--json"]).said).unwrap();
    assert_eq!(
        (&away["command"], &away["exit_code"], &away["error"]["code"]),
        (&"check".into(), &3.into(), &"plant-refuses".into()),
        "{away}"
    );
}
