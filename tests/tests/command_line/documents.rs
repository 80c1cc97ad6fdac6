//! What --json prints: one shape for the results and errors of every command, which the schema defines.

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;

use halfrow_tests::program::documents::{SCHEMA, assert_valid};
use halfrow_tests::program::held::assert_printed_by;
use halfrow_tests::program::{Folder, halfrow};
use serde_json::{Value, json};

use crate::small;

fn repository(name: &str) -> String {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("..").join(name);
    fs::read_to_string(path).unwrap()
}

/// Runs a call with --json, which must end with `code`, and returns its document.
#[track_caller]
fn told(folder: &Folder, code: i32, arguments: &[&str]) -> Value {
    let ended = folder.halfrow(arguments.iter().copied().chain(["--json"]));
    assert_eq!(ended.code, Some(code), "{arguments:?}: {}{}", ended.stdout, ended.stderr);
    let said = ended.json();
    assert_eq!((&said["schema"], &said["exit_code"]), (&1.into(), &code.into()), "{arguments:?}: {said}");
    said
}

#[test]
fn every_command_that_prints_a_result_prints_a_document() {
    let folder = Folder::new();
    let calls: [(&str, Vec<&str>); 15] = [
        ("verify", small("verify", &["--frame", "builtin:black"])),
        ("verify", small("verify", &["--list"])),
        ("verify", small("verify", &["--within", "2", "--board", "mock,speed=20000"])),
        ("soak", small("soak", &["--frames", "5"])),
        ("correct", small("correct", &["builtin:black", "--model", "-o", "out.pgm"])),
        ("tables", small("tables", &["-o", "tables.json"])),
        ("lens", small("lens", &[])),
        ("paper", vec!["paper", "fig8", "-o", "page"]),
        ("frames", small("frames", &["--only", "black", "-o", "made"])),
        ("boards", vec!["boards"]),
        ("info", vec!["info"]),
        ("link", vec!["link", "--seconds", "0.01"]),
        ("faults", vec!["faults"]),
        ("codes", vec!["codes"]),
        ("explain", vec!["explain", "no-answer"]),
    ];
    for (command, call) in calls {
        let said = told(&folder, 0, &call);
        assert_eq!((&said["command"], &said["error"]), (&command.into(), &Value::Null), "{call:?}");
        if command == "paper" {
            let kept: Value = serde_json::from_str(&folder.text("page/paper.json")).unwrap();
            assert_eq!(kept, said);
        }
    }
    assert_eq!(told(&folder, 0, &small("verify", &["--list"]))["listed"].as_array().unwrap().len(), 19);
}

#[test]
fn the_remedy_of_a_wrong_value_is_what_to_write_instead() {
    let folder = Folder::new();
    let help = "See `halfrow help` and `halfrow COMMAND --help`.";
    for (call, message, remedy) in [
        (
            &["verify", "--width", "foo; bar"][..],
            "invalid value 'foo; bar' for '--width <SAMPLES>': give a whole number of samples",
            "Give a whole number of samples.",
        ),
        (
            &["verify", "--phase", "moon"],
            "invalid value 'moon' for '--phase <PHASE>': `moon` is no Bayer phase; use grbg, rggb, bggr or gbrg",
            "Use grbg, rggb, bggr or gbrg.",
        ),
        (&["verify", "--moon"], "unexpected argument '--moon' found", help),
        (
            &["soak"],
            "the following required arguments were not provided:\n  <--hours <HOURS>|--frames <N>>",
            help,
        ),
    ] {
        let error = &told(&folder, 2, call)["error"];
        assert_eq!((&error["message"], &error["remedy"]), (&message.into(), &remedy.into()), "{call:?}");
    }
}

#[test]
fn what_is_wrong_with_a_call_has_a_code_and_the_same_shape() {
    let folder = Folder::new();
    let cases: [(&str, &str, &[&str]); 9] = [
        ("verify", "usage-argument-unknown", &["verify", "--bogus"]),
        ("verify", "usage-value-wrong", &["verify", "--width", "wide"]),
        ("correct", "usage-argument-missing", &["correct", "--model"]),
        ("halfrow", "usage-command-unknown", &["verfy"]),
        ("verify", "frame-file-unreadable", &["verify", "--frame", "none.pgm"]),
        ("verify", "geometry-impossible", &["verify", "--width", "63"]),
        ("info", "target-kind-unknown", &["info", "--board", "moon"]),
        ("correct", "corrector-missing", &["correct", "builtin:black", "-o", "out.pgm"]),
        ("serve", "command-without-json", &["serve"]),
    ];
    for (command, code, call) in cases {
        let said = told(&folder, 2, call);
        assert_eq!(
            (&said["command"], &said["error"]["code"]),
            (&command.into(), &code.into()),
            "{call:?}: {said}"
        );
        assert_eq!((&said["verdict"], &said["board"]), (&Value::Null, &Value::Null), "{call:?}");
    }
    let unreadable = told(&folder, 2, &["verify", "--frame", "none.pgm"]);
    assert_eq!(unreadable["error"]["parameters"], json!({ "path": "none.pgm" }));
    assert_eq!(unreadable["error"]["causes"][0]["code"], "io-not-found");
}

#[test]
fn a_station_that_is_at_fault_says_so_under_its_code() {
    let said = told(&Folder::new(), 3, &["info", "--board", "serial:/dev/nonesuch"]);
    assert_eq!((&said["verdict"], &said["error"]["code"]), (&"ERROR".into(), &"serial-port-missing".into()));
    assert!(said["error"]["remedy"].as_str().unwrap().starts_with("Check that"), "{said}");
}

#[test]
fn a_cause_has_its_code_and_parameters_too() {
    let said = told(&Folder::new(), 3, &small("verify", &["--board", "mock,fault=disconnect,byte=3000"]));
    assert_eq!((&said["error"]["code"], &said["error"]), (&"link-broke".into(), &said["finding"]));
    let cause = &said["error"]["causes"][0];
    assert_eq!(cause["code"], "link-closed", "{said}");
    assert!(cause["parameters"]["at"].is_number(), "{said}");
}

#[test]
fn a_failure_names_its_suspect_by_a_code_for_designer_and_technician() {
    let said = told(&Folder::new(), 1, &small("verify", &["--board", "mock,fault=stuck-data,bit=5,value=1"]));
    let suspect = &said["suspects"][0];
    let expected = json!({ "code": "line-memory-data-stuck", "parameters": { "bit": 5, "value": 1 } });
    assert_eq!(suspect["defect"], expected);
    assert!(suspect["designer"].as_str().unwrap().contains("data line 5"), "{suspect}");
    assert!(suspect["technician"].as_str().unwrap().contains("set the board aside"), "{suspect}");
    assert_eq!(said["finding"]["parameters"]["suspect"], expected);
}

#[test]
fn the_schema_that_is_printed_is_the_one_in_the_repository() {
    let printed = halfrow(["schema"]).succeeded();
    assert_printed_by("halfrow schema", &printed.stdout, "host/schema/halfrow-1.json", SCHEMA);
    let of_one: Value = serde_json::from_str(&halfrow(["schema", "info"]).stdout).unwrap();
    let of_one = jsonschema::validator_for(&of_one).unwrap();
    assert!(of_one.is_valid(&serde_json::from_str(&halfrow(["info", "--json"]).stdout).unwrap()));
    assert!(!of_one.is_valid(&serde_json::from_str(&halfrow(["faults", "--json"]).stdout).unwrap()));
    assert_eq!(halfrow(["schema", "moon"]).code, Some(2));
}

#[test]
#[should_panic(expected = "not as the schema says")]
fn the_schema_refuses_a_document_with_a_key_that_it_does_not_know() {
    let mut said: Value = serde_json::from_str(&halfrow(["faults", "--json"]).stdout).unwrap();
    said["faults"][0]["weight"] = 1.into();
    assert_valid(&said);
}

/// The board may also be null.
#[test]
#[should_panic(expected = "('moon' was unexpected) at /board")]
fn a_key_that_the_schema_of_the_board_does_not_know_is_named() {
    let mut said: Value = serde_json::from_str(&halfrow(["info", "--json"]).stdout).unwrap();
    said["board"]["moon"] = 1.into();
    assert_valid(&said);
}

#[test]
#[should_panic(expected = "run: halfrow codes > docs/CODES.md\nfirst other line, 2\nprinted: b\nthere:   c")]
fn a_page_that_is_not_what_its_command_prints_is_told_by_its_first_other_line() {
    assert_printed_by("halfrow codes", "a\nb\nd\n", "docs/CODES.md", "a\nc\nd\n");
}

#[test]
fn the_pages_of_codes_and_commands_are_those_in_the_repository_and_no_code_stands_twice() {
    for (command, page) in [("codes", "docs/CODES.md"), ("commands", "docs/COMMANDS.md")] {
        let printed = halfrow([command]).succeeded();
        assert_printed_by(&format!("halfrow {command}"), &printed.stdout, page, &repository(page));
    }
    let codes = halfrow(["codes", "--json"]).json();
    let codes: Vec<_> =
        codes["codes"].as_array().unwrap().iter().map(|entry| entry["code"].clone()).collect();
    let distinct: BTreeSet<_> = codes.iter().filter_map(Value::as_str).collect();
    assert_eq!(distinct.len(), codes.len());
    for code in distinct {
        assert!(
            code.chars()
                .all(|letter| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '-')
        );
    }
}
