//! Runs of one unit arrive from several stations in any order, and are counted as one station would have counted them.

use halfrow_station::store::{Entry, Kind, Parcel, Plant};

use super::server::Server;
use crate::history::generated::Draw;
use crate::history::made::{BEGIN_MS, DAY_MS, End, Made, Run};

const STATIONS: [&str; 3] = ["station 7", "station 8", "station 9"];

/// What is counted, with serial numbers instead of the units' ids, which depend on who came first.
const COUNTED: [&str; 4] = [
    "SELECT run.id, unit.serial, run.nth FROM run JOIN unit ON unit.id = run.unit_id ORDER BY run.id",
    "SELECT * FROM day_count WHERE runs > 0 ORDER BY plan_sha256, station, lane, day",
    "SELECT unit.serial, plan, judgements, first_run, first_plan_sha256, station, lane, first_ms, first_verdict, last_run,
        last_ms, last_verdict
     FROM retest JOIN unit ON unit.id = retest.unit_id ORDER BY unit.serial, plan",
    "SELECT unit.serial, failure.run_id, kind, name, plan_sha256, lane, started_ms
     FROM failure JOIN unit ON unit.id = failure.unit_id ORDER BY run_id, kind, name",
];

/// Random runs of a few units, each judged several times under two plans on three stations.
pub(super) fn drawn(draw: &mut Draw) -> Vec<Run> {
    let ends = [
        End::Pass,
        End::Pass,
        End::Fail(&["clock"]),
        End::TooLate,
        End::Error(halfrow_station::record::RunCause::Link),
    ];
    let run = |number: i64| Run {
        plan: [("final", "1"), ("final", "2"), ("intake", "1")][draw.below(3) as usize],
        station: STATIONS[draw.below(3) as usize],
        started_ms: BEGIN_MS + number * DAY_MS / 3,
        ..Run::of(&format!("U{}", draw.below(3)), ends[draw.below(5) as usize])
    };
    (0..24).map(run).collect()
}

/// Everything that is counted when one station has all the runs.
fn at_one(runs: &[Run]) -> Vec<Vec<Vec<String>>> {
    let mut made = Made::new();
    for (run, number) in runs.iter().zip(1..) {
        made.numbered(number, run);
    }
    let database = rusqlite::Connection::open(made.folder().database()).unwrap();
    let select = |text: &str| {
        let mut statement = database.prepare(text).unwrap();
        let columns = statement.column_count();
        let value = |row: &rusqlite::Row<'_>, at| match row.get(at).unwrap() {
            rusqlite::types::Value::Integer(whole) => whole.to_string(),
            rusqlite::types::Value::Text(text) => text,
            other => panic!("{other:?}"),
        };
        let rows =
            statement.query_map([], |row| Ok((0..columns).map(|at| value(row, at)).collect())).unwrap();
        rows.map(Result::unwrap).collect()
    };
    COUNTED.map(select).to_vec()
}

/// What the stations send of these runs.
pub(super) fn parcels(runs: &[Run]) -> Vec<Parcel> {
    let mut stations: Vec<_> = STATIONS.iter().map(|_| Made::new()).collect();
    let parcel = |(run, number): (&Run, u32)| {
        let place = STATIONS.iter().position(|name| *name == run.station).unwrap();
        let subject = stations[place].numbered(number, run);
        stations[place].folder().parcel(&Entry { kind: Kind::Run, subject, attempts: 0 }).unwrap()
    };
    runs.iter().zip(1..).map(parcel).collect()
}

pub(super) fn shuffled(parcels: &[Parcel], draw: &mut Draw) -> Vec<usize> {
    let mut order: Vec<_> = (0..parcels.len()).collect();
    for at in (1..order.len()).rev() {
        order.swap(at, draw.below(at as u64 + 1) as usize);
    }
    order
}

#[test]
fn in_whatever_order_runs_come_they_are_counted_as_if_one_station_had_them() {
    orders(5);
}

#[test]
#[ignore = "for scripts/soak"]
fn in_hundreds_of_orders_runs_are_counted_as_if_one_station_had_them() {
    orders(300);
}

/// `count` random histories, each in a random order.
fn orders(count: u32) {
    let server = Server::prepared();
    let mut draw = Draw(7);
    for case in 0..count {
        let runs = drawn(&mut draw);
        let (expected, parcels) = (at_one(&runs), parcels(&runs));
        let order = if case == 0 { (0..runs.len()).rev().collect() } else { shuffled(&parcels, &mut draw) };
        server.change("TRUNCATE plan, unit, run, record CASCADE");
        let mut plant = Plant::connect(&server.address()).unwrap();
        for place in &order {
            plant.take(&parcels[*place]).unwrap();
            // Sometimes it is unknown whether a parcel arrived, so it is sent twice.
            if draw.below(4) == 0 {
                plant.take(&parcels[*place]).unwrap();
            }
        }
        for (text, expected) in COUNTED.iter().zip(expected) {
            assert_eq!(server.rows(text), expected, "case {case}, order {order:?}\n{text}");
        }
    }
}

/// All stations send at the same time.
#[test]
fn stations_that_send_at_once_count_each_unit_once() {
    let server = Server::prepared();
    let runs = drawn(&mut Draw(11));
    let (expected, parcels) = (at_one(&runs), parcels(&runs));
    std::thread::scope(|scope| {
        for first in 0..6 {
            let (address, parcels) = (server.address(), &parcels);
            scope.spawn(move || {
                let mut plant = Plant::connect(&address).unwrap();
                // Each parcel is sent by two threads, which begin at opposite ends.
                let mine = parcels.iter().skip(first % 3).step_by(3);
                let mine: Vec<_> = if first < 3 { mine.collect() } else { mine.rev().collect() };
                for parcel in mine {
                    // Who lost a race tries again, as the outbox does.
                    while let Err(error) = plant.take(parcel) {
                        assert!(!error.is_away(), "{error:?}");
                    }
                }
            });
        }
    });
    for (text, expected) in COUNTED.iter().zip(expected) {
        assert_eq!(server.rows(text), expected, "{text}");
    }
}

/// The mock that checks a shift is no unit at the plant, either.
#[test]
fn the_mock_that_checks_a_shift_counts_nowhere_at_the_plant() {
    let server = Server::prepared();
    let mut plant = Plant::connect(&server.address()).unwrap();
    for parcel in parcels(&[Run::of("HR:MOCK:1", End::Fail(&["clock"])), Run::of("U1", End::Pass)]) {
        plant.take(&parcel).unwrap();
    }
    let nths = "SELECT run.nth FROM run JOIN unit ON unit.id = run.unit_id ORDER BY unit.serial";
    assert_eq!(server.rows(nths), [["0"], ["1"]]);
    assert_eq!(server.rows("SELECT sum(runs)::bigint FROM day_count"), [["1"]]);
    assert_eq!(server.rows("SELECT count(*) FROM failure"), [["0"]]);
}
