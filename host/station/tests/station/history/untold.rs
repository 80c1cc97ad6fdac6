//! Commands that did what they were asked, and whose stdout takes nothing: their work stands, and so does the exit code.

use std::fs::File;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, SystemTime};

use super::commands;
use super::made::{End, Made, Run};
use crate::common::{Did, check, program};

/// Runs a command on the station in `data`, with a stdout that is full.
fn untold(data: &impl AsRef<Path>, arguments: &[&str]) -> Did {
    let full = File::options().write(true).open("/dev/full").unwrap();
    let mut call = Command::new(program());
    call.args(arguments).arg("--data").arg(data.as_ref()).stdout(full).output().unwrap().into()
}

/// A run that failed, with evidence.
fn failed() -> (Made, String) {
    let mut made = Made::new();
    let id = made.run(&Run { evidence: vec!["seen"], ..Run::of("S1", End::Fail(&["memory"])) });
    (made, id)
}

/// Whoever takes a copy for not made tries again, and is refused because of it.
#[test]
fn what_is_made_counts_though_nobody_could_be_told() {
    let (made, id) = failed();
    let place = tempfile::tempdir().unwrap();
    let [copy, back, csv, junit, seen] =
        ["copy", "back", "out.csv", "junit", "seen"].map(|name| place.path().join(name));
    let [copy_name, csv_name, junit_name, seen_name] =
        [&copy, &csv, &junit, &seen].map(|path| path.to_str().unwrap());
    for call in [
        &["backup", copy_name][..],
        &["export", "--format", "csv", "--to", csv_name],
        &["export", "--format", "junit", "--to", junit_name],
        &["evidence", &id, "--to", seen_name],
    ] {
        let did = untold(&made, call);
        assert!(did.code == Some(0) && did.complained.contains("the exit code stands"), "{call:?}: {did:?}");
    }
    let did = untold(&back, &["restore", copy_name]);
    assert!(did.code == Some(0) && did.complained.contains("the exit code stands"), "{did:?}");
    assert_eq!(check(&back).code, Some(0));
    assert!(csv.is_file() && junit.is_dir() && seen.join("seen.txt").is_file());
}

#[test]
fn what_was_changed_stays_changed_though_nobody_could_be_told() {
    let (made, _) = failed();
    let piece = made.folder().blobs().path(&made.folder().blobs().put(b"nobody's").unwrap());
    let aged = SystemTime::now() - Duration::from_secs(25 * 3600);
    File::options().append(true).open(&piece).unwrap().set_modified(aged).unwrap();
    let folder = made.closed();
    for call in [&["prune", "--operator", "weber"][..], &["prune", "--operator", "weber", "--json"]] {
        let did = untold(&folder, call);
        assert!(did.code == Some(0) && did.complained.contains("the exit code stands"), "{call:?}: {did:?}");
    }
    assert!(!piece.exists());
}

/// That a stream is full hides nothing.
#[test]
fn runs_that_an_export_lacks_are_named_though_stdout_takes_nothing() {
    let (made, id) = failed();
    let record = made.folder().verdict_of(&id).unwrap().unwrap().record_sha256;
    std::fs::remove_file(made.folder().blobs().path(&record)).unwrap();
    let place = tempfile::tempdir().unwrap();
    let call = ["export", "--format", "csv", "--to"];
    let [one, other] = ["one", "other"].map(|name| place.path().join(name));
    let did = untold(&made, &[&call[..], &[one.to_str().unwrap()]].concat());
    assert!(did.code == Some(3) && did.complained.contains("these runs are missing there"), "{did:?}");
    let (code, _, complained) = commands::did(&made, &[&call[..], &[other.to_str().unwrap()]].concat());
    assert!(code == 3 && complained.contains("these runs are missing there"), "the control: {complained}");
}
