//! How many jobs a plant gives out, and how long each station waits for one.

use std::thread;
use std::time::{Duration, Instant};

use halfrow_station::store::Plant;

use super::{add, shared, worker};

/// How many stations take jobs at the same time, and how many jobs a second they take together.
const STATIONS: usize = 100;
const A_SECOND: usize = 50;
/// For how long.
const TAKEN: Duration = Duration::from_secs(30);

/// How long each claim of a station took.
fn waits(server: &crate::plant::server::Server, number: usize) -> Vec<Duration> {
    let mut plant = Plant::connect(&server.address()).unwrap();
    let worker = worker(&format!("station {number}"));
    let pace = Duration::from_secs_f64(STATIONS as f64 / A_SECOND as f64);
    let (mut waits, begun) = (Vec::new(), Instant::now());
    thread::sleep(pace.mul_f64(number as f64 / STATIONS as f64));
    while begun.elapsed() < TAKEN {
        let asked = Instant::now();
        let claim = plant.claim(&worker).unwrap().unwrap();
        waits.push(asked.elapsed());
        thread::sleep(pace.saturating_sub(asked.elapsed()));
        plant.fail(&claim, "only its rate is of interest").unwrap();
        plant.give_back(&claim.lease).unwrap();
    }
    waits
}

#[test]
#[ignore = "for scripts/soak: a figure of a machine that does nothing else"]
fn a_hundred_stations_get_fifty_jobs_a_second() {
    let (server, mut plant) = shared(STATIONS + 10);
    add(&mut plant, 10_000);
    let mut all: Vec<_> = thread::scope(|scope| {
        let server = &server;
        let stations: Vec<_> =
            (0..STATIONS).map(|number| scope.spawn(move || waits(server, number))).collect();
        stations.into_iter().flat_map(|station| station.join().unwrap()).collect()
    });
    all.sort();
    let rate = all.len() as f64 / TAKEN.as_secs_f64();
    let [half, most] = [50, 99].map(|percent| all[all.len() * percent / 100].as_secs_f64() * 1e3);
    println!(
        "{STATIONS} stations, 10,000 jobs: {rate:.1} claims/s, half within {half:.1} ms, 99 of 100 within {most:.1} ms"
    );
    assert!(rate > 0.9 * A_SECOND as f64, "{rate}");
}
