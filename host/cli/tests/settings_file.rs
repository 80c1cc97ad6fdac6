//! Settings files: what is read from them, and how wrong ones are refused.

// clippy.toml allows this in #[test] functions, but not in the functions that several tests call.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};

use halfrow_cli::settings::{Settings, SettingsError};

const EXAMPLE: &str = include_str!("../settings.example.toml");

/// The settings in a file with the content `text`.
fn load(text: &str) -> Result<Settings, SettingsError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("station.toml");
    fs::write(&path, text).unwrap();
    Settings::load(Some(&path))
}

/// The sentence of the refusal, after the file's name.
fn sentence(text: &str) -> String {
    let refused = load(text).unwrap_err().to_string();
    refused.split_once("station.toml, ").unwrap().1.to_owned()
}

#[test]
fn every_setting_is_read() {
    let text = r#"
        board = "mock,fault=flip"
        tables = "line.json"
        kernel = "keys"
        frame = ["builtin:street", "a.pgm"]
        fit = true
        report = "out"
        overwrite = true
        timeout = 90
        retry_limit = 2.5
        reconnect = 20
        at_speed = 0.5
        require_hardware = false
        seed = 18446744073709551615
    "#;
    let expected = Settings {
        board: Some("mock,fault=flip".to_owned()),
        tables: Some(PathBuf::from("line.json")),
        kernel: Some("keys".to_owned()),
        frame: Some(vec!["builtin:street".to_owned(), "a.pgm".to_owned()]),
        fit: Some(true),
        report: Some(PathBuf::from("out")),
        overwrite: Some(true),
        timeout: Some(90.0),
        retry_limit: Some(2.5),
        reconnect: Some(20.0),
        at_speed: Some(0.5),
        require_hardware: Some(false),
        seed: Some(u64::MAX),
    };
    assert_eq!(load(text).unwrap(), expected);
}

#[test]
fn an_empty_file_sets_nothing() {
    assert_eq!(load("").unwrap(), Settings::default());
}

#[test]
fn the_example_sets_nothing_until_it_is_uncommented() {
    assert_eq!(load(EXAMPLE).unwrap(), Settings::default());
}

#[test]
fn the_example_uncommented_sets_everything() {
    let lines = EXAMPLE.lines().filter_map(|line| line.strip_prefix("# "));
    let text: Vec<_> = lines.filter(|line| line.contains(" = ")).collect();
    let Settings { board, tables, kernel, frame, fit, report, .. } = load(&text.join("\n")).unwrap();
    assert!(
        board.is_some()
            && tables.is_some()
            && kernel.is_some()
            && frame.is_some()
            && fit.is_some()
            && report.is_some()
    );
    let Settings { overwrite, timeout, retry_limit, reconnect, at_speed, require_hardware, seed, .. } =
        load(&text.join("\n")).unwrap();
    assert!(overwrite.is_some() && timeout.is_some() && retry_limit.is_some());
    assert!(reconnect.is_some() && at_speed.is_some());
    assert!(require_hardware.is_some() && seed.is_some());
}

#[test]
fn a_file_that_was_named_must_be_there() {
    let missing = Path::new("/nowhere/at/all.toml");
    let refused = Settings::load(Some(missing)).unwrap_err();
    assert!(matches!(&refused, SettingsError::Io { path, .. } if path == missing));
    assert!(refused.to_string().contains("/nowhere/at/all.toml; check that it exists"), "{refused}");
}

#[test]
fn an_unknown_key_is_named_with_its_line_and_the_keys_that_there_are() {
    let expected = "line 3: there is no setting \"bord\"; use one of board, tables, kernel, frame, fit, report, \
                    overwrite, timeout, retry_limit, reconnect, at_speed, require_hardware, seed";
    assert_eq!(sentence("seed = 1\n\nbord = 'mock'\nabord = 1\n"), expected);
}

#[test]
fn an_unknown_section_is_a_key_too() {
    assert!(
        sentence("seed = 1\n[station]\nboard = 'mock'\n")
            .starts_with("line 2: there is no setting \"station\"")
    );
}

#[test]
fn a_value_of_the_wrong_kind_is_named_with_its_line() {
    let expected = "line 2: invalid type: string \"mock\", expected a sequence; correct or remove that line";
    assert_eq!(sentence("seed = 1\nframe = \"mock\"\n"), expected);
    assert!(sentence("seed = -1").starts_with("line 1: invalid value: integer `-1`"));
}

#[test]
fn a_time_that_is_none_is_refused() {
    let expected =
        "line 1: -1 is no time in seconds, which is 0 or more and at most 1e9; correct or remove that line";
    assert_eq!(sentence("reconnect = -1"), expected);
    let expected =
        "line 1: 0 is no time in seconds, which is more than 0 and at most 1e9; correct or remove that line";
    assert_eq!(sentence("timeout = 0"), expected);
    assert!(load("reconnect = 0").is_ok() && load("at_speed = 0").is_ok());
    for timeout in ["-1", "nan", "inf", "1e300"] {
        let refused = load(&format!("timeout = {timeout}"));
        assert!(matches!(refused, Err(SettingsError::Value { line: 1, .. })), "{timeout}");
    }
}

#[test]
fn a_share_that_is_none_is_refused() {
    let expected = "line 2: 101 is no share in percent, which is 0 to 100; correct or remove that line";
    assert_eq!(sentence("\nretry_limit = 101"), expected);
    for percent in ["nan", "-0.1"] {
        let refused = load(&format!("retry_limit = {percent}"));
        assert!(matches!(refused, Err(SettingsError::Value { line: 1, .. })), "{percent}");
    }
}

#[test]
fn a_key_that_is_there_twice_is_refused() {
    assert!(matches!(load("seed = 1\nseed = 2"), Err(SettingsError::Value { line: 2, .. })));
}

#[test]
fn text_that_is_no_toml_is_refused_with_its_line() {
    assert!(matches!(load("seed = 1\nboard = \n"), Err(SettingsError::Value { line: 2, .. })));
}

proptest::proptest! {
    #[test]
    fn no_text_makes_the_reader_panic(text in "(board|seed|frame|timeout)?[ =\\[\\]\"'\\n0-9a-z.é-]{0,40}") {
        let _ = load(&text);
    }
}
