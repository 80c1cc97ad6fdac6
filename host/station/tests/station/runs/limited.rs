//! What a lane may use, and what a station's folder may be on.

use std::fs;
use std::process::{Command, Stdio};

use super::bench::{Did, PLAN, Station, program};
use super::ends::lane_of;
use crate::common::{instead, silent_board};
use crate::pages::station as pages;

fn with(station: &Station, more: &[&str]) -> Did {
    Command::new(program())
        .args(station.run_arguments("CAT00001", "mock"))
        .args(more)
        .output()
        .unwrap()
        .into()
}

#[test]
fn a_lane_has_one_thread_to_judge_with_and_so_much_memory() {
    let station = Station::with(PLAN);
    let (listener, target) = silent_board();
    let mut running = Command::new(program())
        .args(station.run_arguments("CAT00001", &target))
        .args(["--memory", "1000"])
        .env_remove("RAYON_NUM_THREADS")
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let lane = lane_of(&station, &listener);
    let limits = fs::read_to_string(format!("/proc/{lane}/limits")).unwrap();
    let limit = limits.lines().find(|line| line.starts_with("Max address space")).unwrap();
    assert_eq!(limit.split_whitespace().nth(3), Some("1048576000"), "{limit}");
    let environment = fs::read(format!("/proc/{lane}/environ")).unwrap();
    let files = limits.lines().find(|line| line.starts_with("Max file size")).unwrap();
    assert_eq!(files.split_whitespace().nth(3), Some("67108864"), "{files}");
    // SIGXFSZ, 25, is kept back: what has no room in a file does not end a run.
    let status = fs::read_to_string(format!("/proc/{lane}/status")).unwrap();
    let blocked = status.lines().find_map(|line| line.strip_prefix("SigBlk:")).unwrap().trim();
    assert_eq!(u64::from_str_radix(blocked, 16).unwrap() >> 24 & 1, 1, "{blocked}");
    assert!(environment.split(|&byte| byte == 0).any(|one| one == b"RAYON_NUM_THREADS=1"));
    running.kill().unwrap();
    running.wait().unwrap();
}

#[test]
fn a_lane_that_needs_more_memory_ends_alone_and_is_recorded() {
    let large =
        PLAN.replace("width = 64\nheight = 8", "width = 2048\nheight = 2048").replace("10.0", "1500.0");
    let station = Station::with(&large);
    let did = with(&station, &["--memory", "64"]);
    assert_eq!(did.code, Some(3), "{did:?}");
    assert!(did.said.contains("the lane ended before it was done"), "{did:?}");
    assert_eq!(station.query("SELECT verdict || ' ' || cause FROM run"), ["ERROR crash"], "{did:?}");
    assert_eq!(with(&station, &[]).code, Some(0));
    assert_eq!(station.check().code, Some(0));
    assert_eq!(with(&station, &["--memory", "63"]).code, Some(2));
}

#[test]
fn a_folder_that_is_memory_is_refused_before_anything_is_made() {
    let memory = tempfile::tempdir_in("/dev/shm").unwrap();
    let station = Station::with(PLAN);
    let data = memory.path().join("data");
    let mut arguments = station.run_arguments("CAT00001", "mock");
    let place = arguments.iter().position(|one| one == "--data").unwrap();
    arguments[place + 1] = data.display().to_string();
    let run = |more: &[&str]| -> Did {
        Command::new(program()).args(&arguments).args(more).output().unwrap().into()
    };
    let did = run(&[]);
    assert_eq!(did.code, Some(2), "{did:?}");
    assert!(
        did.complained.contains("is on tmpfs, which is memory; put the station's folder on a disk"),
        "{did:?}"
    );
    assert!(!data.exists());
    assert_eq!(run(&["--any-disk"]).code, Some(0));
}

/// All commands that store results check the disk, and say the same words.
#[test]
fn whatever_keeps_results_refuses_a_folder_that_is_memory() {
    let memory = tempfile::tempdir_in("/dev/shm").unwrap();
    let data = memory.path().join("data");
    let station = pages::Station::private(1);
    let settings = station.path("station.toml");
    instead(&settings, "\"data\"", &format!("{data:?}"));
    let demo = memory.path().join("demo");
    let calls =
        [("lanes", "--settings", &settings), ("serve", "--settings", &settings), ("demo", "--folder", &demo)];
    for (command, option, path) in calls {
        let mut call = Command::new(program());
        let call = call.args([command, option]).arg(path).stdin(Stdio::null());
        let did: Did = call.output().unwrap().into();
        assert_eq!(did.code, Some(2), "{command}: {did:?}");
        let refused = "is on tmpfs, which is memory; put the station's folder on a disk";
        assert!(did.complained.contains(refused), "{command}: {did:?}");
    }
    assert_eq!(fs::read_dir(memory.path()).unwrap().count(), 0, "nothing was made");
    drop(pages::Serving::of(pages::command(&settings).arg("--any-disk")));
    assert!(data.join("station.db").exists());
}

/// What a demonstration without a given folder makes is deleted with it, so it may be in memory.
#[test]
fn a_demonstration_that_is_not_kept_may_be_in_memory() {
    let memory = tempfile::tempdir_in("/dev/shm").unwrap();
    let mut demo = Command::new(program());
    let demo = demo.args(["demo", "--lanes", "1", "--port", "0"]).env("TMPDIR", memory.path());
    drop(pages::Serving::of(demo));
}
