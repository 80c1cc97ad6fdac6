//! A result that cannot be saved does not count.

use std::collections::BTreeMap;
use std::fs::Permissions;
use std::iter;
use std::os::unix::fs::PermissionsExt as _;
use std::process::Command;

use super::bench::{Did, PLAN, Station, program};

/// A run under strace, which makes calls fail or kills the program at them.
pub(crate) fn injected(station: &Station, serial: &str, inject: &str) -> Did {
    Command::new("strace")
        .args(["-qq", "-o", "/dev/null", "-e"])
        .arg(format!("inject={inject}"))
        .arg(program())
        .args(station.run_arguments(serial, "mock"))
        .output()
        .unwrap()
        .into()
}

/// A system call of a run: its name, and its number among the calls of that name, from 1.
pub(crate) type Call = (String, usize);

/// The calls of these names that a run makes, in order.
pub(crate) fn calls(station: &Station, serial: &str, names: &str) -> Vec<Call> {
    let trace = station.path("calls");
    let traced = Command::new("strace")
        .args(["-qq", "-e", &format!("trace={names}"), "-e", "signal=none", "-o"])
        .arg(&trace)
        .arg(program())
        .args(station.run_arguments(serial, "mock"))
        .output()
        .unwrap();
    assert!(traced.status.success(), "{traced:?}");
    numbered(&std::fs::read_to_string(&trace).unwrap())
}

/// The calls in a trace by strace, in order.
pub(crate) fn numbered(trace: &str) -> Vec<Call> {
    let mut counts = BTreeMap::new();
    let names = trace.lines().filter_map(|line| line.split_once('(')).map(|(name, _)| name.to_owned());
    let numbered = names.map(|name| {
        let count = counts.entry(name.clone()).or_insert(0);
        *count += 1;
        (name, *count)
    });
    numbered.collect()
}

/// What a run says whose verdict was not saved.
const UNSAVED: &str = "UNSAVED CAT00002: keep this board apart";
/// How many of the last places at which no verdict is shown are looked at: which call writes it differs a little from run to run.
const FEW: usize = 8;

/// Lets calls fail from each of the chosen `places` on. A verdict is on the screen only if it is in the store, and the station
/// works again as soon as the disk does.
fn starve(places: impl Fn(usize) -> Vec<usize>) {
    let station = Station::with(PLAN);
    station.run("CAT00001", "mock");
    for (call, error) in [("pwrite64", "ENOSPC"), ("fsync", "EIO"), ("pwrite64", "EROFS")] {
        let all = calls(&station, "CAT00001", call).len();
        assert!(all > 2, "{all} calls of {call}");
        let fails_from =
            |&first: &usize| unless_saved(&station, &format!("{call}:error={error}:when={first}+"));
        for first in places(all) {
            fails_from(&first);
        }
        let places: Vec<_> = (1..=all).collect();
        let unshown = places.partition_point(|first| fails_from(first).is_some());
        let last = places[..unshown].iter().rev().take(FEW);
        let is_told = last.filter_map(fails_from).any(|did| did.said.contains(UNSAVED));
        assert!(is_told, "no run came to its end and was not saved: {call}, {error}");
    }
    assert_eq!(station.query("SELECT count(*) FROM run WHERE state = 'open'"), ["0"]);
    assert_eq!(station.check().code, Some(0), "{:?}", station.check());
}

/// A run in which calls fail at `place`, unless its verdict was saved, and so shown.
fn unless_saved(station: &Station, place: &str) -> Option<Did> {
    let stored = || {
        station.query(
            "SELECT count(*) FROM run JOIN unit ON unit.id = unit_id
            WHERE serial = 'CAT00002' AND verdict = 'PASS'",
        )
    };
    let before = stored();
    let did = injected(station, "CAT00002", place);
    let is_shown = did.said.contains("PASS");
    assert_eq!(is_shown, did.code == Some(0), "{did:?}");
    assert!(!is_shown || stored() != before, "{place}: {did:?}");
    assert!(is_shown || did.code == Some(3), "{place}: {did:?}");
    let after = station.run("CAT00003", "mock");
    assert_eq!(after.code, Some(0), "{place}: {after:?}");
    (!is_shown).then_some(did)
}

#[test]
fn no_verdict_is_shown_that_the_disk_did_not_take() {
    starve(|all| [1, all / 3, all / 2, 2 * all / 3].map(|place| place.max(1)).to_vec());
}

/// A run of CAT00002 in which the call `name` fails once, the `number`-th time, and that call with the file that it is for; none if
/// there are not as many.
fn failing(station: &Station, board: &str, name: &str, number: usize) -> (Did, Option<String>) {
    let (trace, inject) = (station.path("failed"), format!("inject={name}:error=EIO:when={number}"));
    let output = Command::new("strace")
        .args(["-qq", "-y", "-e", &format!("trace={name}"), "-e", &inject, "-o"])
        .arg(&trace)
        .arg(program())
        .args(station.run_arguments("CAT00002", board))
        .output()
        .unwrap();
    let trace = std::fs::read_to_string(trace).unwrap();
    (output.into(), trace.lines().find(|line| line.contains("(INJECTED)")).map(str::to_owned))
}

/// Nobody could test the unit again before the next start if the run were taken for one that was not begun.
#[test]
fn a_run_that_was_entered_just_before_the_folder_went_away_is_one_that_could_not_be_saved() {
    let station = Station::with(PLAN);
    station.run("CAT00001", "mock");
    // No call has this number.
    failing(&station, "mock", "statx", 65_535);
    let trace = std::fs::read_to_string(station.path("failed")).unwrap();
    let is_look = |line: &str| line.contains("/data/blobs\"");
    let looks: Vec<_> = (1..).zip(trace.lines()).filter(|(_, line)| is_look(line)).collect();
    let mut seen = 0;
    for (number, _) in looks {
        let (did, call) = failing(&station, "mock", "statx", number);
        let open = station.query("SELECT id FROM run WHERE state = 'open'");
        if let [run] = &open[..] {
            assert!(did.said.contains(UNSAVED), "{call:?}: {did:?}");
            seen += usize::from(!station.data().join("spool").join(run).exists());
        }
        assert_eq!(station.run("CAT00003", "mock").code, Some(0), "{call:?}: {did:?}");
    }
    assert!(seen > 0, "no run was entered and then not begun: {trace}");
}

/// A disk reports a lost write once, and accepts what comes later. Three calls bring evidence to the disk, for the file, its
/// name, and the name of its folder; each is checked when it alone fails.
#[test]
fn evidence_that_the_disk_did_not_take_at_once_is_none() {
    let station = Station::with(PLAN);
    station.run("CAT00001", "mock");
    let mut seen = 0;
    for number in 1.. {
        // Evidence then makes its folder anew.
        std::fs::remove_dir_all(station.data().join("blobs")).unwrap();
        let (did, failed) = failing(&station, "mock", "fsync", number);
        let Some(failed) = failed else { break };
        if failed.contains("/data/blobs") {
            assert_eq!(did.code, Some(3), "{failed}: {did:?}");
            assert!(did.said.contains(UNSAVED), "{failed}: {did:?}");
            seen += 1;
        }
        let after = station.run("CAT00003", "mock");
        assert_eq!(after.code, Some(0), "{failed}: {after:?}");
    }
    assert_eq!(seen, 3);
}

/// A file that is damaged, as by a copy that ended early, must not keep every later board with the same frames from its verdict.
#[test]
fn evidence_that_was_damaged_is_written_anew() {
    let station = Station::with(&PLAN.replace("frames =", "seed = 7\nframes ="));
    let fail = |serial| station.run(serial, "mock,fault=stuck-data");
    assert_eq!(fail("CAT00001").code, Some(1));
    let named = station.query("SELECT sha256 FROM attachment WHERE name LIKE '%.png'");
    let path = station.store().blobs().path(&named[0]);
    std::fs::write(&path, "half of it").unwrap();
    std::fs::set_permissions(&path, Permissions::from_mode(0o000)).unwrap();
    assert_eq!(station.check().code, Some(3));
    let again = fail("CAT00002");
    assert_eq!(again.code, Some(1), "{again:?}");
    let both = format!("SELECT count(*) FROM attachment WHERE sha256 = '{}'", named[0]);
    assert_eq!(station.query(&both), ["2"], "both name it");
    assert_eq!(station.check().code, Some(0), "{:?}", station.check());
    let mode = std::fs::metadata(&path).unwrap().permissions().mode();
    assert_ne!(mode & 0o400, 0, "the station can read it");
}

/// What the lane kept of a FAIL stays in its spool when the system does not say what is there.
#[test]
fn frames_that_cannot_be_listed_are_not_left_out() {
    let station = Station::with(PLAN);
    station.run("CAT00001", "mock");
    for number in 1.. {
        let (did, failed) = failing(&station, "mock,fault=stuck-data", "getdents64", number);
        let failed = failed.expect("the spool is listed");
        if !failed.contains("/data/spool/") {
            continue;
        }
        assert_eq!(did.code, Some(3), "{failed}: {did:?}");
        assert!(did.said.contains(UNSAVED), "{failed}: {did:?}");
        // The next run recovers it.
        assert_eq!(station.run("CAT00003", "mock").code, Some(0));
        let hash = station.query("SELECT record_sha256 FROM run WHERE verdict = 'ERROR' ORDER BY id DESC");
        let record = std::fs::read_to_string(station.store().blobs().path(&hash[0])).unwrap();
        assert!(record.contains("-should.png"), "{record}");
        return;
    }
}

/// The first start begins the database; the next one ends it.
#[test]
fn a_database_that_a_full_disk_kept_from_being_made_is_told_as_that() {
    let mut seen = 0;
    for first in iter::successors(Some(1), |first| Some(first + 1 + first / 2)) {
        let station = Station::with(PLAN);
        let did = injected(&station, "CAT00001", &format!("pwrite64:error=ENOSPC:when={first}+"));
        assert_eq!(did.code, Some(3), "{first}: {did:?}");
        let check = station.check();
        let said = match check.code {
            Some(0) => break,
            // There is no database yet.
            Some(2) => "has no station's results",
            _ => "was begun and never finished, as when the disk is full at the first start",
        };
        assert!(check.complained.contains(said), "{first}: {check:?}");
        seen += usize::from(check.code == Some(3));
        assert_eq!(station.run("CAT00001", "mock").code, Some(0), "{first}");
        assert_eq!(station.check().code, Some(0), "{first}: the control");
    }
    assert!(seen > 2, "{seen}");
}

/// From every call on.
#[test]
#[ignore = "for scripts/soak"]
fn no_verdict_is_shown_wherever_the_disk_begins_to_fail() {
    starve(|all| (1..=all).collect());
}
