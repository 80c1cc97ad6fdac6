//! Where a wrong value comes from: a value of the environment or the settings file is not called the command line's.

use halfrow_tests::program::{Ended, Folder, finish};

use crate::{refused, small};

const FILE: &str = "settings.toml";

/// All variables that `verify` reads besides [`FILE`]'s.
const VARIABLES: [&str; 14] = [
    "HALFROW_MODEL_PATH",
    "HALFROW_BOARD",
    "HALFROW_TABLES",
    "HALFROW_KERNEL",
    "HALFROW_FRAME",
    "HALFROW_FIT",
    "HALFROW_REPORT",
    "HALFROW_OPERATOR",
    "HALFROW_OVERWRITE",
    "HALFROW_TIMEOUT",
    "HALFROW_RETRY_LIMIT",
    "HALFROW_RECONNECT",
    "HALFROW_AT_SPEED",
    "HALFROW_REQUIRE_HARDWARE",
];

fn with_variable(folder: &Folder, (name, value): (&str, &str), more: &[&str]) -> Ended {
    finish(folder.command(small("verify", more)).env(name, value))
}

/// The call is refused, naming the variable and this `reason`.
#[track_caller]
fn blames_it(folder: &Folder, variable: (&str, &str), more: &[&str], reason: &str) {
    let ended = with_variable(folder, variable, more);
    assert_eq!(ended.code, Some(2), "{variable:?}: {}", ended.stderr);
    for part in [variable.0, reason] {
        assert!(ended.stderr.contains(part), "{variable:?} says: {}", ended.stderr);
    }
}

/// CI files unset a variable this way.
#[test]
fn an_empty_variable_is_none() {
    let folder = Folder::new();
    folder.write(FILE, "seed = 5\nkernel = 'keys'\nrequire_hardware = true\nreport = 'out'\n");
    let call = small("verify", &["--json", "--settings", FILE, "--require-hardware=no"]);
    let all = VARIABLES.into_iter().chain(["HALFROW_SEED", "HALFROW_SETTINGS"]);
    let ended = finish(folder.command(call).envs(all.map(|name| (name, "")))).succeeded();
    assert_eq!(ended.json()["run"]["seed"], 5);
    assert_eq!(ended.json()["tables"]["kernel_crc32"], "54f5e990");
    assert!(folder.path().join("out/report.html").exists());
    let call = small("verify", &["--settings", FILE]);
    let variables = [("HALFROW_REQUIRE_HARDWARE", ""), ("HALFROW_OVERWRITE", "yes")];
    let of_the_file = finish(folder.command(call).envs(variables));
    assert_eq!(of_the_file.code, Some(5), "{}", of_the_file.stderr);
    let help = finish(folder.command(["verify", "--help"]).env("HALFROW_TIMEOUT", ""));
    assert!(help.stdout.contains("[env: HALFROW_TIMEOUT=]"), "{}", help.stdout);
}

/// Each is right by itself, but not together with the rest of the call.
#[test]
fn a_value_of_the_environment_that_does_not_fit_is_told_as_the_variable_s() {
    let folder = Folder::new();
    for (variable, more, reason) in [
        (("HALFROW_KERNEL", "sharp7"), ["--board", "mock,taps=five"], "the board has five"),
        (("HALFROW_AT_SPEED", "5"), ["--within", "2"], "do not fit into 2 s"),
    ] {
        blames_it(&folder, variable, &more, reason);
    }
}

#[test]
fn a_wrong_value_of_the_environment_is_told_as_the_variable_s() {
    let folder = Folder::new();
    for (name, value, reason) in [
        ("HALFROW_TIMEOUT", "abc", "give a number of seconds"),
        ("HALFROW_TIMEOUT", "-1", "--timeout takes a number of seconds"),
        ("HALFROW_AT_SPEED", "-1", "--at-speed takes a number of seconds"),
        ("HALFROW_AT_SPEED", "1e30", "give 0 or more, and at most 1e9"),
        ("HALFROW_RECONNECT", "-1", "--reconnect takes a number of seconds"),
        ("HALFROW_SEED", "-1", "give a whole number"),
        ("HALFROW_BOARD", "moon", "`moon` is not a known kind of board"),
        ("HALFROW_BOARD", "mock,foo=1", "`foo` is not an option of this board"),
        ("HALFROW_BOARD", "mock,fault=stuck-data,bit=99", "bit"),
        ("HALFROW_BOARD", "replay:gone", "the recording gone cannot be read"),
        ("HALFROW_KERNEL", "nope", "there is no file nope"),
        ("HALFROW_FRAME", "nope.pgm", "cannot read nope.pgm"),
        ("HALFROW_FRAME", "builtin:moon", "`moon` is no built-in frame"),
        ("HALFROW_TABLES", "nope.json", "cannot read nope.json"),
        ("HALFROW_REPORT", "no/way", "into the folder no;"),
        ("HALFROW_OVERWRITE", "maybe", "say yes or no"),
        ("HALFROW_MODEL_PATH", "maybe", "avx512"),
        ("HALFROW_SETTINGS", "nope.toml", "cannot read the settings file nope.toml"),
    ] {
        blames_it(&folder, (name, value), &[], reason);
    }
    for (more, value) in [(["--timeout", "abc"], "abc"), (["--timeout", "abc"], "1")] {
        let ended = with_variable(&folder, ("HALFROW_TIMEOUT", value), &more);
        assert!(!ended.stderr.contains("HALFROW_TIMEOUT"), "{}", ended.stderr);
    }
    let ended = with_variable(&folder, ("HALFROW_KERNEL", "nope"), &["--kernel", "none"]);
    assert!(!ended.stderr.contains("HALFROW_KERNEL"), "{}", ended.stderr);
}

/// A file's name need not be text, so that not every variable of this kind is wrong.
#[test]
fn a_variable_that_is_no_text_is_named_where_it_must_be_text() {
    use std::os::unix::ffi::OsStrExt as _;
    let folder = Folder::new();
    let other = std::ffi::OsStr::from_bytes(b"\xff");
    let names = ["HALFROW_KERNEL", "HALFROW_OPERATOR"];
    let ended = finish(folder.command(small("verify", &["--json"])).envs(names.map(|name| (name, other))));
    let error = &ended.json()["error"];
    assert_eq!(
        error["message"],
        "HALFROW_OPERATOR in the environment is no text in UTF-8; write it in UTF-8, or unset it",
        "{}",
        ended.stderr
    );
    assert_eq!((ended.code, &error["code"]), (Some(2), &"usage-value-wrong".into()));
}

#[test]
fn a_wrong_value_of_the_settings_file_is_told_with_the_file_and_the_key() {
    let folder = Folder::new();
    for (key, value, reason) in [
        ("board", "'moon'", "`moon` is not a known kind of board"),
        ("board", "'mock,foo=1'", "`foo` is not an option of this board"),
        ("kernel", "'nope'", "there is no file nope"),
        ("frame", "['nope.pgm']", "cannot read nope.pgm"),
        ("frame", "['builtin:moon']", "`moon` is no built-in frame"),
        ("tables", "'nope.json'", "cannot read nope.json"),
        ("report", "'no/way'", "into the folder no;"),
    ] {
        folder.write(FILE, format!("{key} = {value}\n"));
        let call = small("verify", &["--settings", FILE]);
        refused(&folder, &call, &format!("`{key}` in the settings file {FILE} cannot be used: "));
        refused(&folder, &call, reason);
    }
    let call = small("verify", &["--settings", FILE, "--report", "no/other"]);
    let ended = folder.halfrow(call);
    assert!(!ended.stderr.contains("settings file"), "{}", ended.stderr);
}

/// The document has the same sentence, and the code of the reason.
#[test]
fn json_names_the_place_and_keeps_the_reason_s_code() {
    let folder = Folder::new();
    let ended = with_variable(&folder, ("HALFROW_KERNEL", "nope"), &["--json"]);
    let error = &ended.json()["error"];
    assert_eq!(error["message"], "HALFROW_KERNEL in the environment cannot be used");
    assert_eq!(error["code"], "kernel-not-found");
    let ended = with_variable(&folder, ("HALFROW_TIMEOUT", "abc"), &["--json"]);
    let message = ended.json()["error"]["message"].as_str().unwrap().to_owned();
    assert!(message.contains("HALFROW_TIMEOUT"), "{message}");
}

#[test]
fn a_wrong_kernel_of_the_environment_is_so_told_by_every_command_that_takes_one() {
    let folder = Folder::new();
    let small = ["--width", "64", "--height", "16", "--radius", "40"];
    let calls: [&[&str]; 3] = [
        &["tables", "-o", "t.json"],
        &["correct", "builtin:noise", "--model", "-o", "o.pgm"],
        &["soak", "--frames", "1"],
    ];
    for call in calls {
        let ended = finish(folder.command(call.iter().copied().chain(small)).env("HALFROW_KERNEL", "nope"));
        assert_eq!(ended.code, Some(2), "{call:?}: {}", ended.stderr);
        assert!(ended.stderr.contains("HALFROW_KERNEL in the environment"), "{call:?}: {}", ended.stderr);
    }
}
