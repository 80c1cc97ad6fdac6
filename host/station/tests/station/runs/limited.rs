//! What a lane may have, and what a station's folder may be on.

use std::fs;
use std::process::{Command, Stdio};

use super::bench::{Did, PLAN, Station, program};
use super::ends::{lane_of, silent_board};

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
    assert!(environment.split(|&byte| byte == 0).any(|one| one == b"RAYON_NUM_THREADS=1"));
    running.kill().unwrap();
    running.wait().unwrap();
}

#[test]
fn a_lane_that_needs_more_memory_ends_alone_and_is_recorded() {
    let station = Station::with(PLAN);
    let did = with(&station, &["--memory", "64"]);
    assert_eq!(did.code, Some(3), "{did:?}");
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
