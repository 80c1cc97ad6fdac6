//! Devices and units that two stations bound differently, since neither knew of the other.

use std::process::Command;

use halfrow_station::history::mismatch::{Mismatch, mismatches};
use halfrow_station::record::DeviceSeen;
use halfrow_station::store::{AuditLine, Change, Parcel, Plant, Snapshot};
use serde_json::Value;

use super::checked::faults;
use super::late::parcels;
use super::pages::{served, settings, text};
use super::sent::send_as;
use super::server::Server;
use crate::common::{Did, program, reason};
use crate::history::commands::misread;
use crate::history::made::{BEGIN_MS, DAY_MS, End, HOUR_MS, Made, Run, id};
use crate::metrics::text::Figures;

/// Long before anything that a person does while a test runs.
const LONG_AGO_MS: i64 = BEGIN_MS - 2_000 * DAY_MS;

const DEVICES: [&str; 4] = ["00000000000000d1", "00000000000000d2", "00000000000000d3", "00000000000000d4"];

/// A station that judged these units, each with a device that was new to it.
fn station(name: &'static str, first: u32, judged: &[(&str, &'static str)]) -> Made {
    let mut made = Made::new();
    for ((serial, device), number) in judged.iter().zip(first..) {
        judge(&mut made, name, number, serial, (DeviceSeen::New, *device));
    }
    made
}

fn judge(
    made: &mut Made,
    station: &'static str,
    number: u32,
    serial: &str,
    device: (DeviceSeen, &'static str),
) {
    made.numbered(number, &judged(station, number, serial, device));
}

/// A run in the `number`-th hour.
fn judged(station: &'static str, number: u32, serial: &str, device: (DeviceSeen, &'static str)) -> Run {
    let started_ms = LONG_AGO_MS + i64::from(number) * HOUR_MS;
    Run { station, started_ms, device: Some(device), ..Run::of(serial, End::Pass) }
}

/// Two stations that saw D1 on different units, and B3 with different devices; about B4 they agree.
pub(super) fn two() -> [Made; 2] {
    let [d1, d2, d3, d4] = DEVICES;
    [
        station("station 7", 1, &[("B1", d1), ("B3", d2), ("B4", d4)]),
        station("station 8", 11, &[("B2", d1), ("B3", d3), ("B4", d4)]),
    ]
}

pub(super) fn found(server: &Server) -> Vec<Mismatch> {
    let plant = Plant::connect(&server.address()).unwrap();
    mismatches(&Snapshot::of_plant(plant).unwrap()).unwrap()
}

/// Each mismatch: which station saw which device as which unit, and which binding that contradicts.
fn told(server: &Server) -> Vec<String> {
    let mut told: Vec<_> = found(server)
        .into_iter()
        .map(|one| {
            let by = one.bound.station.unwrap_or_else(|| "a person".to_owned());
            let end = |device: &str| device[14..].to_owned();
            let ours = format!("{}: {} as {}", one.station, end(&one.device), one.serial);
            format!("{ours}, {by}: {} as {}", end(&one.bound.device), one.bound.serial)
        })
        .collect();
    told.sort();
    told
}

#[test]
fn what_two_stations_bound_differently_is_told_whoever_came_first() {
    let server = Server::prepared();
    let [seven, eight] = two();
    send_as("station 7", seven, server.address());
    assert_eq!(told(&server), [""; 0]);
    send_as("station 8", eight, server.address());
    let expected = ["station 8: d1 as B2, station 7: d1 as B1", "station 8: d3 as B3, station 7: d2 as B3"];
    assert_eq!(told(&server), expected);
    // The other way round.
    let server = Server::prepared();
    let [seven, eight] = two();
    send_as("station 8", eight, server.address());
    send_as("station 7", seven, server.address());
    let expected = ["station 7: d1 as B1, station 8: d1 as B2", "station 7: d2 as B3, station 8: d3 as B3"];
    assert_eq!(told(&server), expected);
}

#[test]
fn a_person_who_binds_anew_settles_it_until_somebody_judges_otherwise_again() {
    let server = Server::prepared();
    let [seven, mut eight] = two();
    send_as("station 7", seven, server.address());
    let [d1, ..] = DEVICES;
    let rebind = |made: &mut Made, serial, device| {
        let change =
            Change { serial, product: None, device, operator: "engel", reason: &reason("labels exchanged") };
        made.store.rebind(&change).unwrap();
    };
    rebind(&mut eight, "B3", None);
    let (mut eight, _) = send_as("station 8", eight, server.address());
    assert_eq!(told(&server), ["station 8: d1 as B2, station 7: d1 as B1"]);
    rebind(&mut eight, "B2", Some("00000000000000d9"));
    let (mut eight, _) = send_as("station 8", eight, server.address());
    assert_eq!(told(&server), [""; 0]);
    // A device seen in an ERROR, or not checked, says nothing about which unit it is.
    let later = |number| BEGIN_MS + 4_000 * DAY_MS + number;
    let device = Some((DeviceSeen::Known, d1));
    let mut run = Run { station: "station 8", device, started_ms: later(1), ..Run::of("B2", End::Pass) };
    let error = End::Error(halfrow_station::record::RunCause::Link);
    eight.numbered(21, &Run { end: error, ..run.clone() });
    run.started_ms = later(2);
    eight.numbered(22, &Run { device: Some((DeviceSeen::NotChecked, d1)), ..run.clone() });
    let (mut eight, _) = send_as("station 8", eight, server.address());
    assert_eq!(told(&server), [""; 0]);
    run.started_ms = later(3);
    eight.numbered(23, &run);
    send_as("station 8", eight, server.address());
    let again = ["station 8: d1 as B2, a person: d9 as B2", "station 8: d1 as B2, station 7: d1 as B1"];
    assert_eq!(told(&server), again);
}

#[test]
fn it_is_on_the_pages_in_what_the_command_says_and_in_the_figures() {
    let server = Server::prepared();
    let [seven, eight] = two();
    let (seven, _) = send_as("station 7", seven, server.address());
    let (folder, serving) = served(&server);
    let browser = serving.here();
    let count = || Figures::of(&serving).at("halfrow_plant_device_mismatches");
    assert!(count() == 0.0 && !text(&browser, "/").contains("differently"));
    send_as("station 8", eight, server.address());
    assert_eq!(count(), 2.0);
    let stations = text(&browser, "/");
    for expected in ["Bound differently", "station 8", "/unit?serial=B2", DEVICES[0], DEVICES[2]] {
        assert!(stations.contains(expected), "{expected}: {stations}");
    }
    for (serial, is_told) in [("B1", true), ("B2", true), ("B3", true), ("B4", false)] {
        let page = text(&browser, &format!("/unit?serial={serial}"));
        assert_eq!(page.contains("Bound differently"), is_told, "{serial}: {page}");
    }
    let plant = settings(&server, folder.path(), "");
    let unit = |place: &[&str], serial: &str| -> Did {
        Command::new(program()).arg("unit").arg(serial).args(place).output().unwrap().into()
    };
    let at_plant = ["--plant", plant.to_str().unwrap()];
    let said = unit(&at_plant, "B2");
    let expected = format!("mismatch  station 8 judges device {} as B2, last ", DEVICES[0]);
    assert!(said.code == Some(0) && said.said.contains(&expected), "{said:?}");
    let told = serde_json::from_str(&unit(&[&at_plant[..], &["--json"]].concat(), "B2").said).unwrap();
    assert_eq!(misread("unit", &told), Vec::<String>::new(), "{told:#}");
    assert!(said.said.contains(&format!("here B1 is device {} since ", DEVICES[0])), "{said:?}");
    assert!(!unit(&at_plant, "B4").said.contains("mismatch"));
    // A station has none of its own, from its own engine.
    let data = seven.folder().path().to_owned();
    let ours = unit(&["--json", "--data", data.to_str().unwrap()], "B1").said;
    let ours: Value = serde_json::from_str(&ours).unwrap();
    assert_eq!(ours[0]["mismatches"], Value::Array(Vec::new()));
}

/// A change of a binding in the form in which a station sends it, in the `number`-th hour after all runs.
fn rebinding(number: u32, serial: &str, device: Option<&str>) -> Parcel {
    let at_ms = LONG_AGO_MS + i64::from(100 + number) * HOUR_MS;
    Parcel::Audit(AuditLine {
        id: id(at_ms, number),
        at_ms,
        operator: "engel".to_owned(),
        act: "rebind".to_owned(),
        subject: "its unit at the station".to_owned(),
        detail: serde_json::json!({ "device": device, "reason": format!("change {number}") }).to_string(),
        unit: Some(["CAM-T".to_owned(), serial.to_owned()]),
    })
}

/// All bindings: the unit, the end of the device's number, and the hours from and to which they hold.
fn bound(server: &Server) -> Vec<String> {
    let text = format!(
        "SELECT unit.serial || ' ' || right(device, 2) || ' ' || (from_ms - {LONG_AGO_MS}) / {HOUR_MS}
           || ' to ' || coalesce(((to_ms - {LONG_AGO_MS}) / {HOUR_MS})::text, 'now')
         FROM binding JOIN unit ON unit.id = binding.unit_id ORDER BY binding.id"
    );
    server.rows(&text).into_iter().flatten().collect()
}

/// All orders of `count` things.
fn orders(count: usize) -> Vec<Vec<usize>> {
    let Some(last) = count.checked_sub(1) else { return vec![Vec::new()] };
    let with = |order: Vec<usize>| {
        (0..count).map(move |place| {
            let (before, behind) = order.split_at(place);
            [before, &[last], behind].concat()
        })
    };
    orders(last).into_iter().flat_map(with).collect()
}

#[test]
fn the_newest_change_of_a_binding_holds_in_whatever_order_they_come() {
    let server = Server::prepared();
    let [d1, d2, d3, _] = DEVICES;
    let seven = station("station 7", 1, &[("B1", d1), ("B2", d2)]);
    send_as("station 7", seven, server.address());
    assert_eq!(bound(&server), ["B1 d1 1 to now", "B2 d2 2 to now"]);
    let changes = [
        rebinding(1, "B1", Some(d3)),
        rebinding(2, "B2", Some(d1)),
        rebinding(3, "B1", None),
        rebinding(4, "B2", Some(d3)),
    ];
    let expected =
        ["B1 d1 1 to 101", "B2 d2 2 to 102", "B1 d3 101 to 103", "B2 d1 102 to 104", "B2 d3 104 to now"];
    let before =
        "DELETE FROM audit; DELETE FROM binding WHERE by_operator = 'engel'; UPDATE binding SET to_ms = NULL";
    let mut plant = Plant::connect(&server.address()).unwrap();
    let orders = orders(changes.len());
    assert_eq!(orders.len(), 24);
    for order in orders {
        server.change(before);
        for place in &order {
            plant.take(&changes[*place]).unwrap();
        }
        assert_eq!(bound(&server), expected, "{order:?}");
        assert_eq!(faults(&server, "plant"), [""; 0], "{order:?}");
    }
}

#[test]
fn what_a_run_bound_since_is_not_ended_by_a_change_that_comes_late() {
    let server = Server::prepared();
    let [d1, _, _, d4] = DEVICES;
    send_as("station 7", station("station 7", 1, &[("B1", d1)]), server.address());
    // Its device is the one that the person gives to B1.
    send_as("station 8", station("station 8", 110, &[("B4", d4)]), server.address());
    let mut plant = Plant::connect(&server.address()).unwrap();
    plant.take(&rebinding(1, "B1", Some(d4))).unwrap();
    assert_eq!(bound(&server), ["B1 d1 1 to 101", "B1 d4 101 to 110", "B4 d4 110 to now"]);
    assert_eq!(faults(&server, "plant"), [""; 0]);
}

/// The runs of B1 on one station and of B2 on another, with the same device; B2's later run arrives first.
#[test]
fn a_mismatch_is_as_new_as_its_newest_run_in_whatever_order_they_come() {
    let server = Server::prepared();
    let device = |seen| (seen, DEVICES[0]);
    let [first, earlier, later] = &parcels(&[
        judged("station 7", 1, "B1", device(DeviceSeen::New)),
        judged("station 8", 2, "B2", device(DeviceSeen::New)),
        judged("station 8", 3, "B2", device(DeviceSeen::Known)),
    ])[..] else {
        panic!("three runs")
    };
    let mut plant = Plant::connect(&server.address()).unwrap();
    for parcel in [first, later, earlier] {
        plant.take(parcel).unwrap();
    }
    let newest: Vec<_> = found(&server).into_iter().map(|one| (one.serial, one.last_ms)).collect();
    assert_eq!(newest, [("B2".to_owned(), LONG_AGO_MS + 3 * HOUR_MS)]);
    assert_eq!(faults(&server, "plant"), [""; 0]);
}

/// A person binds the unit anew at the moment at which its second run begins.
#[test]
fn what_a_run_began_with_is_no_mismatch_though_it_is_bound_otherwise_since() {
    let server = Server::prepared();
    let [d1, _, d3, _] = DEVICES;
    let [first, second] = &parcels(&[
        judged("station 7", 1, "B1", (DeviceSeen::New, d1)),
        judged("station 7", 2, "B1", (DeviceSeen::Known, d1)),
    ])[..] else {
        panic!("two runs")
    };
    let Parcel::Audit(change) = rebinding(1, "B1", Some(d3)) else { panic!("a line of the audit") };
    let at_ms = LONG_AGO_MS + 2 * HOUR_MS;
    let change = Parcel::Audit(AuditLine { id: id(at_ms, 1), at_ms, ..change });
    let mut plant = Plant::connect(&server.address()).unwrap();
    for parcel in [first, &change, second] {
        plant.take(parcel).unwrap();
    }
    assert_eq!(bound(&server), ["B1 d1 1 to 2", "B1 d3 2 to now"]);
    assert_eq!(told(&server), [""; 0]);
    assert_eq!(faults(&server, "plant"), [""; 0]);
}

/// A person has given the device to another unit since, of which the second station does not know.
#[test]
fn what_was_bound_until_a_person_changed_it_is_a_mismatch_afterwards() {
    let server = Server::prepared();
    let [d1, d2, ..] = DEVICES;
    send_as("station 7", station("station 7", 1, &[("B1", d1), ("B2", d2)]), server.address());
    let mut plant = Plant::connect(&server.address()).unwrap();
    plant.take(&rebinding(1, "B2", Some(d1))).unwrap();
    let [before, after] = &parcels(&[
        judged("station 8", 3, "B1", (DeviceSeen::New, d1)),
        judged("station 8", 150, "B1", (DeviceSeen::Known, d1)),
    ])[..] else {
        panic!("two runs")
    };
    plant.take(before).unwrap();
    assert_eq!(told(&server), [""; 0]);
    plant.take(after).unwrap();
    assert_eq!(told(&server), ["station 8: d1 as B1, a person: d1 as B2"]);
}
