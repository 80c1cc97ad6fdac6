//! The commands that show results.

use std::path::Path;
use std::process::Command;

use halfrow_station::record::{DeviceSeen, RunCause};
use serde_json::Value;
use tempfile::TempDir;

use super::made::{BEGIN_MS, DAY_MS, End, HOUR_MS, Made, Run};
use crate::common::{Did, program};
use crate::held;

/// Runs a command; returns its exit code, stdout and stderr.
pub(crate) fn did(made: &impl AsRef<Path>, arguments: &[&str]) -> (i32, String, String) {
    let output = Command::new(program()).args(arguments).arg("--data").arg(made.as_ref()).output().unwrap();
    let Did { code, said, complained } = output.into();
    (code.unwrap(), said, complained)
}

fn said(made: &impl AsRef<Path>, arguments: &[&str]) -> String {
    let (code, said, complained) = did(made, arguments);
    assert_eq!((code, complained.as_str()), (0, ""), "{said}");
    said
}

fn json(made: &impl AsRef<Path>, arguments: &[&str]) -> Value {
    let said = serde_json::from_str(&said(made, &[arguments, &["--json"]].concat())).unwrap();
    assert_eq!(misread(arguments[0], &said), Vec::<String>::new(), "schema/results-1.json");
    said
}

/// Where the output of a command departs from the schema that the program prints for it.
pub(crate) fn misread(command: &str, said: &Value) -> Vec<String> {
    let schema = Command::new(program()).args(["schema", command]).output().unwrap().stdout;
    let schema = jsonschema::validator_for(&serde_json::from_slice(&schema).unwrap()).unwrap();
    held::errors(&schema, said)
}

fn made() -> Made {
    let mut made = Made::new();
    for (serial, end, hour) in [
        ("S1", End::Fail(&["memory"]), 0),
        ("S1", End::Pass, 1),
        ("S2", End::Error(RunCause::Crash), 2),
        ("S3", End::Pass, 24),
    ] {
        made.run(&Run::of(serial, end).at_hour(hour));
    }
    made
}

#[test]
fn history_goes_on_where_a_page_ends() {
    let made = made();
    let first = said(&made, &["history", "--limit", "3"]);
    assert!(first.trim_start().starts_with("began "), "{first}");
    assert!(first.contains("2026-11-02T00:00:00Z"), "{first}");
    let next = first.lines().last().unwrap().strip_prefix("more: --after ").unwrap();
    let second = json(&made, &["history", "--limit", "3", "--after", next]);
    assert_eq!(second["runs"][0]["serial"], "S1");
    assert_eq!(second["runs"][0]["verdict"], "FAIL");
    assert_eq!((second["runs"].as_array().unwrap().len(), &second["next"]), (1, &Value::Null));
}

#[test]
fn of_units_that_were_tested_again_the_newest_are_listed_and_the_rest_counted() {
    let mut made = Made::new();
    for hour in 0..22 {
        for (end, minute) in [(End::Fail(&["memory"]), 0), (End::Pass, 1)] {
            let started_ms = BEGIN_MS + hour * HOUR_MS + minute * 60_000;
            made.run(&Run { started_ms, ..Run::of(&format!("S{hour:02}"), end) });
        }
    }
    let folder = made.closed();
    let text = said(&folder, &["yield"]);
    let listed: Vec<_> =
        text.lines().filter_map(|line| line.get(1..4)).filter(|word| word.starts_with('S')).collect();
    let newest: Vec<_> = (2..22).rev().map(|hour| format!("S{hour:02}")).collect();
    assert_eq!(listed, newest, "{text}");
    assert!(text.contains("\n2 units more, which passed before these"), "{text}");
}

#[test]
fn history_takes_each_filter() {
    let made = made();
    let runs = |arguments: &[&str]| {
        let page = json(&made, &[&["history"], arguments].concat());
        page["runs"]
            .as_array()
            .unwrap()
            .iter()
            .map(|run| run["serial"].as_str().unwrap().to_owned())
            .collect::<Vec<_>>()
    };
    assert_eq!(runs(&["--serial", "S1"]), ["S1", "S1"]);
    assert_eq!(runs(&["--verdict", "ERROR"]), ["S2"]);
    assert_eq!(runs(&["--lane", "2"]), Vec::<String>::new());
    assert_eq!(runs(&["--plan", "final", "--operator", "weber", "--from", "2026-11-02"]), ["S3"]);
    assert_eq!(runs(&["--until", "2026-11-01T02:00:00+01:00"]), ["S1"]);
    assert_eq!(runs(&["--until", "2026-11-01"]), ["S2", "S1", "S1"], "the day is among what is meant");
    let (code, _, complained) = did(&made, &["history", "--from", "2026-11-03", "--until", "2026-11-01"]);
    assert_eq!(code, 2);
    assert!(complained.contains("--until is not after --from"), "{complained}");
    let (code, _, complained) = did(&made, &["history", "--from", "yesterday"]);
    assert_eq!(code, 2);
    assert!(complained.contains("give a date from 1970 to 9999, as 2026-11-22"), "{complained}");
}

#[test]
fn a_unit_is_told_with_its_steps_and_suspects() {
    let made = made();
    let text = said(&made, &["unit", "S1"]);
    for words in ["S1, CAM-T, first seen 2026-11-01T00:00:00Z", "suspect   memory, bit 3: explains 75 %"] {
        assert!(text.contains(words), "{text}");
    }
    assert_eq!(json(&made, &["unit", "S1"])[0]["runs"][1]["steps"][1]["outcome"], "failed");
    let (code, _, complained) = did(&made, &["unit", "S9"]);
    assert_eq!(code, 2);
    assert!(complained.contains("no unit S9 was tested here"), "{complained}");
}

#[test]
fn no_percentage_is_told_without_its_interval() {
    let made = made();
    let text = said(&made, &["yield"]);
    // Wilson for 1 of 2, by hand: (1 ± z / sqrt(2 + z²)) / 2, since the centre is 1/2.
    assert!(text.contains("50.0 % (9.5–90.5) 1/2"), "{text}");
    assert!(text.matches(" % ").count() == text.matches(" % (").count(), "{text}");
    assert!(text.contains("first FAIL, in the end PASS"), "{text}");
    let lines = json(&made, &["yield", "--by", "day"]);
    assert_eq!(lines["lines"][1]["day"], "2026-11-02");
    assert_eq!(lines["lines"][0]["errors"]["count"], 1);
    let failures = said(&made, &["pareto"]);
    assert!(
        failures.starts_with("1 of 3 judged runs failed, 1 unit concerned\nproducts: CAM-T\n"),
        "{failures}"
    );
    assert!(failures.contains("memory") && failures.contains("100.0 % (20.7–100.0)"), "{failures}");
}

#[test]
fn what_is_counted_and_listed_can_be_of_one_station() {
    let mut made = made();
    made.run(&Run { station: "north", started_ms: BEGIN_MS, ..Run::of("S4", End::Fail(&["core"])) });
    let at_north = |command: &str| json(&made, &[command, "--station", "north"]);
    let runs = &at_north("history")["runs"];
    assert_eq!((runs[0]["serial"].as_str(), runs.as_array().unwrap().len()), (Some("S4"), 1), "{runs}");
    assert_eq!(at_north("yield")["lines"][0]["first_pass"]["of"], 1);
    assert_eq!(at_north("pareto")["failed"], 1);
    assert_eq!(json(&made, &["pareto"])["failed"], 2);
}

/// Nobody may take a misspelt name for a line without failures.
#[test]
fn without_failures_it_is_told_whether_anything_was_judged() {
    let mut made = made();
    assert_eq!(said(&made, &["pareto", "--plan", "typo"]).trim_end(), "no run that matches was judged");
    let second = said(&made, &["pareto", "--from", "2026-11-02"]);
    assert_eq!(second.trim_end(), "0 of 1 judged run failed\nproducts: CAM-T");
    let error = Run { lane: "2".to_owned(), ..Run::of("S5", End::Error(RunCause::Link)) };
    made.run(&error);
    let of_error = json(&made, &["pareto", "--lane", "2"]);
    assert_eq!((&of_error["judged"], &of_error["failed"]), (&0.into(), &0.into()), "an ERROR judges nothing");
}

#[test]
fn products_whose_plans_have_one_name_are_told_apart() {
    let mut made = made();
    made.run(&Run { product: "CAM-U", ..Run::of("U1", End::Fail(&["clock"])) });
    let of = |product: &str, command: &str| json(&made, &[command, "--plan", "final", "--product", product]);
    let serials = |page: &Value| -> Vec<String> {
        page["runs"]
            .as_array()
            .unwrap()
            .iter()
            .map(|run| run["serial"].as_str().unwrap().to_owned())
            .collect()
    };
    assert_eq!(serials(&of("CAM-U", "history")), ["U1"]);
    assert_eq!(serials(&json(&made, &["history", "--product", "CAM-T"])), ["S3", "S2", "S1", "S1"]);
    assert_eq!(serials(&of("typo", "history")), Vec::<String>::new());
    let lines = of("CAM-U", "yield")["lines"].clone();
    assert_eq!((&lines[0]["product"], lines.as_array().unwrap().len()), (&"CAM-U".into(), 1));
    let both = json(&made, &["pareto", "--plan", "final"]);
    assert_eq!((&both["failed"], &both["products"]), (&2.into(), &serde_json::json!(["CAM-T", "CAM-U"])));
    let one = of("CAM-U", "pareto");
    assert_eq!(
        (&one["failed"], &one["judged"], &one["products"][0]),
        (&1.into(), &1.into(), &"CAM-U".into())
    );
    assert_eq!(one["bars"][0]["name"], "clock");
    let to = made.folder().path().join("of-u");
    let exported = said(&made, &["export", "--product", "CAM-U", "--to", to.to_str().unwrap()]);
    assert!(exported.starts_with("1 run is in "), "{exported}");
}

/// Of 70 units five failed, all of them on one day.
#[test]
fn a_day_beyond_the_band_is_told_with_its_band() {
    let mut made = Made::new();
    for (day, number) in (0..5).map(|number| (0, number)).chain((1..66).map(|day| (day, 0))) {
        let started_ms = BEGIN_MS + day * DAY_MS + number;
        let end = if day == 0 { End::Fail(&["memory"]) } else { End::Pass };
        made.run(&Run { started_ms, ..Run::of(&format!("S{day}-{number}"), end) });
    }
    let text = said(&made, &["yield", "--by", "day"]);
    let row =
        |day: &str| text.lines().find(|line| line.contains(&format!("final {day}"))).unwrap().to_owned();
    // With the chance 65/70 each, of five units 2 or fewer pass with 0.0033, and 1 or fewer with 0.00012.
    assert!(row("2026-11-01").contains("40.0–100.0 %, beyond"), "{text}");
    assert!(row("2026-11-02").contains("0.0–100.0 %") && !row("2026-11-02").contains("beyond"), "{text}");
    assert!(text.trim_end().ends_with("\nbeyond the band: CAM-T final 2026-11-01"), "{text}");
    assert!(!said(&made, &["yield"]).contains("band"));
}

#[test]
fn a_waiver_is_seen_by_everyone() {
    let made = made();
    let run = json(&made, &["history", "--verdict", "fail"])["runs"][0]["id"].as_str().unwrap().to_owned();
    let (code, _, complained) = did(&made, &["waive", &run, "--reason", "it is", "--operator", "weber"]);
    assert_eq!(code, 4, "this test writes: {complained}");
    let folder = made.closed();
    assert!(
        said(&folder, &["waive", &run, "--reason", "used as it is", "--operator", "weber"])
            .contains("waived by weber")
    );
    assert_eq!(did(&folder, &["waive", &run, "--reason", "again", "--operator", "weber"]).0, 2);
    assert!(said(&folder, &["history"]).contains("FAIL, waived"));
    assert!(said(&folder, &["unit", "S1"]).contains("by weber: used as it is"));
    assert_eq!(did(&folder, &["check"]).0, 0);
}

/// Asserts that the schema of a command refuses its output with one key less, or one more.
fn is_held_to_its_schema(folder: &TempDir, arguments: &[&str], place: &str) {
    let told = json(folder, arguments);
    for key in told.pointer(place).unwrap().as_object().unwrap().keys() {
        let mut less = told.clone();
        less.pointer_mut(place).unwrap().as_object_mut().unwrap().remove(key);
        assert_ne!(misread(arguments[0], &less), Vec::<String>::new(), "{arguments:?} without {key}");
    }
    let mut more = told;
    more.pointer_mut(place).unwrap()["moon"] = 1.into();
    assert_ne!(misread(arguments[0], &more), Vec::<String>::new(), "{arguments:?}");
}

#[test]
fn what_each_command_prints_is_as_its_schema_says() {
    let mut made = made();
    let device = Some((DeviceSeen::New, "00000000000000d1"));
    made.run(&Run {
        evidence: vec!["log"],
        device,
        started_ms: BEGIN_MS,
        ..Run::of("S5", End::TooLateAndWrong)
    });
    made.run(&Run::of("S5", End::Open).at_hour(1));
    let failed = json(&made, &["history", "--serial", "S5", "--verdict", "fail"])["runs"][0]["id"].clone();
    let folder = made.closed();
    said(&folder, &["waive", failed.as_str().unwrap(), "--reason", "used as it is", "--operator", "weber"]);
    for (arguments, place) in [
        (&["history"][..], "/runs/0"),
        (&["history", "--limit", "1"], ""),
        (&["unit", "S5"], "/0"),
        (&["unit", "S1"], "/0/runs/1/suspects/0"),
        (&["yield"], "/flips/0"),
        (&["yield", "--by", "day"], "/lines/0/limits"),
        (&["yield", "--by", "week"], "/lines/0/first_pass"),
        (&["yield", "--by", "lane"], ""),
        (&["yield", "--by", "station"], "/lines/0/errors"),
        (&["pareto"], "/bars/0"),
        (&["pareto", "--by", "check"], "/bars/0/runs"),
    ] {
        is_held_to_its_schema(&folder, arguments, place);
    }
    for part in ["bindings/0", "runs/1/attachments/0", "runs/1/waivers/0"] {
        is_held_to_its_schema(&folder, &["unit", "S5"], &format!("/0/{part}"));
    }
}
