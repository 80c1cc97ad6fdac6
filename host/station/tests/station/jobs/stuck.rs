//! A board that a process may still have when its run is over.

use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use halfrow::verdict::StoppedBy;
use halfrow_station::run::Stage;
use halfrow_station::settings::Settings;
use nix::sys::signal::Signal;
use tempfile::TempDir;

use super::{add, at_work, judged, settings, settings_of, shared, states, with_a_job};
use crate::common::{
    Did, Killed, accepted, command, did_in, engel, free_port, instead, program, reason, signal, until_found,
};
use crate::history::made::Made;
use crate::lanes::floor::HANG;
use crate::lanes::stuck::Stuck;
use crate::plant::server::Server;
use crate::runs::outlived::Outlived;

/// The settings, in `folder`, of a station whose lanes stay silent and cannot be killed, and their program.
fn with_stuck_lanes(server: &Server, folder: &Path) -> (Settings, Stuck) {
    let path = settings(server, folder, "12");
    instead(&path, "[station]", "[station]\nsilence = 15");
    (Settings::load_without_lanes(&path).unwrap(), Stuck::in_folder(folder))
}

#[test]
fn a_board_whose_lane_cannot_be_killed_is_taken_out_and_not_given_back() {
    let (server, mut plant) = shared(1);
    add(&mut plant, 2);
    let folder = crate::common::folder();
    let (settings, stuck) = with_stuck_lanes(&server, folder.path());
    let work = at_work(&settings, stuck.program.clone());
    // Nothing is sent on here, so the worker waits until the board is lost.
    let judged = judged(&work);
    assert!(judged.saved.record.conclusion.headline.contains("could not even be killed"), "{judged:?}");
    let out = server.rows("SELECT out FROM board").concat();
    assert!(out[0].contains("a process of station 12 may still have it"), "{out:?}");
    assert_eq!(work.claim().unwrap(), None);
}

/// The verdict is saved by then, and whoever called waits for it; so does the error of another hand.
#[test]
fn a_verdict_does_not_wait_for_a_plant_that_cannot_be_told_that_a_board_is_out_when_no_more_is_begun() {
    let (server, mut plant, id) = with_a_job();
    let refuses =
        "CREATE FUNCTION refuses() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN RAISE 'not now'; END $$;
        CREATE TRIGGER refuses BEFORE UPDATE OF out ON board FOR EACH ROW EXECUTE FUNCTION refuses()";
    server.change(refuses);
    let folder = crate::common::folder();
    let (settings, stuck) = with_stuck_lanes(&server, folder.path());
    let work = at_work(&settings, stuck.program.clone());
    let claim = work.claim().unwrap().unwrap();
    let begun = Instant::now();
    let stop = || (begun.elapsed() > HANG).then_some(StoppedBy::Person);
    let mut heard = |stage: Stage<'_>| {
        if matches!(stage, Stage::Saving { is_stuck: true, .. }) {
            // Nothing is sent on here, so the worker would wait until the job is lost.
            assert!(plant.cancel_job(&id, engel(&reason("a mistake"))).unwrap());
        }
    };
    let judged = work.judge(claim, &stop, &|| Some(StoppedBy::Caller), &mut heard).unwrap();
    assert!(stop().is_none(), "it ended by itself");
    assert!(judged.saved.record.conclusion.headline.contains("could not even be killed"), "{judged:?}");
    assert!(judged.not_out.is_some_and(|why| why.to_string().contains("refuses to take a board out")));
    assert_eq!(server.rows("SELECT out FROM board"), [["NULL"]], "the control");
}

/// A station without its plant, in whose lane `shelf-0` a process outlived it: its settings, in `folder`.
fn outlived_without_plant(port: u16, folder: &Path) -> (PathBuf, Outlived, TempDir) {
    let mut made = Made::new();
    let outlived = Outlived::of(&mut made, "shelf-0");
    let data = made.closed();
    let path = settings_of(&format!("postgres://postgres@127.0.0.1:{port}/plant"), folder, "12");
    instead(&path, "\"data\"", &format!("{:?}", data.path()));
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
    let _outlived = outlived_without_plant(plant.local_addr().unwrap().port(), folder.path());
    let mut worker = Killed(command(folder.path(), &["work"]).spawn().unwrap());
    let _asked = accepted(&plant);
    signal(worker.id(), Signal::SIGTERM);
    let ended = until_found("its end", || worker.try_wait().unwrap().ok_or("at work"));
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
    instead(path, "\"data\"", &format!("{:?}", data.path()));
    let did = did_in(folder.path(), &["work", "--once"]);
    let out = server.rows("SELECT out FROM board").concat();
    assert!(out.concat().contains("a process of station 12 may still have it"), "{out:?} {did:?}");
    assert_eq!(states(&server), [["waiting", "0"]]);
}
