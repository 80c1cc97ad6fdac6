//! A station in a process of its own: `halfrow-station work`, and what happens to it.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::Ordering;
use std::thread;
use std::time::{Duration, Instant};

use nix::sys::signal::Signal;
use tempfile::TempDir;

use super::Trial;
use super::network::Network;
use crate::common::{self, program, signal};
use crate::history::generated::Draw;

/// How long each step of ending a station may take, over a cable that was just plugged in.
const ENDED: Duration = Duration::from_secs(120);
/// How often it is checked whether the trial is over.
const LOOK: Duration = Duration::from_millis(100);

/// Where a station in `folder` stores its data: a client does so in the folder itself.
pub(super) fn data(folder: &TempDir) -> PathBuf {
    let data = folder.path().join("data");
    if data.is_dir() { data } else { folder.path().to_owned() }
}

/// A station that takes jobs until the trial is over. Returns its folder.
pub(super) fn work(trial: &Trial, number: u32, network: Option<Network>) -> TempDir {
    let folder = common::folder();
    let plant = match &network {
        Some(network) => network.settings(trial, folder.path()),
        None => common::plant_settings(&trial.url()),
    };
    // Every second station judges two boards at a time.
    settings(folder.path(), &format!("station {number}"), &plant, 1 + number % 2);
    let mut station = Station { trial, folder, network, draw: Draw(1_000 + u64::from(number)) };
    let mut child = station.start();
    while !trial.is_over() {
        station.wait();
        match station.draw.below(5) {
            0 | 1 => {
                child.kill().unwrap();
                child.wait().unwrap();
                trial.happened.kills.fetch_add(1, Ordering::Relaxed);
                child = station.start();
            }
            2 => station.stand_still(&child),
            _ => station.unplug(),
        }
    }
    station.end(child);
    station.folder
}

fn settings(folder: &Path, name: &str, plant: &str, at_once: u32) {
    let more = format!("{plant}[work]\nplans = [\"plan.toml\"]\nat_once = {at_once}\n");
    common::settings(folder, name, "data", &more);
}

struct Station<'a> {
    trial: &'a Trial,
    folder: TempDir,
    network: Option<Network>,
    draw: Draw,
}

impl Station<'_> {
    /// The program with these arguments, in the station's network if it has one.
    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = match &self.network {
            Some(network) => network.command(program()),
            None => Command::new(program()),
        };
        let said =
            File::options().create(true).append(true).open(self.folder.path().join("said.txt")).unwrap();
        command.args(arguments).arg("--settings").arg(self.folder.path().join("station.toml"));
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(said);
        command
    }

    fn start(&self) -> Child {
        self.command(&["work"]).spawn().unwrap()
    }

    /// Waits two to five seconds, or until the trial is over.
    fn wait(&mut self) {
        let until = Instant::now() + Duration::from_millis(2_000 + self.draw.below(3_000));
        while Instant::now() < until && !self.trial.is_over() {
            thread::sleep(LOOK);
        }
    }

    /// Stops the station for longer than its leases last.
    fn stand_still(&self, child: &Child) {
        let Some(stall) = self.trial.shape.stall else { return };
        self.trial.happened.stalls.fetch_add(1, Ordering::Relaxed);
        signal(child.id(), Signal::SIGSTOP);
        thread::sleep(stall);
        signal(child.id(), Signal::SIGCONT);
    }

    /// Unplugs its network for a while, sometimes for longer than its leases last.
    fn unplug(&mut self) {
        let Some(network) = &self.network else { return };
        self.trial.happened.unplugged.fetch_add(1, Ordering::Relaxed);
        network.plug(false);
        thread::sleep(Duration::from_secs(1 + self.draw.below(45)));
        network.plug(true);
    }

    /// Ends it, and sends what it still has.
    fn end(&self, mut child: Child) {
        signal(child.id(), Signal::SIGTERM);
        self.until(|| child.try_wait().unwrap().is_some());
        // What was killed in a run is closed by the next start.
        self.until(|| self.command(&["work", "--once"]).status().unwrap().success());
        self.until(|| {
            let sends = || self.command(&["outbox", "send"]).status().unwrap();
            self.is_sent() || (sends().success() && self.is_sent())
        });
    }

    fn until(&self, mut is_so: impl FnMut() -> bool) {
        let until = Instant::now() + ENDED;
        while !is_so() {
            assert!(Instant::now() < until, "{}", self.said());
            thread::sleep(LOOK);
        }
    }

    fn is_sent(&self) -> bool {
        common::query(&data(&self.folder), "SELECT count(*) FROM outbox WHERE done_ms IS NULL") == ["0"]
    }

    fn said(&self) -> String {
        fs::read_to_string(self.folder.path().join("said.txt")).unwrap()
    }
}
