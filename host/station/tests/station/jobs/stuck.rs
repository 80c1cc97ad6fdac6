//! A board that a process may still have when its run is over.

use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use halfrow::verdict::StoppedBy;
use halfrow_station::settings::Settings;
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use tempfile::TempDir;

use super::disk::Worker;
use super::{any, at_work, job, plan, settings, settings_of, shared, states, with_a_job};
use crate::common::{Did, free_port, program, until_found};
use crate::history::made::Made;
use crate::lanes::floor::HANG;
use crate::lanes::stuck::Stuck;
use crate::runs::outlived::Outlived;

#[test]
fn a_board_whose_lane_cannot_be_killed_is_taken_out_and_not_given_back() {
    let (server, mut plant) = shared(1);
    let (plan, any) = (plan(), any());
    plant.add_jobs(&job(&plan, &any), 2).unwrap();
    let folder = crate::common::folder();
    let path = settings(&server, folder.path(), "12");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text.replace("[station]", "[station]\nsilence = 5")).unwrap();
    let settings = Settings::load_without_lanes(&path).unwrap();
    let stuck = Stuck::in_folder(folder.path());
    let work = at_work(&settings, stuck.program.clone());
    let claim = work.claim().unwrap().unwrap();
    // Nothing is sent on here, so the worker waits until the board is lost.
    let begun = Instant::now();
    let stop = || (begun.elapsed() > HANG).then_some(StoppedBy::Person);
    let judged = work.judge(claim, &stop, &mut |_| ()).unwrap();
    assert!(judged.saved.record.conclusion.headline.contains("could not even be killed"), "{judged:?}");
    let out = server.rows("SELECT out FROM board").concat();
    assert!(out[0].contains("a process of station 12 may still have it"), "{out:?}");
    assert_eq!(work.claim().unwrap(), None);
}

/// A station without its plant, in whose lane `shelf-0` a process outlived it: its settings, in `folder`.
fn outlived_without_plant(port: u16, folder: &Path) -> (PathBuf, Outlived, TempDir) {
    let mut made = Made::new();
    let outlived = Outlived::of(&mut made, "shelf-0");
    let data = made.closed();
    let path = settings_of(&format!("postgres://postgres@127.0.0.1:{port}/plant"), folder, "12");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text.replace("\"data\"", &format!("{:?}", data.path()))).unwrap();
    (path, outlived, data)
}

/// The plant would lend the board again as soon as it has the run.
#[test]
fn a_call_for_what_there_is_ends_when_the_plant_cannot_be_told_that_a_board_is_out() {
    let folder = crate::common::folder();
    let (path, _outlived, _data) = outlived_without_plant(free_port(), folder.path());
    let mut call = Command::new("timeout");
    call.arg(HANG.as_secs().to_string()).arg(program()).args(["work", "--once", "--settings"]).arg(&path);
    let did = Did::from(call.output().unwrap());
    assert!(did.code == Some(3) && did.complained.contains("refuses a connection"), "{did:?}");
}

/// It accepts a connection, and says nothing.
#[test]
fn a_station_ends_when_it_is_told_to_though_the_plant_cannot_be_told_that_a_board_is_out() {
    let plant = TcpListener::bind("127.0.0.1:0").unwrap();
    let folder = crate::common::folder();
    let (path, _outlived, _data) = outlived_without_plant(plant.local_addr().unwrap().port(), folder.path());
    let mut call = Command::new(program());
    let mut worker =
        Worker(call.args(["work", "--settings"]).arg(path).stderr(Stdio::null()).spawn().unwrap());
    let _asked = plant.accept().unwrap();
    kill(Pid::from_raw(worker.0.id() as i32), Signal::SIGTERM).unwrap();
    let ended = until_found("its end", || worker.0.try_wait().unwrap().ok_or("at work"));
    assert_eq!(ended.code(), Some(143));
}

/// The station was killed meanwhile, and the lease of the board has run out.
#[test]
fn a_board_whose_lane_outlived_its_station_is_taken_out_before_another_job_is_taken() {
    let (server, ..) = with_a_job();
    let mut made = Made::new();
    let _outlived = Outlived::of(&mut made, "shelf-0");
    let (data, folder) = (made.closed(), crate::common::folder());
    let path = settings(&server, folder.path(), "12");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text.replace("\"data\"", &format!("{:?}", data.path()))).unwrap();
    let did: Did =
        Command::new(program()).args(["work", "--once", "--settings"]).arg(&path).output().unwrap().into();
    let out = server.rows("SELECT out FROM board").concat();
    assert!(out.concat().contains("a process of station 12 may still have it"), "{out:?} {did:?}");
    assert_eq!(states(&server), [["waiting", "0"]]);
}
