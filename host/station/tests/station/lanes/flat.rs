//! A long shift: a station's resources do not grow with its runs.

use std::collections::BTreeMap;
use std::fs;
use std::net::TcpListener;
use std::time::{Duration, Instant};

use nix::sys::signal::Signal;
use serde_json::Value;

use super::ends::{connected, lane_of};
use super::floor::{Running, Station};
use crate::common::{self, PLAN, silent_board};

/// The resources of a process.
#[derive(Clone, Copy, Debug)]
struct ProcessResources {
    files: usize,
    threads: u64,
    resident_kib: u64,
}

fn held(process: u32) -> ProcessResources {
    let status = fs::read_to_string(format!("/proc/{process}/status")).unwrap();
    let number = |name: &str| {
        let line = status.lines().find_map(|line| line.strip_prefix(name)).unwrap();
        line.trim_start_matches(':').split_whitespace().next().unwrap().parse().unwrap()
    };
    let files = fs::read_dir(format!("/proc/{process}/fd")).unwrap().count();
    ProcessResources { files, threads: number("Threads"), resident_kib: number("VmRSS") }
}

/// The median by `key`.
fn middle(of: &[ProcessResources], key: impl Fn(&ProcessResources) -> u64) -> u64 {
    let mut all: Vec<_> = of.iter().map(key).collect();
    all.sort_unstable();
    all[all.len() / 2]
}

/// Judges boards in three lanes until `runs` were judged; returns how long each took.
fn judged(running: &mut Running, serials: &mut u32, runs: u32) -> Vec<Duration> {
    let (mut given, mut took) = (0, Vec::new());
    let mut begun = BTreeMap::new();
    let mut give = |running: &mut Running, lane: &str, begun: &mut BTreeMap<String, Instant>| {
        if given < runs {
            given += 1;
            *serials += 1;
            begun.insert(format!("CAT{serials:05}"), Instant::now());
            running.test(lane, &format!("CAT{serials:05}"));
        }
    };
    ["1", "2", "3"].into_iter().for_each(|lane| give(running, lane, &mut begun));
    while took.len() < runs as usize {
        let news = running.wait("a verdict", |news| news["news"] == "lane" && !news["shown"].is_null());
        let serial = news["shown"]["serial"].as_str().unwrap();
        let Some(since) = begun.remove(serial) else { continue };
        assert_eq!(news["shown"]["verdict"], "PASS", "{news}");
        took.push(since.elapsed());
        let lane = news["lane"].as_str().unwrap().to_owned();
        give(running, &lane, &mut begun);
        // The rest is not needed, and there would be much of it.
        running.heard.retain(|news| news["lane"] == "4" && !news["shown"].is_null());
    }
    took
}

/// Ends the run in lane 4, whose board is silent, by `signal`; returns how long that took.
fn ended_by(
    signal: Signal,
    station: &Station,
    running: &mut Running,
    listener: &TcpListener,
    serials: &mut u32,
    meanwhile: impl FnOnce(&mut Running, &mut u32),
) -> Duration {
    *serials += 1;
    let serial = format!("CAT{serials:05}");
    running.heard.clear();
    running.test("4", &serial);
    connected(listener);
    let run = running.wait("a step", |news| news["news"] == "doing" && news["lane"] == "4")["run"].clone();
    common::signal(lane_of(station, &run), signal);
    let begun = Instant::now();
    let is_ended = |news: &Value| news["lane"] == "4" && news["shown"]["serial"] == serial.as_str();
    if signal == Signal::SIGKILL {
        running.wait("its end", is_ended);
        return begun.elapsed();
    }
    meanwhile(running, serials);
    let heard = running.heard.iter().any(is_ended);
    if !heard {
        running.wait("its end", is_ended);
    }
    begun.elapsed()
}

/// The figures of a shift.
#[derive(Default)]
struct Shift {
    /// The station's resources, after each round.
    samples: Vec<ProcessResources>,
    /// How long runs took without a hung lane.
    alone: Vec<Duration>,
    /// How long they took next to a hung lane.
    beside: Vec<Duration>,
    /// The longest time until a hung lane was recorded.
    longest: Duration,
}

/// A thousand runs, of which 20 are killed and 10 hang; returns their exact number.
fn worked(shift: &mut Shift, station: &Station, running: &mut Running, listener: &TcpListener) -> u32 {
    let mut serials = 0;
    for round in 0..20 {
        shift.alone.extend(judged(running, &mut serials, 48));
        ended_by(Signal::SIGKILL, station, running, listener, &mut serials, |_, _| {});
        if round % 2 == 1 {
            let beside = &mut shift.beside;
            let took =
                ended_by(Signal::SIGSTOP, station, running, listener, &mut serials, |running, serials| {
                    beside.extend(judged(running, serials, 6));
                });
            shift.longest = shift.longest.max(took);
        }
        shift.samples.push(held(running.id()));
    }
    serials
}

/// The median, in seconds.
fn median(all: &mut [Duration]) -> f64 {
    all.sort_unstable();
    all[all.len() / 2].as_secs_f64()
}

#[test]
#[ignore = "for scripts/soak"]
fn a_thousand_runs_with_kills_and_hung_lanes_leave_nothing_behind() {
    let (listener, target) = silent_board();
    let station = Station::with(&["mock", "mock", "mock", &target], "");
    fs::write(station.path("plan.toml"), PLAN).unwrap();
    let mut running = station.start();
    let mut shift = Shift::default();
    let runs = worked(&mut shift, &station, &mut running, &listener);
    let (alone, beside) = (median(&mut shift.alone), median(&mut shift.beside));
    let longest = shift.longest.as_secs_f64();
    println!(
        "{runs} runs; one takes {alone:.3} s, and {beside:.3} s beside a hung lane, which is recorded in {longest:.1} s"
    );
    let samples = &shift.samples;
    println!("first {:?}\nlast  {:?}", samples[0], samples[19]);
    let (first, last) = (&samples[2..9], &samples[13..]);
    let files = |held: &ProcessResources| held.files as u64;
    assert_eq!(middle(first, files), middle(last, files), "{samples:?}");
    // The thread of a run may be just about to end.
    let threads = |held: &ProcessResources| held.threads;
    assert!(middle(last, threads) <= middle(first, threads) + 1, "{samples:?}");
    let (early, late) = (middle(first, |held| held.resident_kib), middle(last, |held| held.resident_kib));
    assert!(late <= early + early / 10, "{early} KiB became {late} KiB: {samples:?}");
    assert_eq!(running.end().0, Some(0));
    let crashes = "SELECT count(*) FROM run WHERE verdict = 'ERROR' AND cause = 'crash' AND lane = '4'";
    assert_eq!(station.query(crashes), ["30"]);
    let passes = "SELECT count(*) FROM run WHERE verdict = 'PASS'";
    assert_eq!(station.query(passes), [(runs - 30).to_string()]);
    station.assert_well();
}
