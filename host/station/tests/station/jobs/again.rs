//! Jobs for units that passed already.

use std::fs;
use std::path::Path;

use halfrow_station::plan::Plan;
use halfrow_station::store::{Change, Folder, Plant, Store, Wanted};

use super::{any, job, settings, shared, states};
use crate::common::{Did, PLAN, did_in, folder, instead, reason};
use crate::plant::server::Server;

/// A plan that says this of units that passed.
fn plan(again: &str) -> Plan {
    let text = PLAN.replace("device = ", &format!("again = \"{again}\"\ndevice = "));
    Plan::parse("plan.toml".as_ref(), text).unwrap()
}

/// Takes all jobs by these plans that a station of this name can judge now.
fn worked(server: &Server, (folder, name): (&Path, &str), plans: &[&Plan]) -> Did {
    let path = settings(server, folder, name);
    let names: Vec<_> = (0..plans.len()).map(|number| format!("{number}.toml")).collect();
    for (name, plan) in names.iter().zip(plans) {
        fs::write(folder.join(name), &plan.text).unwrap();
    }
    instead(path, "\"plan.toml\"", &format!("\"{}\"", names.join("\", \"")));
    let did = did_in(folder, &["work", "--once"]);
    assert_eq!(did.code, Some(0), "{did:?}");
    did
}

fn add(plant: &mut Plant, plan: &Plan, wanted: &Wanted, count: u32) {
    plant.add_jobs(&job(plan, wanted), count).unwrap();
}

/// A flaky FAIL would be its last judgement.
#[test]
fn a_job_for_a_unit_that_passed_ends_as_a_scan_would() {
    let (server, mut plant) = shared(1);
    let (folder, other) = (folder(), folder());
    let unit = Wanted::Serial("CAT00000".to_owned());
    let refusing = plan("refuse");
    add(&mut plant, &refusing, &unit, 1);
    worked(&server, (folder.path(), "12"), &[&refusing]);
    assert_eq!(states(&server), [["done", "1"]]);
    add(&mut plant, &refusing, &unit, 1);
    // Whichever station takes it.
    let did = worked(&server, (other.path(), "13"), &[&refusing]);
    let said = "CAT00000 passed already under this plan, at 20";
    assert!(did.complained.contains(said), "{did:?}");
    assert_eq!(states(&server), [["done", "1"], ["dead", "1"]]);
    let told = &server.rows("SELECT said FROM job WHERE state = 'dead'")[0][0];
    assert!(told.contains(said) && told.ends_with("put it with the boards that passed"), "{told}");
    assert_eq!(server.rows("SELECT count(*) FROM board WHERE holder IS NOT NULL"), [["0"]]);
    assert_eq!(server.rows("SELECT count(*) FROM run"), [["1"]]);
}

#[test]
fn whoever_adds_a_job_for_a_unit_that_passed_has_meant_it_where_a_plan_asks() {
    for again in ["ask", "allow"] {
        let (server, mut plant) = shared(1);
        let (folder, plan) = (folder(), plan(again));
        add(&mut plant, &plan, &Wanted::Serial("CAT00000".to_owned()), 2);
        worked(&server, (folder.path(), "12"), &[&plan]);
        assert_eq!(states(&server), [["done", "1"], ["done", "1"]], "{again}");
    }
}

/// The first free board would be judged by all of them.
#[test]
fn a_job_for_any_board_waits_for_one_that_has_not_passed_and_holds_up_no_other() {
    ["refuse", "ask"].into_iter().for_each(waits_for_one_that_has_not_passed);
}

fn waits_for_one_that_has_not_passed(again: &str) {
    let (server, mut plant) = shared(2);
    let folder = folder();
    let [refusing, allowing] = [again, "allow"].map(plan);
    add(&mut plant, &refusing, &any(), 3);
    add(&mut plant, &allowing, &any(), 1);
    let plans = [&refusing, &allowing];
    worked(&server, (folder.path(), "12"), &plans);
    let done = ["done", "1"];
    assert_eq!(states(&server), [done, done, ["waiting", "0"], done]);
    let judged = format!("SELECT lane FROM run WHERE plan_sha256 = '{}' ORDER BY lane", refusing.sha256);
    assert_eq!(server.rows(&judged), [["shelf-0"], ["shelf-1"]]);
    assert!(plant.share(&super::board(2, "mock"), "engel").unwrap());
    worked(&server, (folder.path(), "12"), &plans);
    assert_eq!(server.rows(&judged), [["shelf-0"], ["shelf-1"], ["shelf-2"]]);
}

/// What a station judged after its job was taken from it does not count.
#[test]
fn a_unit_has_not_passed_by_a_run_that_does_not_count() {
    let (server, mut plant) = shared(1);
    let (folder, refusing) = (folder(), plan("refuse"));
    let unit = Wanted::Serial("CAT00000".to_owned());
    add(&mut plant, &refusing, &unit, 1);
    worked(&server, (folder.path(), "12"), &[&refusing]);
    assert!(plant.refuses(&refusing, "CAT00000").unwrap().is_some());
    server.change("UPDATE run SET nth = 0");
    assert!(plant.refuses(&refusing, "CAT00000").unwrap().is_none());
    add(&mut plant, &refusing, &any(), 1);
    worked(&server, (folder.path(), "12"), &[&refusing]);
    assert_eq!(states(&server), [["done", "1"], ["done", "1"]]);
}

/// A board whose FPGA was exchanged was repaired, and a label that was mistyped is another board's.
#[test]
fn a_unit_has_not_passed_by_a_run_from_before_a_person_bound_it_anew() {
    let (server, mut plant) = shared(1);
    let (folder, refusing) = (folder(), plan("refuse"));
    add(&mut plant, &refusing, &Wanted::Serial("CAT00000".to_owned()), 1);
    worked(&server, (folder.path(), "12"), &[&refusing]);
    assert!(plant.refuses(&refusing, "CAT00000").unwrap().is_some());
    let mut store = Store::open(&Folder::new(&folder.path().join("data"))).unwrap();
    let change = Change {
        serial: "CAT00000",
        product: None,
        device: None,
        operator: "engel",
        reason: &reason("repaired"),
    };
    store.rebind(&change).unwrap();
    drop(store);
    worked(&server, (folder.path(), "12"), &[&refusing]);
    assert_eq!(server.rows("SELECT count(*) FROM audit WHERE act = 'rebind'"), [["1"]]);
    assert!(plant.refuses(&refusing, "CAT00000").unwrap().is_none());
}
