//! A long shift: what the station holds does not grow with its runs.

use std::collections::BTreeMap;
use std::fs;
use std::time::{Duration, Instant};

use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use serde_json::Value;

use super::ends::{connected, lane_of, silent_board};
use super::floor::{Running, Station};
use crate::common::PLAN;

/// What a process holds.
#[derive(Clone, Copy, Debug)]
struct Held {
    files: usize,
    threads: u64,
    resident_kib: u64,
}

fn held(process: u32) -> Held {
    let status = fs::read_to_string(format!("/proc/{process}/status")).unwrap();
    let number = |name: &str| {
        let line = status.lines().find_map(|line| line.strip_prefix(name)).unwrap();
        line.trim_start_matches(':').split_whitespace().next().unwrap().parse().unwrap()
    };
    let files = fs::read_dir(format!("/proc/{process}/fd")).unwrap().count();
    Held { files, threads: number("Threads"), resident_kib: number("VmRSS") }
}

/// One of three, in the middle by `key`.
fn middle(of: &[Held], key: impl Fn(&Held) -> u64) -> u64 {
    let mut all: Vec<_> = of.iter().map(key).collect();
    all.sort_unstable();
    all[all.len() / 2]
}

/// Boards in three lanes, one after the other, until so many were judged; how long each took.
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
        // The rest is of no use, and would be many.
        running.heard.retain(|news| news["lane"] == "4" && !news["shown"].is_null());
    }
    took
}

/// The run in lane 4, whose board says nothing, comes to its end by `signal`; returns how long that took.
fn ended_by(
    signal: Signal,
    station: &Station,
    running: &mut Running,
    listener: &std::net::TcpListener,
    serials: &mut u32,
    meanwhile: impl FnOnce(&mut Running, &mut u32),
) -> Duration {
    *serials += 1;
    let serial = format!("CAT{serials:05}");
    running.heard.clear();
    running.test("4", &serial);
    connected(listener);
    let run = running.wait("a step", |news| news["news"] == "doing" && news["lane"] == "4")["run"].clone();
    kill(Pid::from_raw(lane_of(station, &run)), signal).unwrap();
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

#[test]
#[ignore = "for scripts/soak"]
fn a_thousand_runs_with_kills_and_hung_lanes_leave_nothing_behind() {
    let (listener, target) = silent_board();
    let station = Station::with(&["mock", "mock", "mock", &target], "");
    fs::write(station.path("plan.toml"), PLAN).unwrap();
    let mut running = station.start();
    let (mut serials, mut samples) = (0, Vec::new());
    let (mut alone, mut beside, mut longest) = (Vec::new(), Vec::new(), Duration::ZERO);
    for round in 0..20 {
        alone.extend(judged(&mut running, &mut serials, 48));
        ended_by(Signal::SIGKILL, &station, &mut running, &listener, &mut serials, |_, _| {});
        if round % 2 == 1 {
            let took = ended_by(
                Signal::SIGSTOP,
                &station,
                &mut running,
                &listener,
                &mut serials,
                |running, serials| {
                    beside.extend(judged(running, serials, 6));
                },
            );
            longest = longest.max(took);
        }
        samples.push(held(running.id()));
    }
    let median = |all: &mut Vec<Duration>| {
        all.sort_unstable();
        all[all.len() / 2].as_secs_f64()
    };
    println!(
        "{serials} runs; a run takes {:.3} s, beside a hung lane {:.3} s (medians); a hung lane was recorded after {:.1} s at the latest",
        median(&mut alone),
        median(&mut beside),
        longest.as_secs_f64(),
    );
    println!("first {:?}\nlast  {:?}", samples[0], samples[19]);
    let (first, last) = (&samples[2..9], &samples[13..]);
    assert_eq!(
        middle(first, |held| held.files as u64),
        middle(last, |held| held.files as u64),
        "{samples:?}"
    );
    assert_eq!(middle(first, |held| held.threads), middle(last, |held| held.threads), "{samples:?}");
    let (early, late) = (middle(first, |held| held.resident_kib), middle(last, |held| held.resident_kib));
    assert!(late <= early + early / 10, "{early} KiB became {late} KiB: {samples:?}");
    assert_eq!(running.end().0, Some(0));
    let crashes = "SELECT count(*) FROM run WHERE verdict = 'ERROR' AND cause = 'crash' AND lane = '4'";
    assert_eq!(station.query(crashes), ["30"]);
    assert_eq!(
        station.query("SELECT count(*) FROM run WHERE verdict = 'PASS'"),
        [(serials - 30).to_string()]
    );
    station.assert_well();
}
