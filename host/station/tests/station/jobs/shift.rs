//! Jobs of a plan whose lanes are checked in each shift.

use std::cell::Cell;
use std::fs;

use halfrow::verdict::StoppedBy;
use halfrow_station::plan::Plan;
use halfrow_station::run::Stage;
use halfrow_station::settings::Settings;
use halfrow_station::store::SharedBoard;

use super::{any, at_work, board, job, settings, shared};
use crate::common::{PLAN, folder, program};

/// What a record says about production when a station takes a job of a plan with the section `shift`. The station cannot reach
/// its board, which may be a product.
fn is_production(shift: &str) -> bool {
    let (server, mut plant) = shared(0);
    plant.share(&SharedBoard { target: "tcp:127.0.0.1:1".to_owned(), ..board(0, "mock") }, "engel").unwrap();
    let folder = folder();
    let path = settings(&server, folder.path(), "12");
    let plan = PLAN.replace("require_hardware = false", "require_hardware = true");
    let plan = plan.replace("[tables]", &format!("{shift}[tables]"));
    fs::write(folder.path().join("plan.toml"), plan).unwrap();
    let plan = Plan::load(&folder.path().join("plan.toml")).unwrap();
    plant.add_jobs(&job(&plan, &any()), 1).unwrap();
    let settings = Settings::load_without_lanes(&path).unwrap();
    let work = at_work(&settings, program().to_owned());
    let claim = work.claim().unwrap().unwrap();
    let is_over = Cell::new(false);
    // Nothing is sent to the plant, so waiting for it would be in vain.
    let stop = || is_over.get().then_some(StoppedBy::Person);
    let mut heard = |stage: Stage<'_>| is_over.set(matches!(stage, Stage::Saving { .. }));
    work.judge(claim, &stop, &stop, &mut heard).unwrap().saved.record.production
}

#[test]
fn a_job_on_a_board_that_was_not_checked_counts_as_no_production() {
    assert!(is_production(""), "the control");
    let [good, bad] = ["good = \"CAT90001\"", "bad = \"CAT90002\""];
    assert!(!is_production(&format!("[shift]\n{good}\n{bad}\nhours = 8\n")));
}
