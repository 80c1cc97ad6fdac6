//! `halfrow station`, which starts the program next to it.

use std::process::Command;

use halfrow_tests::program::{Folder, command, finish};

/// Written by another process, so that no process started by other tests has the file open when it is run.
fn shell(folder: &Folder, text: &str, argument: &std::ffi::OsStr) {
    let mut shell = Command::new("sh");
    shell.current_dir(folder.path()).args(["-ec", text, "sh"]).arg(argument);
    finish(&mut shell).succeeded();
}

#[test]
fn the_station_beside_the_program_is_started_or_how_to_get_it_is_told() {
    let folder = Folder::new();
    shell(&folder, "cp \"$1\" halfrow", command([]).get_program());
    let call =
        || finish(Command::new(folder.path().join("halfrow")).args(["station", "run", "--lane", "1", "-v"]));
    let without = call();
    assert_eq!(without.code, Some(2), "{without:?}");
    assert!(without.stderr.contains("cargo build --release --package halfrow-station"), "{without:?}");
    let station = "printf '#!/bin/sh\\necho \"$@\"\\nexit 6\\n' > halfrow-station; chmod +x halfrow-station";
    shell(&folder, station, "".as_ref());
    let started = call();
    assert_eq!((started.code, started.stdout.as_str()), (Some(6), "run --lane 1 -v\n"), "{started:?}");
}

/// Whoever names another station's settings there would be shown this one's.
#[test]
fn what_stands_before_station_is_not_lost() {
    let folder = Folder::new();
    folder.write("s2.toml", "");
    for ours in [&["--settings", "s2.toml"][..], &["-q"], &["-v"], &["--model-path", "scalar"], &["--json"]] {
        for call in [[ours, &["station", "check"]].concat(), [&["station"], ours, &["check"]].concat()] {
            let ended = folder.halfrow(call.iter().copied());
            assert_eq!(ended.code, Some(2), "{call:?}: {ended:?}");
            assert!(ended.stderr.contains("is taken for `halfrow` here"), "{call:?}: {}", ended.stderr);
        }
    }
    let said = folder.halfrow(["--json", "station", "check"]).json();
    assert_eq!(said["error"]["code"], "option-without-effect", "{said}");
}
