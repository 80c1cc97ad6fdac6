//! A board that a process may still have when its run is over.

use std::time::Instant;

use halfrow::verdict::StoppedBy;
use halfrow_station::settings::Settings;

use super::{any, at_work, job, plan, settings, shared};
use crate::lanes::floor::HANG;
use crate::lanes::stuck::Stuck;

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
