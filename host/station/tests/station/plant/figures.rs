//! How many runs a second a plant takes, and how large it grows.

use std::sync::mpsc::{Receiver, sync_channel};
use std::thread;
use std::time::Instant;

use halfrow_station::check::check_plant;
use halfrow_station::store::{Plant, Snapshot};

use super::sent::send_as;
use super::server::Server;
use crate::common::{engel, reason, untold};
use crate::history::made::{BEGIN_MS, End, Made, Run};

/// A year of two hundred stations, each with two hundred boards a day.
const YEAR: f64 = 200.0 * 200.0 * 365.0;
/// How many runs there are in a folder, which is deleted when they are sent.
const FOLDER: u32 = 20_000;

/// `count` runs in folders, one in thirty of them a FAIL; the next folder is made while one is sent.
fn made(count: u32) -> Receiver<Made> {
    let (sender, folders) = sync_channel(0);
    thread::spawn(move || {
        for first in (0..count).step_by(FOLDER as usize) {
            let mut made = Made::new();
            for number in first..count.min(first + FOLDER) {
                let end = if number % 30 == 0 { End::Fail(&["clock"]) } else { End::Pass };
                let started_ms = BEGIN_MS + i64::from(number) * 2_000;
                made.run(&Run { started_ms, ..Run::of(&format!("S{number}"), end) });
            }
            sender.send(made).unwrap();
        }
    });
    folders
}

#[test]
#[ignore = "for scripts/soak: a figure of a machine that does nothing else"]
fn a_plant_takes_so_many_runs_a_second_and_grows_by_so_much() {
    let count = std::env::var("HALFROW_PLANT_RUNS").map_or(20_000, |count| count.parse().unwrap());
    let server = Server::prepared();
    let size = || {
        let rows = server.rows("SELECT pg_database_size('plant')");
        rows[0][0].parse::<f64>().unwrap()
    };
    let (empty, mut sent, mut seconds) = (size(), 0, 0.0);
    for (made, number) in made(count).into_iter().zip(1..) {
        let begun = Instant::now();
        let (_made, all) = send_as(&format!("station {number}"), made, server.address());
        assert!(!all.is_away && all.failed == 0, "{all:?}");
        let took = begun.elapsed().as_secs_f64();
        (sent, seconds) = (sent + all.sent, seconds + took);
        println!("{sent} runs, {:.0} runs/s, {:.0} MB", all.sent as f64 / took, size() / 1e6);
    }
    assert_eq!(sent, count as usize);
    let (rate, each) = (f64::from(count) / seconds, (size() - empty) / f64::from(count));
    println!("{count} runs by one outbox: {rate:.0} runs/s, {each:.0} bytes each");
    println!(
        "a year of {YEAR:.0} runs: {:.1} GB, {:.1} runs/s on average",
        YEAR * each / 1e9,
        YEAR / 31_536_000.0
    );
    println!("{}", vacuumed(&server, "VACUUM ANALYZE"));
    let mut plant = Plant::connect(&server.address()).unwrap();
    let begun = Instant::now();
    let checked = check_plant(&Snapshot::of_plant(plant).unwrap(), &mut untold).unwrap();
    assert!(checked.faults.is_empty() && checked.runs == count as usize, "{checked:?}");
    println!("plant check in {:.0} s", begun.elapsed().as_secs_f64());
    plant = Plant::connect(&server.address()).unwrap();
    let begun = Instant::now();
    let removed = plant.prune(1, engel(&reason("the figure")), &mut untold).unwrap();
    println!("plant prune of all runs: {removed} rows in {:.0} s", begun.elapsed().as_secs_f64());
    println!("{}", vacuumed(&server, "VACUUM (FULL, ANALYZE)"));
}

/// Runs this statement, and lists the sizes of the tables.
fn vacuumed(server: &Server, how: &str) -> String {
    let begun = Instant::now();
    server.change(how);
    let mut told = format!("{how} in {:.0} s", begun.elapsed().as_secs_f64());
    let tables = "SELECT relname, n_live_tup, pg_total_relation_size(relid) FROM pg_stat_user_tables WHERE n_live_tup > 0 ORDER BY 3 DESC";
    for row in server.rows(tables) {
        told += &format!("\n  {:<12} {:>9} rows {:>12} bytes", row[0], row[1], row[2]);
    }
    told
}
