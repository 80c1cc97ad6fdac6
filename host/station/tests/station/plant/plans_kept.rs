//! Stations that start with the plans that they have.

use std::fs;
use std::net::TcpListener;
use std::os::unix::fs::PermissionsExt as _;
use std::process::Command;

use super::plans::Published;
use crate::common::{Did, instead, program, unmasked};

#[test]
fn a_station_starts_with_what_it_has_when_the_plant_is_away() {
    let mut made = Published::new();
    made.publish("engel.key");
    let lanes = |made: &Published| made.did(&["lanes", "--any-disk"]);
    made.server.kill();
    let without = lanes(&made);
    assert!(without.code == Some(3) && without.complained.contains("refuses a connection"), "{without:?}");
    assert!(without.complained.contains("no copy of CAM-T/quick is in "), "{without:?}");
    made.server.again();
    assert_eq!(lanes(&made).code, Some(0), "it fetches when it starts");
    made.server.kill();
    let with = lanes(&made);
    assert!(with.code == Some(0) && with.complained.contains("the plans stay as they are"), "{with:?}");
}

/// As after the station's computer failed: its folder comes from a backup, and the plant is away.
#[test]
fn a_restored_station_starts_with_the_plans_that_it_had() {
    let mut made = Published::new();
    made.publish("engel.key");
    assert_eq!(made.did(&["lanes", "--any-disk"]).code, Some(0));
    made.server.kill();
    let [data, copy] = ["data", "copy"].map(|name| made.path(name));
    assert_eq!(made.did(&["backup", &copy, "--data", &data]).code, Some(0));
    fs::remove_dir_all(&data).unwrap();
    assert_eq!(made.did(&["restore", &copy, "--data", &data]).code, Some(0));
    assert_eq!(made.held(), ("1".to_owned(), 1));
    let started = made.did(&["lanes", "--any-disk"]);
    assert!(started.code == Some(0) && started.complained.contains("the plans stay"), "{started:?}");
}

/// The plant accepts connections, and then stays silent for ever.
#[test]
fn a_station_starts_with_what_it_has_when_the_plant_does_not_answer() {
    let made = Published::new();
    made.publish("engel.key");
    made.fetch();
    let mute = TcpListener::bind("127.0.0.1:0").unwrap();
    let url = format!("postgres://halfrow@{}/plant", mute.local_addr().unwrap());
    instead(made.path("station.toml"), &made.server.url(), &url);
    let started = made.did(&["lanes", "--any-disk"]);
    assert!(
        started.code == Some(0) && started.complained.contains("the plans stay as they are"),
        "{started:?}"
    );
}

/// By the umask others could put a plan or a database there.
#[test]
fn a_folder_that_is_made_for_plans_is_closed_to_others() {
    let made = Published::new();
    assert_eq!(made.publish("engel.key").code, Some(0));
    let mut fetch = Command::new(program());
    fetch.args(["plan", "fetch", "--settings", &made.path("station.toml")]);
    let fetched = Did::from(unmasked(&fetch).output().unwrap());
    assert_eq!(fetched.code, Some(0), "{fetched:?}");
    let mode = fs::metadata(made.path("data")).unwrap().permissions().mode() & 0o777;
    assert_eq!(mode, 0o750, "{mode:o}");
}
