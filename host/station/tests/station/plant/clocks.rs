//! Runs that a plant would order wrongly because of their clock.

use std::fs;
use std::process::Command;

use halfrow_station::outbox::{HeardClock, Sink as _};
use halfrow_station::record::RunHead;
use halfrow_station::store::{SINK_OF_PLANT, StoreError};

use super::sent::sink;
use super::server::Server;
use super::waiting::{await_sent, station};
use crate::clocks::Clocks;
use crate::common::{now_ms, program};
use crate::history::made::{End, HOUR_MS, Made, Run, id};
use crate::lanes::floor::SERIALS;

/// Makes the server's clock an hour fast for whoever connects from now on.
pub(crate) const FAST: &str = "CREATE FUNCTION public.clock_timestamp() RETURNS timestamptz LANGUAGE sql
    AS $$ SELECT pg_catalog.clock_timestamp() + interval '1 hour' $$;
    ALTER DATABASE plant SET search_path = public, pg_catalog";

fn now_of(serial: &str) -> Run {
    Run { started_ms: now_ms(), ..Run::of(serial, End::Pass) }
}

/// Whether the store begins a run at this moment.
fn begun(made: &mut Made, serial: &str) -> Result<(), StoreError> {
    made.try_begin(&now_of(serial)).map(drop)
}

#[test]
fn no_run_begins_while_the_clocks_of_station_and_plant_are_apart() {
    let server = Server::prepared();
    let mut made = Made::new();
    let mut sink = sink("station 7", &mut made.store, server.address());
    made.store.sends_to(vec![SINK_OF_PLANT.to_owned()]).unwrap();
    // The control: clocks that agree.
    made.store.heard_plant(sink.beat(0, 0).unwrap().unwrap());
    made.run(&now_of("S1"));
    server.change(FAST);
    sink.rest();
    made.store.heard_plant(sink.beat(0, 0).unwrap().unwrap());
    let refused = begun(&mut made, "S2").unwrap_err();
    assert!(matches!(refused, StoreError::ClockApart { minutes: 60 }), "{refused}");
    // A station that only sends elsewhere only needs to be in order with itself.
    made.store.sends_to(vec!["mes".to_owned()]).unwrap();
    begun(&mut made, "S3").unwrap();
}

/// docs/plant.md: five minutes are tolerated.
#[test]
fn clocks_may_be_four_minutes_apart_and_not_six() {
    for (minutes, is_taken) in [(4_i64, true), (-4, true), (6, false), (-6, false)] {
        let mut made = Made::new();
        made.store.sends_to(vec![SINK_OF_PLANT.to_owned()]).unwrap();
        // Ids go on behind the last run's, whatever the clock says.
        let (head, plan) = made.begin(&now_of("S1"));
        let [id, unit_id] = [1, 2].map(|number| id(head.started_ms + minutes * 60_000, 1000 + number));
        let [serial, lane] = ["S2", "2"].map(str::to_owned);
        let behind = made.store.begin(RunHead { id, unit_id, serial, lane, ..head }, &plan);
        let is_ahead = matches!(&behind, Err(StoreError::DatedAhead { minutes: 6 }));
        assert_eq!((behind.is_ok(), is_ahead), (minutes != 6, minutes == 6), "{minutes} min: {behind:?}");
        let mut made = Made::new();
        made.store.sends_to(vec![SINK_OF_PLANT.to_owned()]).unwrap();
        made.store.heard_plant(HeardClock::shows(now_ms()));
        let run = Run { started_ms: now_ms() + minutes * 60_000, ..now_of("S1") };
        let apart = made.try_begin(&run);
        let is_apart = matches!(&apart, Err(StoreError::ClockApart { minutes: 6 }));
        assert_eq!((apart.is_ok(), is_apart), (is_taken, !is_taken), "{minutes} min: {apart:?}");
    }
}

#[test]
fn no_run_begins_after_one_that_is_dated_ahead() {
    let server = Server::prepared();
    let of_plant = station(&server, "12", "");
    let mut made = Made::new();
    made.run(&Run { started_ms: now_ms() + HOUR_MS, ..Run::of("S1", End::Pass) });
    fs::rename(made.closed().keep(), of_plant.path("data")).unwrap();
    let mut running = of_plant.start();
    running.scan(SERIALS[0]);
    running.state("1", "RUNNING");
    let lane = running.state("1", "READY");
    assert!(lane["note"].to_string().contains("dated 60 min ahead of the station's clock"), "{lane}");
    assert_eq!(of_plant.query("SELECT count(*) FROM run"), ["1"]);
    assert_eq!(running.end().0, Some(0));
}

/// When a computer was suspended, both clocks are ahead; when its clock was set, only the wall clock is.
#[test]
fn a_station_goes_on_without_its_plant_when_its_computer_slept_and_not_when_its_clock_was_set() {
    let mut server = Server::prepared();
    let of_plant = station(&server, "12", "");
    let clocks = Clocks::in_folder(&of_plant.path(""));
    let mut program = Command::new(program());
    clocks.of(&mut program);
    let mut running = of_plant.started(program);
    running.scan(SERIALS[0]);
    running.state("1", "PASS");
    // The station got the plant's clock before it sent anything.
    await_sent(&of_plant);
    server.kill();
    let mut came_to = |serial: &str| {
        running.scan(serial);
        running.state("1", "RUNNING");
        running.wait("an end", |news| news["state"] == "READY" || news["shown"]["serial"] == serial)
    };
    clocks.ahead(3600, 0);
    let refused = came_to(SERIALS[1]);
    assert!(refused["note"].to_string().contains(" min apart, and the plant uses"), "{refused}");
    clocks.ahead(3600, 3600);
    let slept = came_to(SERIALS[1]);
    assert_eq!(slept["shown"]["verdict"], "PASS", "{slept}");
    assert_eq!(running.end().0, Some(0));
}
