//! A board that a process may still have when its run is over.

use std::process::Command;
use std::time::Instant;

use halfrow::verdict::StoppedBy;
use halfrow_station::settings::Settings;

use super::{any, at_work, job, plan, settings, shared, states, with_a_job};
use crate::common::{Did, program};
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
