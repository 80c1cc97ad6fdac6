//! What is recorded of runs that are found open.

use halfrow_station::run::recover;

use super::bench::PLAN;
use crate::history::made::{BEGIN_MS, End, HOUR_MS, Made, Run};

const SHIFT: &str = "[shift]\ngood = \"CAT90001\"\nbad = \"HR:MOCK\"\nhours = 8\n[tables]";

/// What is recorded of production of a run of this unit that is found open, by a plan of this text, eight hours after
/// the lane's shift was checked so.
fn is_production(plan: &str, checked: &[(&str, End)], serial: &str) -> bool {
    let mut made = Made::new();
    for (serial, end) in checked {
        made.run(&Run::of(serial, *end));
    }
    made.run(&Run { started_ms: BEGIN_MS + 8 * HOUR_MS, ..Run::of(serial, End::Open) });
    let database = rusqlite::Connection::open(made.folder().database()).unwrap();
    database.execute("UPDATE plan SET text = $1", [plan]).unwrap();
    drop(database);
    let (_folder, mut store) = made.parts();
    let recovered = recover(&mut store).unwrap();
    assert_eq!(recovered[0].record.run.serial, serial);
    recovered[0].record.production
}

#[test]
fn a_run_that_is_found_open_counts_as_production_only_if_it_would_have() {
    let any = PLAN.to_owned();
    let hardware = any.replace("require_hardware = false", "require_hardware = true");
    let shift = hardware.replace("[tables]", SHIFT);
    let (good, mock) = (("CAT90001", End::Pass), ("HR:MOCK:1", End::Fail(&["clock"])));
    assert!(is_production(&hardware, &[], "CAT00001"), "the control");
    assert!(!is_production(&any, &[], "CAT00001"), "it takes any board");
    assert!(!is_production("schema = 2", &[], "CAT00001"), "nobody can tell");
    assert!(!is_production(&shift, &[], "CAT00001"), "the lane was not checked");
    assert!(!is_production(&shift, &[good], "CAT00001"), "the mock was not judged");
    assert!(is_production(&shift, &[good, mock], "CAT00001"), "the other control");
    for unit in ["CAT90001", "HR:MOCK:1"] {
        assert!(!is_production(&shift, &[good, mock], unit), "{unit} checks shifts");
    }
}
