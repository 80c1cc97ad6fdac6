//! What is recorded for runs that are found open.

use std::os::unix::process::{CommandExt as _, ExitStatusExt as _};
use std::process::Command;

use halfrow_station::lane::Message;
use halfrow_station::record::{BoardSeen, RunCause, StepOutcome};
use halfrow_station::run::{RunError, recover};

use super::bench::PLAN;
use crate::common::{query, stat};
use crate::history::made::{End, Made, Run, step};

const SHIFT: &str = "[shift]\ngood = \"CAT90001\"\nbad = \"HR:MOCK\"\nhours = 8\n[tables]";

/// Whether a run of this unit that is found open counts as production, by a plan of this text, eight hours after the lane's shift
/// was checked by these runs.
fn is_production(plan: &str, checked: &[(&str, End)], serial: &str) -> bool {
    let mut made = Made::new();
    for (serial, end) in checked {
        made.run(&Run::of(serial, *end));
    }
    made.run(&Run::of(serial, End::Open).at_hour(8));
    let (recovered, is_production) = recovered(made, plan);
    assert_eq!(recovered, serial);
    is_production
}

/// The unit whose run was found open, by a plan of this text, and whether the run counts as production.
fn recovered(made: Made, plan: &str) -> (String, bool) {
    let database = rusqlite::Connection::open(made.folder().database()).unwrap();
    database.execute("UPDATE plan SET text = $1", [plan]).unwrap();
    drop(database);
    let (_folder, mut store) = made.parts();
    let recovered = recover(&mut store).unwrap().closed;
    let record = &recovered[0].record;
    (record.run.serial.clone(), record.production)
}

/// [`PLAN`] for hardware, whose runs may count.
fn hardware() -> String {
    PLAN.replace("require_hardware = false", "require_hardware = true")
}

/// By then the lane had recorded what the board is.
#[test]
fn a_run_that_is_found_open_on_what_is_no_hardware_counts_as_no_production() {
    for (kind, counts) in [("hardware", true), ("mock", false)] {
        let mut made = Made::new();
        let (head, _) = made.begin(&Run::of("CAT00001", End::Open));
        let mut identity = step(&head, 1, "identity", (StepOutcome::Passed, RunCause::None, 0));
        identity.board = identity.board.map(|board| BoardSeen { kind: kind.to_owned(), ..board });
        let spool = made.folder().spool(&head.id);
        std::fs::create_dir(&spool).unwrap();
        let told = serde_json::to_string(&Message::Ended { step: Box::new(identity) }).unwrap();
        std::fs::write(spool.join("events.jsonl"), told + "\n").unwrap();
        assert_eq!(recovered(made, &hardware()), (head.serial, counts), "{kind}");
    }
}

/// A lane that hangs, and does not notice that its station is gone.
#[test]
fn the_lane_of_a_run_that_is_found_open_is_killed() {
    let mut made = Made::new();
    let spools = ["1", "2"].map(|lane| {
        let run = Run { lane: lane.to_owned(), ..Run::of(&format!("CAT0000{lane}"), End::Open) };
        let spool = made.folder().spool(&made.begin(&run).0.id);
        std::fs::create_dir(&spool).unwrap();
        spool
    });
    let mut lanes = [(); 2].map(|()| Command::new("sleep").arg("20").process_group(0).spawn().unwrap());
    for (number, (spool, lane)) in spools.iter().zip(&lanes).enumerate() {
        let began: usize = stat(lane.id())[19].parse().unwrap();
        // For the second lane, the start time is that of another process with its id.
        std::fs::write(spool.join("lane.pid"), format!("{} {}", lane.id(), began + number)).unwrap();
    }
    recover(&mut made.store).unwrap();
    let killed = lanes[0].wait().unwrap().signal();
    assert_eq!((killed, lanes[1].try_wait().unwrap()), (Some(9), None));
    lanes[1].kill().unwrap();
    lanes[1].wait().unwrap();
}

/// A sector that is not readable; a folder in the place of the file cannot be read, either.
#[test]
fn a_run_that_is_found_open_is_closed_without_the_evidence_that_cannot_be_read() {
    let mut made = Made::new();
    let spool = made.folder().spool(&made.begin(&Run::of("CAT00001", End::Open)).0.id);
    std::fs::create_dir_all(spool.join("lane.log")).unwrap();
    std::fs::write(spool.join("events.jsonl"), "what was told\n").unwrap();
    let recovered = recover(&mut made.store).unwrap().closed;
    let names: Vec<_> = recovered[0].record.attachments.iter().map(|one| one.name.as_str()).collect();
    assert_eq!(names, ["events.jsonl"]);
    // Perhaps somebody else can read it: no later start removes it.
    recover(&mut made.store).unwrap();
    assert!(spool.join("lane.log").exists());
}

/// The disk that is in trouble may take the result only later, when all can be read again.
#[test]
fn a_spool_of_which_all_was_read_in_the_end_does_not_stay() {
    let mut made = Made::new();
    let spool = made.folder().spool(&made.begin(&Run::of("CAT00001", End::Open)).0.id);
    let log = spool.join("lane.log");
    std::fs::create_dir_all(&log).unwrap();
    let full = "CREATE TRIGGER full BEFORE UPDATE ON run BEGIN SELECT RAISE(ABORT, 'full'); END";
    made.change(full);
    assert!(recover(&mut made.store).unwrap().unclosed.is_some());
    assert!(spool.join("unread").exists(), "the control");
    made.change("DROP TRIGGER full");
    std::fs::remove_dir(&log).unwrap();
    std::fs::write(&log, "what was logged\n").unwrap();
    let recovered = recover(&mut made.store).unwrap().closed;
    assert_eq!(recovered[0].record.attachments.len(), 1);
    assert!(!spool.exists());
}

#[test]
fn a_run_that_cannot_be_closed_keeps_no_other_open() {
    let mut made = Made::new();
    for (lane, serial) in [("1", "CAT00001"), ("2", "CAT00002")] {
        made.begin(&Run { lane: lane.to_owned(), ..Run::of(serial, End::Open) });
    }
    let refuses = "CREATE TRIGGER refuses BEFORE UPDATE ON run WHEN OLD.lane = '1'
        BEGIN SELECT RAISE(ABORT, 'not this one'); END";
    made.change(refuses);
    let refused = recover(&mut made.store).unwrap().unclosed.unwrap();
    assert!(matches!(refused, RunError::Unsaved { .. }), "{refused:?}");
    assert_eq!(query(made.as_ref(), "SELECT lane FROM run WHERE state = 'open'"), ["1"]);
    made.change("DROP TRIGGER refuses");
    assert_eq!(recover(&mut made.store).unwrap().closed.len(), 1);
}

#[test]
fn a_run_that_is_found_open_counts_as_production_only_if_it_would_have() {
    let hardware = hardware();
    let shift = hardware.replace("[tables]", SHIFT);
    let (good, mock) = (("CAT90001", End::Pass), ("HR:MOCK:1", End::Fail(&["clock"])));
    assert!(is_production(&hardware, &[], "CAT00001"), "the control");
    assert!(!is_production(PLAN, &[], "CAT00001"), "it takes any board");
    assert!(!is_production("schema = 2", &[], "CAT00001"), "nobody can tell");
    assert!(!is_production(&shift, &[], "CAT00001"), "the lane was not checked");
    assert!(!is_production(&shift, &[good], "CAT00001"), "the mock was not judged");
    assert!(is_production(&shift, &[good, mock], "CAT00001"), "the other control");
    for unit in ["CAT90001", "HR:MOCK:1"] {
        assert!(!is_production(&shift, &[good, mock], unit), "{unit} checks shifts");
    }
}
