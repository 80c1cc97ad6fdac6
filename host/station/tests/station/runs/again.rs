//! Units that have already passed.

use std::process::Command;

use super::bench::{Did, PLAN, Station, program};
use super::identity::{device, rebind};

fn plan(again: &str) -> String {
    PLAN.replace("device = ", &format!("again = \"{again}\"\ndevice = "))
}

fn meant(station: &Station, serial: &str, board: &str) -> Did {
    let mut arguments = station.run_arguments(serial, board);
    arguments.push("--again".to_owned());
    Command::new(program()).args(arguments).output().unwrap().into()
}

#[test]
fn a_unit_that_passed_is_tested_again_as_the_plan_says() {
    for (again, plain, said) in [("allow", 0, 0), ("ask", 2, 0), ("refuse", 2, 2)] {
        let station = Station::with(&plan(again));
        for board in ["mock,fault=stuck-data", "mock"] {
            assert_ne!(station.run("CAT00001", board).code, Some(2), "it has not passed yet");
        }
        let did = station.run("CAT00001", "mock");
        assert_eq!(did.code, Some(plain), "{again}: {did:?}");
        let complaint = "CAT00001 passed already under this plan, at 20";
        assert_eq!(did.complained.contains(complaint), plain != 0, "{did:?}");
        assert_eq!(did.complained.contains("say --again to test it again"), again == "ask", "{did:?}");
        assert_eq!(meant(&station, "CAT00001", "mock").code, Some(said), "{again}");
        assert_eq!(station.run("CAT00002", "mock").code, Some(0), "another unit");
        // Under another plan it has not passed.
        station.plan(&plan(again).replace("version = \"1\"", "version = \"2\""));
        assert_eq!(station.run("CAT00001", "mock").code, Some(0), "{again}");
        let runs = 2 + i32::from(plain == 0) + i32::from(said == 0) + 2;
        assert_eq!(station.query("SELECT count(*) FROM run"), [runs.to_string()], "{again}");
    }
}

/// An ERROR says nothing about a unit that passed.
#[test]
fn a_unit_that_passed_has_passed_though_an_error_came_after() {
    let station = Station::with(&plan("ask"));
    assert_eq!(station.run("CAT00001", "mock").code, Some(0));
    let error = meant(&station, "CAT00001", "tcp:127.0.0.1:1");
    assert_eq!(error.code, Some(3), "{error:?}");
    let did = station.run("CAT00001", "mock");
    assert!(did.code == Some(2) && did.complained.contains("passed already"), "{did:?}");
}

#[test]
fn a_unit_that_checks_shifts_is_always_tested() {
    let shift = "[shift]\ngood = \"CAT00001\"\nbad = \"CAT00002\"\nhours = 8\n[tables]";
    let station = Station::with(&plan("refuse").replace("[tables]", shift));
    for _ in 0..2 {
        let did = station.run("CAT00001", "mock");
        assert_eq!(did.code, Some(0), "{did:?}");
    }
}

/// What passed may have been another board, and a board whose FPGA was exchanged was repaired.
#[test]
fn a_unit_has_not_passed_by_a_run_from_before_a_person_bound_it_anew() {
    let station = Station::with(&plan("refuse"));
    // The label was mistyped.
    assert_eq!(station.run("CAT00001", &device(0x22)).code, Some(0));
    assert_eq!(station.run("CAT00002", &device(0x22)).code, Some(6));
    let to_second = ["--serial", "CAT00002", "--device", "0000000000000022", "--reason", "mistyped"];
    assert_eq!(rebind(&station, &to_second).code, Some(0));
    let exchanged = ["--serial", "CAT00001", "--reason", "FPGA exchanged"];
    for (serial, board, then) in
        [("CAT00002", 0x22, None), ("CAT00001", 0x11, Some(exchanged)), ("CAT00001", 0x33, None)]
    {
        let did = station.run(serial, &device(board));
        assert_eq!(did.code, Some(0), "{serial} as {board}: {did:?}");
        let did = station.run(serial, &device(board));
        assert!(did.code == Some(2) && did.complained.contains("passed already"), "{did:?}");
        if let Some(then) = then {
            assert_eq!(rebind(&station, &then).code, Some(0));
        }
    }
}

/// A person had bound what a person gives to another unit.
#[test]
fn a_unit_has_not_passed_by_a_run_as_a_device_that_is_another_unit_s_since() {
    let station = Station::with(&plan("refuse"));
    let passes = |serial, board| {
        let did = station.run(serial, &device(board));
        assert_eq!(did.code, Some(0), "{serial} as {board}: {did:?}");
    };
    let bind = |serial, device, reason| {
        let did = rebind(&station, &["--serial", serial, "--device", device, "--reason", reason]);
        assert_eq!(did.code, Some(0), "{did:?}");
    };
    passes("CAT00001", 0x11);
    bind("CAT00001", "0000000000000022", "FPGA exchanged");
    passes("CAT00001", 0x22);
    assert_eq!(station.run("CAT00001", &device(0x22)).code, Some(2), "it has passed");
    passes("CAT00002", 0x33);
    bind("CAT00002", "0000000000000022", "labels exchanged");
    passes("CAT00001", 0x44);
}
