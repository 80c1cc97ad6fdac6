//! The serial number on the label, checked against the FPGA's own number.

use std::io::{Read as _, Write as _};
use std::net::TcpListener;
use std::path::Path;
use std::process::Command;
use std::thread;
use std::time::Duration;

use halfrow::link::{self, Link};
use halfrow_station::check::check;
use halfrow_station::record::DeviceSeen;
use halfrow_station::run::recover_run;
use halfrow_station::store::{Admission, Change, RebindError, SharedStore};

use super::bench::{Did, PLAN, Station, program};
use super::ends::with_link;
use crate::common::{folder, reason, untold};
use crate::history::made::{BEGIN_MS, End, Made, Run};

/// The mock board whose FPGA has this number.
pub(super) fn device(number: u64) -> String {
    format!("mock,serial={number}")
}

pub(super) fn rebind(station: &Station, arguments: &[&str]) -> Did {
    rebind_in(&station.data(), arguments)
}

fn rebind_in(data: &Path, arguments: &[&str]) -> Did {
    Command::new(program())
        .arg("rebind")
        .arg("--data")
        .arg(data)
        .args(arguments)
        .args(["--operator", "engineer"])
        .env("SUDO_USER", "braun")
        .output()
        .unwrap()
        .into()
}

/// Asserts that the run was refused without sending a frame.
fn assert_refused(station: &Station, did: &Did, said: &str) {
    assert_eq!(did.code, Some(6), "{did:?}");
    assert!(did.said.starts_with("ERROR ") && did.said.contains(said), "{did:?}");
    let last = "SELECT outcome FROM step WHERE run_id = (SELECT max(id) FROM run) ORDER BY seq";
    assert_eq!(station.query(last), ["error", "skipped"], "{did:?}");
    assert_eq!(station.query("SELECT cause FROM run ORDER BY id DESC LIMIT 1"), ["operator"]);
}

fn assert_well(station: &Station) {
    let checked = station.check();
    assert_eq!(checked.code, Some(0), "{checked:?}");
}

#[test]
fn a_board_and_its_label_stay_together_from_the_first_judgement_on() {
    let station = Station::with(PLAN);
    let first = station.run("CAT00017", &device(0x11));
    assert_eq!(first.code, Some(0), "{first:?}");
    assert!(first.said.contains("device 0000000000000011, seen for the first time"), "{first:?}");
    assert!(!first.said.contains("identity not checked"), "{first:?}");
    assert_eq!(station.run("CAT00017", &device(0x11)).code, Some(0));
    assert_eq!(station.query("SELECT device || ' ' || by_operator FROM binding"), ["0000000000000011 weber"]);
    // A FAIL binds, too; a run that judges nothing does not.
    assert_eq!(station.run("CAT00071", &format!("{},fault=stuck-data", device(0x22))).code, Some(1));
    assert_refused(
        &station,
        &station.run("CAT00071", &device(0x11)),
        "this board is CAT00017; you scanned CAT00071",
    );
    assert_refused(
        &station,
        &station.run("CAT00017", &device(0x22)),
        "this board is CAT00071; you scanned CAT00017",
    );
    assert_refused(
        &station,
        &station.run("CAT00017", &device(0x33)),
        "CAT00017 is device 0000000000000011; the board in the lane is device 0000000000000033",
    );
    assert_refused(&station, &station.run("CAT00099", &device(0x11)), "this board is CAT00017");
    assert_eq!(station.query("SELECT count(*) FROM binding"), ["2"]);
    assert_eq!(station.run("CAT00017", &device(0x11)).code, Some(0));
    assert_well(&station);
}

/// A port at which each connection reaches the next of these boards, after a call of `before`.
pub(super) fn one_after_the_other(boards: Vec<String>, before: impl Fn() + Send + 'static) -> String {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let target = format!("tcp:{}", listener.local_addr().unwrap());
    thread::spawn(move || {
        for board in boards {
            let (mut host, _) = listener.accept().unwrap();
            before();
            let mut board = link::open(&board.parse().unwrap()).unwrap().link;
            let mut bytes = [0; 4096];
            while let Ok(read @ 1..) = host.read(&mut bytes) {
                let said = answers(&mut *board, &bytes[..read]);
                host.write_all(&said).unwrap();
            }
        }
    });
    target
}

/// What the board says to these bytes.
pub(crate) fn answers(board: &mut dyn Link, mut bytes: &[u8]) -> Vec<u8> {
    let (mut said, mut has_moved) = (Vec::new(), true);
    while has_moved {
        let before = said.len();
        let taken = board.exchange(bytes, &mut said, Duration::from_millis(1)).unwrap();
        bytes = &bytes[taken..];
        has_moved = taken > 0 || said.len() > before;
    }
    said
}

#[test]
fn a_board_that_is_swapped_after_the_identity_step_is_not_judged() {
    for (plan, outcomes) in
        [(PLAN.to_owned(), &["passed", "error"][..]), (with_link(), &["passed", "error", "skipped"])]
    {
        let station = Station::with(&plan);
        let did = station.run("CAT00017", &one_after_the_other(vec![device(0x11), device(0x22)], || ()));
        assert_eq!(did.code, Some(6), "{did:?}");
        assert!(did.said.contains("0000000000000011") && did.said.contains("0000000000000022"), "{did:?}");
        assert_eq!(station.query("SELECT outcome FROM step ORDER BY seq"), outcomes, "{did:?}");
        assert_eq!(station.query("SELECT count(*) FROM binding"), ["0"]);
        assert_well(&station);
    }
}

/// The table of bindings disappears while the board is identified.
#[test]
fn a_board_of_which_nobody_can_tell_whose_it_is_is_not_judged() {
    let station = Station::with(PLAN);
    assert_eq!(station.run("CAT00017", &device(0x11)).code, Some(0));
    let path = station.store().database();
    let database = move |text: &str| rusqlite::Connection::open(&path).unwrap().execute_batch(text);
    let again = database.clone();
    let boards = vec![device(0x22), device(0x22)];
    // The second connection finds it gone already.
    let gone = move || drop(database("ALTER TABLE binding RENAME TO gone"));
    let did = station.run("CAT00017", &one_after_the_other(boards, gone));
    assert_eq!(did.code, Some(3), "{did:?}");
    again("ALTER TABLE gone RENAME TO binding").unwrap();
    assert_eq!(station.query("SELECT verdict FROM run ORDER BY id"), ["PASS", "ERROR"]);
    assert_well(&station);
}

#[test]
fn a_board_without_a_number_says_so_in_its_pass() {
    let station = Station::with(PLAN);
    let did = station.run("CAT00001", "mock");
    assert_eq!(did.code, Some(0), "{did:?}");
    assert!(did.said.lines().next().unwrap().ends_with("identity not checked"), "{did:?}");
    let unchecked = Station::with(&PLAN.replace("if-present", "not-checked"));
    let did = unchecked.run("CAT00001", &device(7));
    assert!(did.said.lines().next().unwrap().ends_with("identity not checked"), "{did:?}");
    assert_eq!(unchecked.query("SELECT count(*) FROM binding"), ["0"]);
    let demanded = Station::with(&PLAN.replace("if-present", "required"));
    assert_eq!(demanded.run("CAT00001", "mock").code, Some(6));
    assert_eq!(demanded.run("CAT00001", &device(7)).code, Some(0));
}

#[test]
fn a_run_that_judged_nothing_binds_nothing() {
    let limit = "[limits]\n\"run.seconds\" = { most = 0.0, blames = \"station\" }\n";
    let station = Station::with(&format!("{PLAN}{limit}"));
    assert_eq!(station.run("CAT00001", &device(7)).code, Some(3));
    assert_eq!(station.query("SELECT count(*) FROM binding"), ["0"]);
    assert_well(&station);
}

#[test]
fn a_device_that_is_being_judged_is_admitted_and_bound_nowhere_else() {
    let mut made = Made::new();
    let mut begin =
        |serial, lane: &str| made.begin(&Run { lane: lane.to_owned(), ..Run::of(serial, End::Open) }).0;
    let [first, second] = [begin("CAT00017", "1"), begin("CAT00071", "2")];
    let device = "0000000000000011";
    let mut admit = |run| made.store.admit(run, device).unwrap();
    assert_eq!(admit(&first), Admission::New);
    assert_eq!(admit(&first), Admission::New, "its own run asks again");
    let other = admit(&second);
    assert!(matches!(other, Admission::Refused { .. }), "{other:?}");
    for (serial, device) in [("CAT00017", None), ("CAT00071", Some(device))] {
        let change = Change { serial, product: None, device, operator: "engineer", reason: &reason("x") };
        let bound = made.store.rebind(&change);
        assert!(matches!(bound, Err(RebindError::UnderTest { .. })), "{bound:?}");
    }
}

const DEVICES: [&str; 2] = ["0000000000000011", "0000000000000022"];

/// A run of CAT00001 that waits for the first device while a person binds CAT00002 to `device`, and what is said when the board
/// comes. Only the unit `bound` had a device.
fn bound_anew(
    bound: (&str, &'static str),
    device: Option<&str>,
) -> (Made, impl FnOnce(&mut Made), Admission) {
    let judged =
        |serial, device| Run { device: Some((DeviceSeen::New, device)), ..Run::of(serial, End::Pass) };
    let mut made = Made::new();
    made.run(&Run::of("CAT00002", End::Pass));
    made.run(&judged(bound.0, bound.1));
    let waiting = judged("CAT00001", DEVICES[0]);
    let (head, plan) = made.begin(&waiting);
    let (serial, reason) = ("CAT00002", reason("labels exchanged"));
    let change = Change { serial, product: None, device, operator: "engineer", reason: &reason };
    made.store.rebind(&change).unwrap();
    let admission = made.store.admit(&head, DEVICES[0]).unwrap();
    (made, move |made: &mut Made| made.finish(&waiting, head, plan), admission)
}

/// The tables are rebuilt from runs in the order in which they began, and there the run comes before the change.
#[test]
fn a_run_that_waits_for_its_board_while_a_person_binds_anew_is_refused() {
    let freed = bound_anew(("CAT00002", DEVICES[0]), None).2;
    let taken = bound_anew(("CAT00001", DEVICES[1]), Some(DEVICES[1])).2;
    let told = [freed, taken].map(|admission| match admission {
        Admission::Refused { why } => why.to_string(),
        other => panic!("{other:?}"),
    });
    let other = "CAT00001 is device 0000000000000022; the board in the lane is device 0000000000000011";
    assert_eq!(told, ["this board is CAT00002; you scanned CAT00001", other]);
}

/// Earlier programs did not refuse them.
#[test]
fn a_folder_in_which_a_run_has_bound_what_a_person_freed_meanwhile_is_well() {
    let freed = bound_anew(("CAT00002", DEVICES[0]), None);
    let taken = bound_anew(("CAT00001", DEVICES[1]), Some(DEVICES[1]));
    for (mut made, finish) in [(freed.0, freed.1), (taken.0, taken.1)] {
        finish(&mut made);
        let faults = check(&made.folder(), &mut untold).unwrap().faults;
        assert!(faults.is_empty(), "{}", faults[0]);
    }
}

/// As after a commit that reached the disk, of which the station was not told.
#[test]
fn the_device_of_a_run_that_was_found_to_be_over_can_be_judged_again() {
    let mut made = Made::new();
    let over = Run::of("CAT00017", End::Pass);
    let (head, plan) = made.begin(&over);
    made.finish(&over, head.clone(), plan);
    let (next, _) = made.begin(&Run { lane: "2".to_owned(), ..Run::of("CAT00071", End::Open) });
    let (_folder, mut store) = made.parts();
    let device = "0000000000000011";
    assert_eq!(store.admit(&head, device).unwrap(), Admission::New);
    let store = SharedStore::new(store);
    assert_eq!(recover_run(&store, &head.id).unwrap().record.run.id, head.id);
    assert_eq!(store.with(|store| store.admit(&next, device)).unwrap(), Admission::New);
}

#[test]
fn an_engineer_binds_anew_with_a_reason_that_is_kept() {
    let station = Station::with(PLAN);
    station.run("CAT00017", &device(0x11));
    station.run("CAT00071", &device(0x22));
    let did = rebind(&station, &["--serial", "CAT00017", "--reason", "FPGA exchanged"]);
    assert_eq!(did.code, Some(0), "{did:?}");
    assert_eq!(station.run("CAT00017", &device(0x33)).code, Some(0));
    assert_refused(&station, &station.run("CAT00017", &device(0x11)), "CAT00017 is device 0000000000000033");
    // Exchanged labels: the device of one unit under the serial number of the other.
    let device_33 = "0000000000000033";
    let did = rebind(&station, &["--serial", "CAT00071", "--device", device_33, "--reason", "labels"]);
    assert_eq!(did.code, Some(0), "{did:?}");
    assert_eq!(station.run("CAT00071", &device(0x33)).code, Some(0));
    assert_eq!(
        station.query(
            "SELECT operator_id || ' ' || act || ' ' || detail FROM audit WHERE act = 'rebind' ORDER BY id"
        ),
        [
            r#"engineer rebind {"device":null,"reason":"FPGA exchanged"}"#,
            r#"engineer rebind {"device":"0000000000000033","reason":"labels"}"#
        ]
    );
    // Whatever name was given: whose process it was.
    let called = station.query(
        "SELECT operator_id || ' ' || subject || ': ' || detail FROM audit WHERE act = 'command' ORDER BY id",
    );
    let id = Did::from(Command::new("id").arg("-u").output().unwrap()).said;
    for (called, serial) in called.iter().zip(["CAT00017", "CAT00071"]) {
        assert!(called.starts_with(&format!("engineer rebind {serial}: uid {}", id.trim())), "{called}");
        assert!(called.ends_with(", SUDO_USER braun"), "{called}");
    }
    assert_eq!(called.len(), 2);
    assert_eq!(station.query("SELECT count(*) FROM binding WHERE to_ms IS NULL"), ["1"]);
    assert_shown(&station);
    assert_well(&station);
    let database = rusqlite::Connection::open(station.store().database()).unwrap();
    database.execute("UPDATE binding SET to_ms = NULL WHERE device = '0000000000000022'", []).unwrap_err();
    database.execute("UPDATE binding SET device = '0000000000000044' WHERE to_ms IS NULL", []).unwrap();
    let checked = station.check();
    assert!(checked.code == Some(3) && checked.said.contains("fault: table binding"), "{checked:?}");
}

/// Asserts that the text of each unit says which devices it had, and who bound it anew and why.
fn assert_shown(station: &Station) {
    let shown = |serial: &str| {
        let mut call = Command::new(program());
        let did: Did = call.args(["unit", serial, "--data"]).arg(station.data()).output().unwrap().into();
        // Without the times.
        let is_time = |word: &&str| word.matches(':').count() == 2;
        let line = |line: &str| line.split(' ').filter(|word| !is_time(word)).collect::<Vec<_>>().join(" ");
        let is_of_device =
            |line: &String| ["  device ", "  rebound "].iter().any(|key| line.starts_with(key));
        let bound: Vec<_> = did.said.lines().map(line).filter(is_of_device).collect();
        (bound, did.said.matches(", bound to this unit no more\n").count())
    };
    let expected = [
        "  device    0000000000000033 from until by weber: first judgement",
        "  device    0000000000000011 from until by weber: first judgement",
        "  rebound   by engineer: FPGA exchanged",
        "  rebound   another unit got its device, by engineer: labels",
    ];
    // Two runs judged a device each, and a third was refused with one of these.
    assert_eq!(shown("CAT00017"), (expected.map(str::to_owned).to_vec(), 3));
    let expected = [
        "  device    0000000000000033 from by engineer: labels",
        "  device    0000000000000022 from until by weber: first judgement",
        "  rebound   by engineer: labels",
    ];
    assert_eq!(shown("CAT00071"), (expected.map(str::to_owned).to_vec(), 1));
}

/// A run that a clock set back would put before the change would be replayed in the wrong order.
#[test]
fn a_run_after_a_change_of_a_binding_has_a_later_id_whatever_the_clock_says() {
    let mut made = Made::new();
    made.run(&Run::of("CAT00017", End::Pass));
    let change = Change {
        serial: "CAT00017",
        product: None,
        device: None,
        operator: "engineer",
        reason: &reason("x"),
    };
    made.store.rebind(&change).unwrap();
    let database = rusqlite::Connection::open(made.folder().database()).unwrap();
    let changed = database.query_row("SELECT id FROM audit", [], |row| row.get::<_, String>(0)).unwrap();
    assert!(made.store.new_id(BEGIN_MS).unwrap().to_string() > changed);
}

/// A folder whose name is mistyped, or whose disk is not mounted, would have a station that begins anew.
#[test]
fn nothing_is_bound_where_there_is_no_station_and_none_is_made() {
    let folder = folder();
    let data = folder.path().join("data");
    let did = rebind_in(&data, &["--serial", "CAT00017", "--reason", "FPGA exchanged"]);
    assert!(did.code == Some(2) && did.complained.contains("has no station's results"), "{did:?}");
    assert!(!data.exists());
}

#[test]
fn a_change_that_means_nothing_is_refused() {
    let station = Station::with(PLAN);
    station.run("CAT00017", &device(0x11));
    let unknown = rebind(&station, &["--serial", "CAT00018", "--reason", "x"]);
    assert_eq!(unknown.code, Some(2), "{unknown:?}");
    assert!(unknown.complained.contains("no unit `CAT00018` was ever tested here"), "{unknown:?}");
    for wrong in [
        vec!["--serial", "CAT00017"],
        vec!["--serial", "CAT00017", "--reason", " "],
        vec!["--serial", "CAT00017", "--reason", "x", "--device", "11"],
        vec!["--serial", "CAT00017", "--reason", "x", "--device", "0000000000000000"],
    ] {
        assert_eq!(rebind(&station, &wrong).code, Some(2), "{wrong:?}");
    }
    station.plan(&PLAN.replace("CAM-T", "CAM-U"));
    station.run("CAT00017", &device(0x12));
    let several = rebind(&station, &["--serial", "CAT00017", "--reason", "x"]);
    assert!(several.complained.contains("of CAM-T and of CAM-U"), "{several:?}");
    assert_eq!(
        rebind(&station, &["--serial", "CAT00017", "--product", "CAM-U", "--reason", "x"]).code,
        Some(0)
    );
    assert_well(&station);
}
