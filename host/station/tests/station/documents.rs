//! What is printed as JSON: it conforms to the schema in the repository, and every error has a code.

use std::collections::BTreeSet;
use std::fs;
use std::process::Command;
use std::time::{Duration, SystemTime};

use clap::CommandFactory as _;
use halfrow_station::commands::Cli;
use serde_json::Value;

use crate::common::{Did, PLAN, did, program};
use crate::held;
use crate::runs::bench::Station;

const SCHEMA: &str = include_str!("../../schema/station-1.json");

const RECORD: &str = include_str!("../../schema/record-1.json");

/// The printed document, which must conform to the schema and have the process's own exit code.
fn document(did: &Did) -> Value {
    let said: Value = serde_json::from_str(&did.said).unwrap_or_else(|error| panic!("{error}: {did:?}"));
    let schema = jsonschema::validator_for(&serde_json::from_str(SCHEMA).unwrap()).unwrap();
    let wrong = held::errors(&schema, &said);
    assert!(wrong.is_empty(), "not as the schema says: {wrong:#?}");
    assert_eq!(said["exit_code"].as_i64(), did.code.map(i64::from), "{did:?}");
    said
}

fn run(station: &Station, serial: &str, board: &str) -> Did {
    let mut arguments = station.run_arguments(serial, board);
    arguments.push("--json".to_owned());
    Command::new(program()).args(arguments).output().unwrap().into()
}

#[test]
fn a_run_is_a_document_whatever_it_comes_to() {
    let station = Station::with(PLAN);
    for (serial, board, verdict, cause) in [
        ("CAT00001", "mock,serial=17", "PASS", "none"),
        ("CAT00002", "mock,fault=stuck-data", "FAIL", "board"),
        ("CAT00003", "tcp:127.0.0.1:1", "ERROR", "link"),
        ("CAT00004", "mock,serial=17", "ERROR", "operator"),
    ] {
        let said = document(&run(&station, serial, board));
        assert_eq!((&said["verdict"], &said["cause"]), (&verdict.into(), &cause.into()), "{said:#}");
        assert_eq!(said["run"]["serial"], serial);
        let kind = if cause == "link" { Value::Null } else { "mock".into() };
        assert_eq!((&said["board"]["kind"], said["finding"]["code"].is_string()), (&kind, true), "{said:#}");
        let hash = said["record_sha256"].as_str().unwrap();
        assert_eq!(crate::runs::bench::sha256sum(&station.store().blobs().path(hash)), hash);
    }
    let recorded = station.query("SELECT id FROM run ORDER BY id");
    station.change(
        "UPDATE run SET state = 'open', verdict = NULL, cause = NULL, exit_code = NULL, headline = NULL,
         ended_ms = NULL, record_sha256 = NULL WHERE cause = 'operator'",
    );
    let said = document(&run(&station, "CAT00005", "mock"));
    assert_eq!(said["recovered"], serde_json::json!([{ "run": recorded[3], "serial": "CAT00004" }]));
}

#[test]
fn a_run_of_the_mock_that_checks_a_shift_is_a_document_and_no_judgement() {
    let shift = "[shift]\ngood = \"CAT90001\"\nbad = \"HR:MOCK\"\nhours = 8\n[tables]";
    let station = Station::with(&PLAN.replace("[tables]", shift));
    let [plan, data] = [station.path("plan.toml"), station.data()].map(|path| path.display().to_string());
    let said = document(&did(&["run", "--mock", "--json", "--plan", &plan, "--data", &data]));
    assert_eq!(said["nth"], 0, "{said:#}");
}

#[test]
fn what_has_no_verdict_is_a_document_with_a_code() {
    let station = Station::with(PLAN);
    let said = document(&run(&station, "CAT1", "mock"));
    assert_eq!((&said["error"]["code"], &said["exit_code"]), (&"serial-of-no-product".into(), &2.into()));
    assert_eq!(said["error"]["parameters"]["serial"], "CAT1");
    station.plan(&PLAN.replace("schema = 1", "schema = 9"));
    let said = document(&run(&station, "CAT00001", "mock"));
    assert_eq!(
        (&said["error"]["code"], &said["error"]["parameters"]["line"]),
        (&"station-input-wrong".into(), &1.into())
    );
    station.plan(PLAN);
    // No record can be saved: where its folder would be is a file.
    fs::create_dir_all(station.data().join("blobs")).unwrap();
    for first in 0..=255 {
        fs::write(station.data().join(format!("blobs/{first:02x}")), "no folder").unwrap();
    }
    let said = document(&run(&station, "CAT00001", "mock"));
    assert_eq!((&said["error"]["code"], &said["verdict"]), (&"run-unsaved".into(), &Value::Null), "{said:#}");
    for command in [&["history"][..], &["unit", "S1"], &["yield"], &["pareto"]] {
        let said = document(&did(&[command, &["--json", "--data", "/nowhere"]].concat()));
        assert_eq!(
            (&said["error"]["code"], &said["command"]),
            (&"store-without-results".into(), &command[0].into())
        );
    }
    let usage = document(&did(&["run", "--json", "--moon"]));
    assert_eq!(
        (&usage["error"]["code"], &usage["command"]),
        (&"usage-argument-unknown".into(), &"run".into())
    );
}

/// Whoever reads stdout gets a code even where the command's own lists have no schema.
#[test]
fn a_list_that_cannot_be_made_is_a_document_with_a_code() {
    for call in
        [&["plan", "published"][..], &["outbox", "list"], &["work"], &["job", "list"], &["board", "list"]]
    {
        let did = did(&[call, &["--json", "--settings", "/nowhere/station.toml"]].concat());
        let said = document(&did);
        assert_eq!(
            (&said["error"]["code"], &said["command"], &said["exit_code"]),
            (&"station-input-unreadable".into(), &call[0].into(), &2.into())
        );
        // Of `work` each line is an object.
        assert_eq!(did.said.lines().count() == 1, call == ["work"], "{}", did.said);
        let without = crate::common::did(&[call, &["--settings", "/nowhere/station.toml"]].concat());
        assert_eq!((without.code, without.said.as_str()), (Some(2), ""), "{call:?}");
    }
}

/// The calls of `command` that ask for a document, each with its path; none of their files can be there.
fn asking<'a>(path: &[&'a str], command: &'a clap::Command) -> Vec<(Vec<&'a str>, Vec<String>)> {
    let within = command.get_subcommands().flat_map(|it| asking(&[path, &[it.get_name()]].concat(), it));
    let mut calls: Vec<_> = within.collect();
    let mut call: Vec<_> = path.iter().map(|&word| word.to_owned()).collect();
    for argument in command.get_arguments() {
        match argument.get_long() {
            Some(flag @ ("data" | "plan" | "settings")) => call.push(format!("--{flag}=/dev/null/nowhere")),
            // In place of two options.
            Some("mock") => call.push("--mock".to_owned()),
            Some("json") => calls.push((path.to_vec(), vec!["--json".to_owned()])),
            Some(flag) if argument.is_required_set() => call.push(format!("--{flag}=S1")),
            None if argument.is_required_set() => call.push("S1".to_owned()),
            _ => {}
        }
    }
    if let Some((_, own)) = calls.iter_mut().find(|(of, _)| of == path) {
        own.splice(..0, call);
    }
    calls
}

#[test]
fn every_command_that_can_be_asked_for_a_document_prints_one_when_it_fails() {
    let mut program_itself = Cli::command();
    // What a command takes for its subcommands is then theirs, too.
    program_itself.build();
    let calls = asking(&[], &program_itself);
    assert!(calls.len() >= 14, "{calls:?}");
    // The list of codes needs nothing that could be missing.
    for (path, call) in calls.iter().filter(|(path, _)| path != &["codes"]) {
        let call: Vec<_> = call.iter().map(String::as_str).collect();
        let said = document(&did(&call));
        let named = if path == &["plant", "check"] { "check" } else { path[0] };
        assert_eq!((&said["command"], said["error"]["code"].is_string()), (&named.into(), true), "{call:?}");
        assert_eq!(did(&call[..call.len() - 1]).said, "", "{call:?}");
    }
}

#[test]
fn what_check_finds_has_codes() {
    let station = Station::with(PLAN);
    station.run("CAT00001", "mock");
    let data = station.data().display().to_string();
    let check = || document(&did(&["check", "--json", "--data", &data]));
    let well = check();
    assert_eq!(
        (&well["runs"], &well["faults"], &well["exit_code"]),
        (&1.into(), &Value::Array(vec![]), &0.into())
    );
    station.change("UPDATE plan SET version = '2'");
    let found = check();
    assert_eq!((&found["faults"][0]["code"], &found["exit_code"]), (&"table-row-differs".into(), &3.into()));
    assert_eq!(found["faults"][0]["parameters"]["column"], "version");
    let nowhere = document(&did(&["check", "--json", "--data", "/nowhere"]));
    assert_eq!(
        (&nowhere["error"]["code"], &nowhere["command"]),
        (&"store-without-results".into(), &"check".into())
    );
}

#[test]
fn what_prune_removes_is_a_document() {
    let station = Station::with(PLAN);
    station.run("CAT00001", "mock,fault=stuck-data");
    let blob = station.store().blobs().put(b"nobody's").unwrap();
    let file = fs::File::options().append(true).open(station.store().blobs().path(&blob)).unwrap();
    file.set_modified(SystemTime::now() - Duration::from_secs(90_000)).unwrap();
    let data = station.data().display().to_string();
    let said = document(&did(&["prune", "--json", "--data", &data, "--operator", "engel"]));
    assert_eq!(said["unnamed"], serde_json::json!({ "pieces": 1, "spools": 0, "bytes": 8 }));
    assert_eq!(said["old"], serde_json::json!({ "pieces": 0, "bytes": 0 }));
    let nowhere = document(&did(&["prune", "--json", "--operator", "engel", "--data", "/nowhere"]));
    assert_eq!(
        (&nowhere["error"]["code"], &nowhere["command"]),
        (&"store-without-results".into(), &"prune".into())
    );
}

#[test]
#[should_panic(expected = "not as the schema says")]
fn a_document_with_a_key_that_the_schema_does_not_know_is_refused() {
    let did = did(&["codes", "--json"]);
    document(&Did { said: did.said.replacen("\"codes\"", "\"moons\"", 2), ..did });
}

/// Where a record departs from its schema, or a report in it from that of `halfrow`.
fn misread(record: &Value) -> Vec<String> {
    let [schema, report] = [RECORD, include_str!("../../../schema/halfrow-1.json")]
        .map(|schema| jsonschema::validator_for(&serde_json::from_str(schema).unwrap()).unwrap());
    let steps = record["steps"].as_array().into_iter().flatten();
    let reports = steps.filter(|step| step["kind"] == "verify" && step["evidence"].is_object());
    let wrong = reports.flat_map(|step| held::errors(&report, &step["evidence"]));
    held::errors(&schema, record).into_iter().chain(wrong).collect()
}

/// The records of a PASS with every kind of step, a FAIL, an ERROR, and a run that was found open.
#[test]
fn every_record_is_as_its_schema_says() {
    let link = "[[step]]\nkind = \"link\"\nseconds = 0.01\n[[step]]";
    let limits = "[limits]\n\"run.seconds\" = { most = 60 }\n";
    let station = Station::with(&format!("{}{limits}", PLAN.replace("[[step]]", link)));
    let boards = ["mock,serial=17", "mock,fault=stuck-data", "tcp:127.0.0.1:1", "mock"];
    for (serial, board) in ["CAT00001", "CAT00002", "CAT00003", "CAT00004"].into_iter().zip(boards) {
        station.run(serial, board);
    }
    let last = "UPDATE run SET state = 'open', verdict = NULL, cause = NULL, exit_code = NULL, headline = NULL, ended_ms = NULL,
                record_sha256 = NULL WHERE unit_id = (SELECT id FROM unit WHERE serial = 'CAT00004')";
    assert_eq!(station.change(last), 1);
    station.run("CAT00005", "mock");
    let data = station.data().display().to_string();
    let schema: Value = serde_json::from_str(RECORD).unwrap();
    let required = schema["required"].as_array().unwrap();
    let mut causes = BTreeSet::new();
    for run in station.query("SELECT id FROM run") {
        let record: Value = serde_json::from_str(&did(&["export", &run, "--data", &data]).said).unwrap();
        assert_eq!(misread(&record), Vec::<String>::new(), "schema/record-1.json");
        causes.insert(record["conclusion"]["cause"].as_str().unwrap().to_owned());
        // The control: one key less, or one more.
        for key in required.iter().map(|key| key.as_str().unwrap()) {
            let mut less = record.clone();
            less.as_object_mut().unwrap().remove(key);
            assert_eq!(misread(&less).len(), 1, "{key}");
        }
        let mut more = record;
        more["run"]["moon"] = 1.into();
        assert_eq!(misread(&more).len(), 1);
    }
    assert_eq!(causes.into_iter().collect::<Vec<_>>(), ["board", "crash", "link", "none"]);
}

/// Records are kept for ever: the schema accepts those of every release.
#[test]
fn the_records_of_earlier_programs_are_as_the_schema_says() {
    let blobs = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/station/history/released/blobs");
    let mut records = 0;
    let folders = fs::read_dir(blobs).unwrap();
    for file in folders.flat_map(|folder| fs::read_dir(folder.unwrap().path()).unwrap()) {
        let bytes = fs::read(file.unwrap().path()).unwrap();
        let Ok(record) = serde_json::from_slice::<Value>(&bytes) else { continue };
        if record.get("conclusion").is_some() {
            assert_eq!(misread(&record), Vec::<String>::new(), "schema/record-1.json");
            records += 1;
        }
    }
    assert!(records >= 6, "{records}");
}

#[test]
fn schema_and_pages_are_those_in_the_repository_and_no_code_stands_twice() {
    for (arguments, file, kept) in [
        ("schema", "host/station/schema/station-1.json", SCHEMA),
        ("schema record", "host/station/schema/record-1.json", RECORD),
        ("codes", "docs/STATION-CODES.md", include_str!("../../../../docs/STATION-CODES.md")),
        ("commands", "docs/STATION-COMMANDS.md", include_str!("../../../../docs/STATION-COMMANDS.md")),
    ] {
        let printed = did(&arguments.split(' ').collect::<Vec<_>>()).said;
        held::assert_printed_by(&format!("halfrow-station {arguments}"), &printed, file, kept);
    }
    let codes = document(&did(&["codes", "--json"]));
    let codes: Vec<_> =
        codes["codes"].as_array().unwrap().iter().map(|entry| entry["code"].as_str().unwrap()).collect();
    assert_eq!(codes.iter().collect::<BTreeSet<_>>().len(), codes.len());
    let of_halfrow = include_str!("../../../../docs/CODES.md");
    for code in codes {
        assert!(code.chars().all(|letter| letter.is_ascii_lowercase() || letter == '-'), "{code}");
        let theirs = of_halfrow.contains(&format!("* `{code}`"));
        assert!(!theirs, "{code} is a code of halfrow's, too");
    }
}
