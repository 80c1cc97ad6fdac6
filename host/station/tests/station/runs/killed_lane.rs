//! The process of a lane is killed at its system calls, while another lane of the same station works.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use halfrow::Verdict;
use halfrow::verdict::StoppedBy;
use halfrow_station::labgrid::LaneBoard;
use halfrow_station::lane::MEMORY_MIB;
use halfrow_station::plan::Plan;
use halfrow_station::record::RunCause;
use halfrow_station::run::{Order, Saved, Stage, Watch, run};
use halfrow_station::store::{SharedStore, Store};

use super::bench::{PLAN, Station, program};
use super::unsaved::{Call, numbered};
use crate::common::{Over, script};

/// A run that nobody ends or watches.
struct Unwatched;

impl Watch for Unwatched {
    fn stop(&self) -> Option<StoppedBy> {
        None
    }

    fn hear(&mut self, _: Stage<'_>) {}
}

/// A run in this lane, whose process runs `program`.
pub(super) fn run_in(
    store: &SharedStore,
    station: &Station,
    lane: &str,
    serial: &str,
    program: &Path,
) -> Saved {
    let plan_file = station.path("plan.toml");
    let plan = Plan::load(&plan_file).unwrap();
    let board = LaneBoard::Own("mock".parse().unwrap());
    let order = Order {
        plan: &plan,
        plan_file: &plan_file,
        serial,
        board: &board,
        station: "12",
        lane,
        operator: "weber",
        program,
        counts: false,
        job: None,
        silence: Duration::from_secs(120),
        memory_mib: MEMORY_MIB,
    };
    run(store, &order, &mut Unwatched).unwrap()
}

/// A script that traces the program with the options in a file next to it. strace ends the way the traced program ended.
fn traced(station: &Station) -> PathBuf {
    let options = station.path("options");
    let lines = format!("exec strace -qq $(cat {}) {} \"$@\"\n", options.display(), program().display());
    script(&station.path(""), "traced", &lines)
}

/// Every call of the lane's first thread, in order, except those of the start and the end.
fn all_calls(station: &Station, store: &SharedStore, lane: &Path) -> Vec<Call> {
    let log = station.path("calls");
    fs::write(station.path("options"), format!("-e signal=none -o {}", log.display())).unwrap();
    assert_eq!(run_in(store, station, "1", "CAT00001", lane).record.conclusion.verdict, Verdict::Pass);
    let all = numbered(&fs::read_to_string(log).unwrap());
    // strace cannot kill at a call that does not return, nor at the one that starts the program.
    all.into_iter().filter(|(name, _)| !["execve", "exit_group"].contains(&name.as_str())).collect()
}

/// Whether the lane was killed before it had sent everything, which makes its run an ERROR.
fn killed_at(
    (name, number): (&str, usize),
    store: &SharedStore,
    station: &Station,
    lane: &Path,
    serial: &str,
) -> bool {
    let options = format!("-o /dev/null -e inject={name}:signal=KILL:when={number}");
    fs::write(station.path("options"), options).unwrap();
    let saved = run_in(store, station, "1", serial, lane);
    let ended = &saved.record.conclusion;
    if ended.verdict == Verdict::Pass {
        return false;
    }
    assert_eq!((ended.verdict, ended.cause), (Verdict::Error, RunCause::Crash), "{name} {number}: {ended:?}");
    assert!(ended.headline.contains("signal: 9"), "{name} {number}: {ended:?}");
    true
}

/// Kills the lane at each of these calls. Returns how often that was in time, and how often the lane had already sent everything.
fn sweep(choose: impl Fn(Vec<Call>) -> Vec<Call>) -> (usize, usize) {
    let station = Station::with(PLAN);
    let store = SharedStore::new(Store::open(&station.store()).unwrap());
    let lane = traced(&station);
    let all = all_calls(&station, &store, &lane);
    assert!(all.len() > 100, "{all:?}");
    let points = choose(all);
    let is_over = AtomicBool::new(false);
    let (mut killed, mut done) = (0, 0);
    thread::scope(|scope| {
        let beside = scope.spawn(|| {
            let mut runs = 0;
            while !is_over.load(Ordering::Relaxed) {
                let saved = run_in(&store, &station, "2", "CAT99999", program());
                assert_eq!(saved.record.conclusion.verdict, Verdict::Pass, "{:?}", saved.record.conclusion);
                runs += 1;
            }
            runs
        });
        let over = Over(&is_over);
        for ((name, number), serial) in points.iter().zip(10_000..) {
            if killed_at((name, *number), &store, &station, &lane, &format!("CAT{serial}")) {
                killed += 1;
            } else {
                done += 1;
            }
        }
        drop(over);
        assert!(beside.join().unwrap() > 0);
    });
    drop(store);
    let doubled = "SELECT unit_id FROM run WHERE lane = '1' GROUP BY unit_id HAVING count(*) <> 1";
    assert_eq!(station.query(doubled), Vec::<String>::new());
    assert_eq!(station.query("SELECT count(*) FROM run WHERE state = 'open'"), ["0"]);
    assert_eq!(station.query("SELECT count(*) FROM run WHERE verdict = 'ERROR'"), [killed.to_string()]);
    assert_eq!(station.check().code, Some(0), "{:?}", station.check());
    (killed, done)
}

/// A pipe holds 64 KiB: a longer job is not fully written before its reader is gone.
#[test]
fn a_lane_that_ends_before_it_has_its_job_is_told_by_how_it_ended() {
    let station = Station::with(&format!("{PLAN}# {}\n", "-".repeat(1 << 18)));
    let store = SharedStore::new(Store::open(&station.store()).unwrap());
    let ended = run_in(&store, &station, "1", "CAT00001", Path::new("/bin/false")).record.conclusion;
    assert_eq!((ended.verdict, ended.cause), (Verdict::Error, RunCause::Crash), "{ended:?}");
    assert!(ended.headline.contains("exit status: 1"), "{ended:?}");
}

#[test]
fn a_lane_that_is_killed_anywhere_is_an_error_and_the_lane_beside_goes_on() {
    let (killed, _) = sweep(|all| {
        let one_in = all.len() / 24;
        all.into_iter().enumerate().filter(|(number, _)| number % one_in == 0).map(|(_, call)| call).collect()
    });
    assert!(killed >= 12, "{killed}");
}

/// At every call.
#[test]
#[ignore = "for scripts/soak"]
fn a_lane_that_is_killed_at_any_call_is_an_error_and_the_lane_beside_goes_on() {
    let (killed, done) = sweep(|all| all);
    println!("the lane was killed at {killed} calls, and had told all before {done} others");
    assert!(killed > 100, "{killed}");
}
