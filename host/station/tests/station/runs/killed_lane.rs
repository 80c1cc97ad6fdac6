//! The process of a lane is killed at its calls, while another lane of the same station works.

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use halfrow::Verdict;
use halfrow::verdict::StoppedBy;
use halfrow_station::lane::MEMORY_MIB;
use halfrow_station::plan::Plan;
use halfrow_station::record::RunCause;
use halfrow_station::run::{Order, Saved, Stage, Watch, run};
use halfrow_station::store::{SharedStore, Store};

use super::bench::{PLAN, Station, program};
use super::unsaved::Call;

/// Nobody ends the run, or looks at it.
struct Unwatched;

impl Watch for Unwatched {
    fn stop(&self) -> Option<StoppedBy> {
        None
    }

    fn hear(&mut self, _: Stage<'_>) {}
}

/// A run in this lane, whose process is one of `program`.
fn run_in(store: &SharedStore, station: &Station, lane: &str, serial: &str, program: &Path) -> Saved {
    let plan_file = station.path("plan.toml");
    let plan = Plan::load(&plan_file).unwrap();
    let target = "mock".parse().unwrap();
    let order = Order {
        plan: &plan,
        plan_file: &plan_file,
        serial,
        target: &target,
        station: "12",
        lane,
        operator: "weber",
        program,
        counts: false,
        silence: Duration::from_secs(120),
        memory_mib: MEMORY_MIB,
    };
    run(store, &order, &mut Unwatched).unwrap()
}

/// The program, traced: strace ends as what it traces has ended.
fn traced(station: &Station, options: &str) -> PathBuf {
    let path = station.path("traced");
    let script = format!("#!/bin/sh\nexec strace -qq {options} {} \"$@\"\n", program().display());
    // Written aside: a file that somebody still executes cannot be written to.
    let aside = station.path("traced.new");
    fs::write(&aside, script).unwrap();
    fs::set_permissions(&aside, fs::Permissions::from_mode(0o755)).unwrap();
    fs::rename(aside, &path).unwrap();
    path
}

/// Every call of the lane's first thread, in order, from the first one of the program itself on.
fn all_calls(station: &Station, store: &SharedStore) -> Vec<Call> {
    let log = station.path("calls");
    let lane = traced(station, &format!("-e signal=none -o {}", log.display()));
    assert_eq!(run_in(store, station, "1", "CAT00001", &lane).record.conclusion.verdict, Verdict::Pass);
    let mut counts = BTreeMap::new();
    let text = fs::read_to_string(log).unwrap();
    let names = text.lines().filter_map(|line| line.split_once('(')).map(|(name, _)| name.to_owned());
    let numbered = names.map(|name| {
        let count = counts.entry(name.clone()).or_insert(0);
        *count += 1;
        (name, *count)
    });
    // strace cannot end a call that does not return, nor the one by which the program begins.
    numbered.filter(|(name, _)| !["execve", "exit_group"].contains(&name.as_str())).collect()
}

/// Ends what goes on beside, also when the test fails.
struct Over<'a>(&'a AtomicBool);

impl Drop for Over<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Kills the lane at each of these calls. Returns how often that was in time.
fn sweep(choose: impl Fn(Vec<Call>) -> Vec<Call>) -> usize {
    let station = Station::with(PLAN);
    let store = SharedStore::new(Store::open(&station.store()).unwrap());
    let all = all_calls(&station, &store);
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
            let options = format!("-o /dev/null -e inject={name}:signal=KILL:when={number}");
            let saved = run_in(&store, &station, "1", &format!("CAT{serial}"), &traced(&station, &options));
            let ended = &saved.record.conclusion;
            match ended.verdict {
                // It had told all before it came to this call.
                Verdict::Pass => done += 1,
                Verdict::Error => {
                    assert_eq!(ended.cause, RunCause::Crash, "{name} {number}: {ended:?}");
                    assert!(ended.headline.contains("signal: 9"), "{name} {number}: {ended:?}");
                    killed += 1;
                }
                Verdict::Fail => panic!("{name} {number}: {ended:?}"),
            }
        }
        drop(over);
        assert!(beside.join().unwrap() > 0);
    });
    drop(store);
    println!("{} calls: the lane was killed in time at {killed}, and had told all at {done}", points.len());
    let doubled = "SELECT unit_id FROM run WHERE lane = '1' GROUP BY unit_id HAVING count(*) <> 1";
    assert_eq!(station.query(doubled), Vec::<String>::new());
    assert_eq!(station.query("SELECT count(*) FROM run WHERE state = 'open'"), ["0"]);
    assert_eq!(station.query("SELECT count(*) FROM run WHERE verdict = 'ERROR'"), [killed.to_string()]);
    assert_eq!(station.check().code, Some(0), "{:?}", station.check());
    killed
}

#[test]
fn a_lane_that_is_killed_anywhere_is_an_error_and_the_lane_beside_goes_on() {
    let killed = sweep(|all| {
        let one_in = all.len() / 24;
        all.into_iter().enumerate().filter(|(number, _)| number % one_in == 0).map(|(_, call)| call).collect()
    });
    assert!(killed >= 12, "{killed}");
}

/// At every one of them.
#[test]
#[ignore = "for scripts/soak"]
fn a_lane_that_is_killed_at_any_call_is_an_error_and_the_lane_beside_goes_on() {
    let killed = sweep(|all| all);
    assert!(killed > 100, "{killed}");
}
