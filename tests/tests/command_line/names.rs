//! Names of files and boards in what is printed: whatever they hold, they command no terminal and begin no line.

use std::ffi::OsStr;
use std::os::unix::ffi::OsStrExt as _;

use halfrow_tests::program::{Ended, Folder, finish};

use crate::{refused, small};

/// It conceals what follows, begins a line as a verdict does, and reverses the text.
const HOSTILE: &str = "\u{1b}[8mq\nPASS\u{202e}";
/// The same in words.
const SPELT: &str = "\\u{1b}[8mq\\nPASS\\u{202e}";

/// Checks that `text` has the name in words alone.
#[track_caller]
fn assert_spelt(text: &str, what: &str) {
    assert!(text.contains(SPELT), "{what}: {text:?}");
    let is_unfit = |letter: char| letter.is_control() && letter != '\n' || letter == '\u{202e}';
    assert!(!text.contains(is_unfit), "{what}: {text:?}");
    assert!(!text.lines().any(|line| line.starts_with("PASS")), "{what}: {text:?}");
}

/// With colours, which a pipe gets by request: without them the program takes out what it takes for colours.
fn coloured(folder: &Folder, call: &[&str]) -> Ended {
    finish(folder.command(call.iter().copied()).env("CLICOLOR_FORCE", "1"))
}

#[test]
fn a_name_that_was_written_is_told_in_words() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path().join("photos")).unwrap();
    let size = ["--width", "128", "--height", "128"];
    let preview = ["correct", "builtin:street", "--model", "-o", "a.pgm", "--preview", "photos/a.png"];
    assert_eq!(folder.halfrow(preview.into_iter().chain(size)).code, Some(0));
    let named = |ending: &str| format!("{HOSTILE}{ending}");
    let [pgm, png, json, mem] = [".pgm", ".png", ".json", ".mem"].map(named);
    let calls: Vec<Vec<&str>> = vec![
        small("correct", &["builtin:black", "--model", "-o", &pgm]),
        small("correct", &["builtin:black", "--model", "-o", "b.pgm", "--preview", &png]),
        small("tables", &["-o", &json]),
        small("tables", &["-o", &mem]),
        small("lens", &["--map", &png]),
        small("frames", &["--only", "black", "-o", HOSTILE]),
        vec!["kernel", "train", "--images", "photos", "-o", &json],
        vec!["paper", "fig8", "-o", HOSTILE],
    ];
    for call in calls {
        let call = [&["--quiet"][..], &call, &["--overwrite"]].concat();
        for ended in [folder.halfrow(call.iter().copied()), coloured(&folder, &call)] {
            assert_eq!(ended.code, Some(0), "{call:?}: {}", ended.stderr);
            assert_spelt(&ended.stdout, &format!("{call:?}"));
        }
    }
}

#[test]
fn a_name_that_is_read_is_told_in_words() {
    let folder = Folder::new();
    let table = format!("{HOSTILE}.json");
    assert_eq!(folder.halfrow(small("tables", &["-o", &table])).code, Some(0));
    let frame = format!("{HOSTILE}.pgm");
    assert_eq!(folder.halfrow(small("correct", &["builtin:black", "--model", "-o", &frame])).code, Some(0));
    for call in [
        &["correct", "builtin:black", "--model", "--overwrite", "-o", "out.pgm", "--tables", &table][..],
        &["verify", "--list", "--tables", &table, "--frame", &frame],
        &["boards", &format!("serial:/dev/{HOSTILE}")],
    ] {
        for ended in [folder.halfrow(call.iter().copied()), coloured(&folder, call)] {
            assert_eq!(ended.code, Some(0), "{call:?}: {}", ended.stderr);
            assert_spelt(&ended.stdout, &format!("{call:?}"));
        }
    }
}

#[test]
fn a_name_that_cannot_be_used_is_told_in_words() {
    let folder = Folder::new();
    let there = format!("{HOSTILE}.png");
    std::fs::write(folder.path().join(&there), "").unwrap();
    let missing = format!("{HOSTILE}.pgm");
    let device = format!("serial:/dev/{HOSTILE}");
    let mut settings = folder.command(["verify"]);
    settings.env("HALFROW_SETTINGS", format!("{HOSTILE}.toml"));
    for mut call in [
        folder.command(["verify", "--board", "mock", "--frame", &missing]),
        folder.command(["verify", "--board", "mock", "--kernel", &missing]),
        folder.command(["verify", "--board", &device]),
        folder.command(small("correct", &["builtin:black", "--model", "-o", &there])),
        settings,
    ] {
        for ended in [finish(&mut call), finish(call.env("CLICOLOR_FORCE", "1"))] {
            assert_ne!(ended.code, Some(0), "{call:?}");
            assert_spelt(&ended.stderr, &format!("{call:?}"));
        }
    }
}

#[test]
fn a_name_in_the_log_begins_no_line() {
    let folder = Folder::new();
    let call = small("correct", &["builtin:black", "--model", "-o", "b.pgm", "--radius", "40"]);
    let ended = finish(folder.command(call).env("HALFROW_TABLES", format!("{HOSTILE}.json")));
    let lines: Vec<_> = ended.stderr.lines().collect();
    assert!(matches!(lines[..], [line] if line.contains("is passed over")), "{ended:?}");
}

/// Twice: the value as it was given, and in the words of whoever reads it.
#[test]
fn an_argument_that_is_refused_is_told_in_words() {
    let folder = Folder::new();
    let value = format!("\r\u{7}\u{9b}31m{HOSTILE}");
    let [unknown, command] = [format!("--{HOSTILE}"), format!("x{HOSTILE}")];
    for call in [
        &["verify", "--phase", &value][..],
        &["verify", "--rows", &value],
        &["verify", "--width", &value],
        &["verify", &unknown],
        &["serve", &command],
        &[&command],
    ] {
        let ended = coloured(&folder, call);
        assert_eq!(ended.code, Some(2), "{call:?}");
        // Its own colours are all that is left.
        let text = anstream::adapter::strip_str(&ended.stderr).to_string();
        assert_spelt(&text, &format!("{call:?}"));
        assert!(!ended.stderr.contains("\u{1b}[8m"), "{:?}", ended.stderr);
    }
    let ended = folder.halfrow(["verify", "--phase", &value, "--json"]);
    let message = ended.json()["error"]["message"].to_string();
    assert!(message.contains("PASS") && !message.contains("u001b"), "{message}");
}

/// As from a terminal that is not set to UTF-8.
#[test]
fn an_argument_that_must_be_text_is_named_with_what_to_do() {
    let folder = Folder::new();
    for (option, value, named) in [
        (Some("--operator"), &b"M\xfcller"[..], "`M\u{fffd}ller` behind --operator"),
        (None, b"--operator=M\xfcller", "`--operator=M\u{fffd}ller`"),
    ] {
        let mut call = folder.command(["verify", "--json", "--report", "out"]);
        call.args(option).arg(OsStr::from_bytes(value));
        let ended = finish(&mut call);
        let error = &ended.json()["error"];
        assert_eq!((ended.code, &error["code"]), (Some(2), &"usage-value-wrong".into()), "{ended:?}");
        let message = error["message"].as_str().unwrap();
        assert!(message.starts_with(&format!("the argument {named} is no text in UTF-8; ")), "{message}");
        assert!(error["remedy"].as_str().unwrap().starts_with("Write it in UTF-8"), "{error}");
    }
    // The name of a file need not be text.
    let mut call = folder.command(["verify", "--frame"]);
    let ended = finish(call.arg(OsStr::from_bytes(b"M\xfcller.pgm")));
    assert!(!ended.stderr.contains("UTF-8"), "{}", ended.stderr);
    refused(&folder, &["verify", "--operator"], "a value is required for '--operator <NAME>'");
}
