//! Jobs of a plan whose lanes are checked in each shift.

use std::cell::Cell;
use std::fs;
use std::path::{Path, PathBuf};

use halfrow::verdict::StoppedBy;
use halfrow_station::plan::Plan;
use halfrow_station::run::Stage;
use halfrow_station::settings::Settings;
use halfrow_station::store::{SharedBoard, Wanted};
use serde_json::Value;

use super::{any, at_work, board, job, settings, shared, states};
use crate::common::{Did, PLAN, did_in, folder, program};
use crate::plant::server::Server;

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

/// A plan whose shifts are checked by the unit of the board with the number 0.
pub(super) fn checked(again: &str) -> Plan {
    let shift = "[shift]\ngood = \"CAT00000\"\nbad = \"CAT90002\"\nhours = 8\n[tables]";
    let text =
        PLAN.replace("[tables]", shift).replace("device = ", &format!("again = \"{again}\"\ndevice = "));
    Plan::parse("plan.toml".as_ref(), text).unwrap()
}

pub(super) fn good() -> Wanted {
    Wanted::Serial("CAT00000".to_owned())
}

/// At this address nothing answers.
fn dead() -> SharedBoard {
    SharedBoard { target: "tcp:127.0.0.1:9".to_owned(), ..board(0, "mock") }
}

/// The settings of a worker by this plan in `folder`.
pub(super) fn prepared(server: &Server, folder: &Path, plan: &Plan) -> PathBuf {
    let path = settings(server, folder, "12");
    fs::write(folder.join("plan.toml"), &plan.text).unwrap();
    path
}

fn worked(folder: &Path, more: &[&str]) -> Did {
    let did = did_in(folder, &[&["work", "--once"], more].concat());
    assert_eq!(did.code, Some(0), "{did:?}");
    did
}

const JUDGED: &str = "SELECT lane, verdict FROM run ORDER BY id";

#[test]
fn a_unit_that_checks_shifts_costs_no_job_for_any_board_an_attempt() {
    let (server, mut plant) = shared(2);
    assert!(plant.share(&dead(), "engel").unwrap());
    let (folder, plan) = (folder(), checked("allow"));
    prepared(&server, folder.path(), &plan);
    plant.add_jobs(&job(&plan, &any()), 1).unwrap();
    worked(folder.path(), &[]);
    assert_eq!(server.rows(JUDGED), [["shelf-1", "PASS"]]);
    assert_eq!(states(&server), [["done", "1"]]);
}

#[test]
fn a_job_for_any_board_waits_for_a_product_while_only_units_that_check_shifts_are_free() {
    for again in ["allow", "ask", "refuse"] {
        let (server, mut plant) = shared(1);
        let (folder, plan) = (folder(), checked(again));
        prepared(&server, folder.path(), &plan);
        plant.add_jobs(&job(&plan, &any()), 1).unwrap();
        worked(folder.path(), &[]);
        assert_eq!(states(&server), [["waiting", "0"]], "{again}");
        // Whoever names the unit wants it.
        plant.add_jobs(&job(&plan, &good()), 1).unwrap();
        worked(folder.path(), &[]);
        assert_eq!(server.rows(JUDGED), [["shelf-0", "PASS"]], "{again}");
        assert!(plant.share(&board(3, "mock"), "engel").unwrap());
        worked(folder.path(), &[]);
        assert_eq!(server.rows(JUDGED), [["shelf-0", "PASS"], ["shelf-3", "PASS"]], "{again}");
        assert_eq!(states(&server), [["done", "1"], ["done", "1"]], "{again}");
    }
}

#[test]
fn of_a_unit_that_checks_shifts_it_is_told_that_its_job_is_given_back() {
    let (server, mut plant) = shared(0);
    assert!(plant.share(&dead(), "engel").unwrap());
    let (folder, plan) = (folder(), checked("allow"));
    prepared(&server, folder.path(), &plan);
    plant.add_jobs(&job(&plan, &good()), 1).unwrap();
    let did = worked(folder.path(), &[]);
    assert_eq!(did.said.matches("board shelf-0; the job is given back)").count(), 5, "{did:?}");
    assert_eq!(did.said.lines().count(), 5, "{did:?}");
    plant.add_jobs(&job(&plan, &good()), 1).unwrap();
    let did = worked(folder.path(), &["--json"]);
    let first: Value = serde_json::from_str(did.said.lines().next().unwrap()).unwrap();
    assert_eq!([&first["counts"], &first["superseded"]], [false, false], "{did:?}");
    assert!(plant.share(&board(0, "mock"), "engel").unwrap());
    plant.add_jobs(&job(&plan, &good()), 1).unwrap();
    let did = worked(folder.path(), &[]);
    assert!(did.said.ends_with("; it is in no yield, for its unit checks shifts)\n"), "{did:?}");
}
