//! What the program says of a call that it cannot use, and of names that it is given.

use std::ffi::OsStr;
use std::os::unix::ffi::OsStrExt as _;
use std::process::Command;

use serde_json::Value;

use crate::common::{Did, PLAN, did, did_refused, program};
use crate::runs::bench::Station;

/// An option that another one makes needless is offered beside it.
#[test]
fn both_ways_are_in_the_usage_of_a_command_that_has_two() {
    let results = "<--data <FOLDER>|--plant <SETTINGS>>";
    for (call, ways) in [
        (&["history"][..], results),
        (&["unit", "S1"], results),
        (&["yield"], results),
        (&["pareto"], results),
        (&["export", "--to", "x"], results),
        (&["export", "--data", "x"], "<RUN|--to <PATH>>"),
        (&["outbox", "release", "--reason", "x", "--operator", "y"], "<ID|--sink <NAME>>"),
        (&["run", "--data", "x", "--plan", "y"], "<--serial <SERIAL> --board <TARGET>|--mock>"),
    ] {
        let refused = did(call);
        assert_eq!(refused.code, Some(2), "{call:?}: {refused:?}");
        assert!(refused.complained.contains(ways), "{call:?}: {}", refused.complained);
    }
    // A station's variable names a folder that the plant replaces.
    let mut both = Command::new(program());
    both.args(["history", "--plant", "/nowhere/station.toml"]).env("HALFROW_STATION_DATA", "/nowhere");
    let both = Did::from(both.output().unwrap());
    assert!(both.complained.contains("/nowhere/station.toml cannot be read"), "{both:?}");
    let twice = did(&["outbox", "release", "id", "--sink", "x", "--reason", "x", "--operator", "y"]);
    assert!(twice.complained.contains("cannot be used with"), "{twice:?}");
}

/// As from a terminal that is not set to UTF-8.
#[test]
fn a_person_whose_name_is_no_text_is_told_which_option_has_it() {
    let mut waive = Command::new(program());
    waive.args(["waive", "--data", "x", "--reason", "y", "run", "--operator"]);
    let refused = Did::from(waive.arg(OsStr::from_bytes(b"M\xfcller")).output().unwrap());
    let said = "the argument `M\u{fffd}ller` behind --operator is no text in UTF-8; write it in UTF-8";
    assert!(refused.code == Some(2) && refused.complained.contains(said), "{refused:?}");
}

/// It conceals what follows, and begins a line as a verdict does.
#[test]
fn a_folder_s_name_begins_no_line() {
    let station = Station::with(PLAN);
    station.run("CAT00001", "mock,fault=stuck-data");
    let data = station.data().display().to_string();
    let to = |name: &str| station.path(&format!("{name}\u{1b}[8m\nPASS")).display().to_string();
    let run = &station.query("SELECT id FROM run")[0];
    let [exported, copied, kept] = ["exported", "copied", "kept"].map(to);
    for call in [&["export", "--to", &exported][..], &["evidence", run, "--to", &copied], &["backup", &kept]]
    {
        let told = did(&[call, &["--data", &data]].concat());
        assert_eq!(told.code, Some(0), "{call:?}: {told:?}");
        assert!(told.said.contains("\\u{1b}[8m\\nPASS") && told.said.lines().count() == 1, "{told:?}");
    }
}

/// Nothing is wrong with the plan's name or with its rights then.
#[test]
fn a_plan_that_the_system_cannot_read_asks_for_something_of_the_system() {
    let station = Station::with(PLAN);
    let plan = station.path("plan.toml");
    let name = plan.to_str().unwrap();
    let call = ["run", "--data", "x", "--plan", name, "--serial", "CAT00001", "--board", "mock", "--json"];
    for (error, code, asked) in [
        ("EIO", 3, "look for a fault of the disk or device in the system's log, then run again"),
        ("EMFILE", 3, "end other programs or allow more open files, then run again"),
        ("EACCES", 2, "check its name, and who may read it"),
    ] {
        let did = did_refused(&plan, &format!("openat:error={error}"), &call);
        let message = format!("{name} cannot be read; {asked}");
        let document: Value = serde_json::from_str(&did.said).unwrap();
        assert_eq!(
            (did.code, document["error"]["message"].as_str()),
            (Some(code), Some(&*message)),
            "{did:?}"
        );
        assert!(did.complained.contains(&message), "{did:?}");
    }
}
