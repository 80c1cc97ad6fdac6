//! Jobs and shared boards by the commands of a station's program, and a station that takes no jobs.

use std::fs::{self, File};
use std::process::Command;

use halfrow_station::store::Plant;
use serde_json::Value;

use super::{settings, shared};
use crate::clocks::Clocks;
use crate::common::{Did, command, did_in, program};
use crate::plant::sent::introduction;
use crate::plant::server::Server;

/// Runs the commands of an engineer at a plant.
struct Engineer {
    server: Server,
    folder: tempfile::TempDir,
}

impl Engineer {
    fn new() -> Self {
        let (server, _) = shared(0);
        let folder = crate::common::folder();
        settings(&server, folder.path(), "plant");
        Self { server, folder }
    }

    fn did(&self, arguments: &[&str]) -> Did {
        did_in(self.folder.path(), arguments)
    }

    /// The same by this call of the program.
    fn did_by(&self, mut command: Command, arguments: &[&str]) -> Did {
        command.args(arguments).arg("--settings").arg(self.folder.path().join("station.toml"));
        command.output().unwrap().into()
    }

    /// The acts in the audit.
    fn acts(&self) -> Vec<String> {
        self.server
            .rows("SELECT act FROM audit WHERE operator_id = 'engel' AND act <> 'command' ORDER BY id")
            .concat()
    }

    /// The commands in the audit.
    fn commands(&self) -> Vec<String> {
        self.server.rows("SELECT subject FROM audit WHERE act = 'command' ORDER BY id").concat()
    }
}

/// Older jobs come first, whoever adds them.
#[test]
fn jobs_of_a_computer_whose_clock_is_slow_come_behind_those_that_wait() {
    let engineer = Engineer::new();
    let plan = engineer.folder.path().join("plan.toml").display().to_string();
    let clocks = Clocks::in_folder(engineer.folder.path());
    let ids = [600, -600, 0].map(|ahead| {
        clocks.ahead(ahead, 0);
        let mut call = Command::new(program());
        clocks.of(&mut call);
        let add = ["job", "add", "--operator", "engel", "--plan", &plan, "--kind", "mock"];
        let added = engineer.did_by(call, &add);
        assert_eq!(added.code, Some(0), "{added:?}");
        added.said.trim().to_owned()
    });
    assert!(ids.is_sorted(), "{ids:?}");
}

#[test]
fn jobs_are_added_changed_and_listed_by_commands_that_the_audit_keeps() {
    let engineer = Engineer::new();
    let plan = engineer.folder.path().join("plan.toml").display().to_string();
    let add = |more: &[&str]| {
        engineer.did(&[&["job", "add", "--operator", "engel", "--plan", plan.as_str()], more].concat())
    };
    let added = add(&["--kind", "mock", "--count", "2", "--needs", "camera"]);
    let ids: Vec<_> = added.said.lines().map(str::to_owned).collect();
    assert_eq!(ids.len(), 2, "{added:?}");
    let wrong: [&[&str]; 6] = [
        &["--kind", ""],
        &["--kind", " "],
        &["--serial", "XXX"],
        &["--kind", "mock", "--needs", "two words"],
        &["--kind", "mock", "--count", "0"],
        &[],
    ];
    for wrong in wrong {
        assert_eq!(add(wrong).code, Some(2), "{wrong:?}");
    }
    assert!(add(&[]).complained.contains("<--serial <SERIAL>|--kind <KIND>>"), "{:?}", add(&[]));
    let cancel = ["job", "cancel", &ids[0], "--reason", "a mistake", "--operator", "engel"];
    assert_eq!(engineer.did(&cancel).code, Some(0));
    assert_eq!(engineer.did(&cancel).code, Some(2));
    for (more, expected) in [(&[] as &[&str], "waiting"), (&["--state", "cancelled"], "cancelled")] {
        let listed = engineer.did(&[&["job", "list", "--json"], more].concat()).said;
        let listed: Value = serde_json::from_str(&listed).unwrap();
        let states: Vec<_> = listed.as_array().unwrap().iter().map(|job| &job["state"]).collect();
        assert_eq!(states, [expected]);
    }
    assert_eq!(
        engineer.did(&["job", "retry", &ids[0], "--reason", "no mistake", "--operator", "engel"]).code,
        Some(0)
    );
    assert!(engineer.did(&["job", "list", "--state", "waiting"]).said.contains("any mock"));
    assert_eq!(engineer.acts(), ["add job", "cancel job", "retry job"]);
    let [cancel, retry] = ["cancel", "retry"].map(|act| format!("job {act} {}", ids[0]));
    assert_eq!(engineer.commands(), ["job add mock", &cancel, &cancel, &retry], "also what came to nothing");
}

#[test]
fn whoever_adds_a_job_that_no_board_could_do_or_whose_id_is_not_printed_is_told() {
    let engineer = Engineer::new();
    let plan = engineer.folder.path().join("plan.toml").display().to_string();
    let add = ["job", "add", "--operator", "engel", "--plan", &plan, "--kind", "mock"];
    let told = "no board of the kind mock is shared as a unit of CAM-T";
    let did = engineer.did(&add);
    assert!(did.code == Some(0) && did.complained.contains(told), "{did:?}");
    let share = ["board", "share", "a", "--operator", "engel", "--kind", "mock", "--board", "mock"];
    for (more, is_told) in [(&[] as &[&str], true), (&["--product", "CAM-T", "--serial", "CAT00001"], false)]
    {
        assert_eq!(engineer.did(&[&share[..], more].concat()).code, Some(0));
        let did = engineer.did(&add);
        assert_eq!((did.code, did.complained.contains(told)), (Some(0), is_told), "{did:?}");
    }
    let full = File::options().write(true).open("/dev/full").unwrap();
    let did = Did::from(command(engineer.folder.path(), &add).stdout(full).output().unwrap());
    assert!(did.code == Some(3) && did.complained.contains("the jobs were added all the same"), "{did:?}");
    assert_eq!(engineer.server.rows("SELECT count(*) FROM job"), [["4"]]);
}

#[test]
fn boards_are_shared_changed_and_listed_by_commands_that_the_audit_keeps() {
    let engineer = Engineer::new();
    let share = |board: &str| {
        engineer.did(&[
            "board",
            "share",
            "shelf-1",
            "--operator",
            "engel",
            "--kind",
            "mock",
            "--board",
            board,
        ])
    };
    assert_eq!(share("mock").said, "shelf-1 is shared\n");
    for wrong in ["nonsense:1", "tcp:127.0.0.1:99999"] {
        assert_eq!(share(wrong).code, Some(2), "{wrong}");
    }
    assert!(engineer.did(&["board", "list"]).said.contains("free"));
    let changes =
        [("out", "shelf-1 is out\n"), ("in", "shelf-1 is in\n"), ("unshare", "shelf-1 is unshared\n")];
    for blank in ["", " "] {
        let did = engineer.did(&["board", "out", "shelf-1", "--reason", blank, "--operator", "engel"]);
        assert_eq!((did.code, did.complained.contains("say why in a few words")), (Some(2), true), "{did:?}");
    }
    for (change, said) in changes {
        assert_eq!(
            engineer.did(&["board", change, "shelf-1", "--reason", "why not", "--operator", "engel"]).said,
            said
        );
    }
    assert_eq!(
        engineer.did(&["board", "out", "shelf-1", "--reason", "why not", "--operator", "engel"]).code,
        Some(2)
    );
    assert!(engineer.did(&["board", "list"]).said.contains("no board is shared"));
    assert_eq!(engineer.acts(), ["share board", "board out", "board in", "unshare board"]);
    let called = ["share", "out", "in", "unshare", "out"].map(|act| format!("board {act} shelf-1"));
    assert_eq!(engineer.commands(), called);
}

/// Otherwise the plant would refuse them, which names no argument.
#[test]
fn a_board_is_shared_by_names_that_are_not_empty() {
    let engineer = Engineer::new();
    let right = [("--kind", "mock"), ("--product", "CAM-T"), ("--serial", "CAT00001"), ("--station", "12")];
    for (empty, _) in right {
        let with = |(option, name)| [option, if option == empty { " " } else { name }];
        let names: Vec<_> = right.into_iter().flat_map(with).collect();
        let share = ["board", "share", "shelf-1", "--operator", "engel", "--board", "mock"];
        let did = engineer.did(&[&share[..], &names].concat());
        assert!(did.code == Some(2) && did.complained.contains(empty), "{empty}: {did:?}");
    }
    assert!(engineer.did(&["board", "list"]).said.contains("no board is shared"));
}

/// Whoever else got it would judge its own board under this one's serial number.
#[test]
fn a_board_that_is_plugged_into_one_computer_is_shared_by_its_station_alone() {
    let engineer = Engineer::new();
    let share = |board: &str, more: &[&str]| {
        let share = ["board", "share", "shelf-1", "--kind", "mock", "--operator", "engel", "--board", board];
        engineer.did(&[&share[..], more].concat())
    };
    let by_path = "serial:/dev/serial/by-path/pci-0000:00:14.0-usb-0:2:1.0-port0";
    for board in ["usb:1-2.3", by_path, "serial:/dev/ttyUSB0", "tcp:localhost:3001", "tcp:[::1]:3001"] {
        let did = share(board, &[]);
        assert!(did.code == Some(2) && did.complained.contains("by --station"), "{did:?}");
    }
    for moving in ["usb", "serial:/dev/ttyUSB0"] {
        let did = share(moving, &["--station", "12"]);
        assert!(did.code == Some(2) && did.complained.contains("; write "), "{did:?}");
    }
    assert!(engineer.did(&["board", "list"]).said.contains("no board is shared"));
    for board in ["usb:1-2.3", by_path] {
        assert_eq!(share(board, &["--station", "12"]).said, "shelf-1 is shared\n");
    }
    assert_eq!(share("tcp:shelf:5000", &[]).said, "shelf-1 is shared\n");
}

#[test]
fn a_station_whose_settings_say_nothing_of_jobs_takes_none() {
    let engineer = Engineer::new();
    let path = engineer.folder.path().join("station.toml");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.split("[work]").next().unwrap()).unwrap();
    let refused = engineer.did(&["work", "--once", "--any-disk"]);
    assert!(refused.code == Some(2) && refused.complained.contains("into [work]"), "{refused:?}");
}

#[test]
fn whoever_shares_a_board_with_a_station_that_was_never_heard_from_is_told() {
    let engineer = Engineer::new();
    let share = ["board", "share", "a", "--operator", "engel", "--kind", "mock", "--board", "mock"];
    let mut plant = Plant::connect(&engineer.server.address()).unwrap();
    plant.see(&introduction("station 8", "018f0000-0000-7000-8000-000000000000".to_owned())).unwrap();
    for (station, is_told) in [("station 8", false), ("nowhere", true)] {
        let did = engineer.did(&[&share[..], &["--station", station]].concat());
        assert_eq!((did.code, did.complained.contains("no station nowhere")), (Some(0), is_told), "{did:?}");
    }
}
