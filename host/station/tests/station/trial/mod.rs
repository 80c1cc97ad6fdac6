//! A trial of a whole plant: stations, some of them real programs, judge thousands of boards while they are killed, while they
//! are stopped for longer than their leases last, while their connections are cut around COMMITs, and while the plant's server is
//! killed. In the end every job is judged once, and the plant has every record as its station has it.
//!
//! ```text
//!  clients (threads: the library, a store of their own each) ─┐                           ┌─ killed, started again
//!  stations (processes: `work`, killed and stopped) ──────────┼─ way, cut at COMMITs ─► server
//!  stations in a network of their own, which is unplugged ────┴─ TLS ────────────────────┘
//! ```

mod client;
mod found;
mod network;
mod process;
mod shelf;

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Mutex, MutexGuard};
use std::thread;
use std::time::{Duration, Instant};

use halfrow_station::store::{Plant, PlantAddress, PlantLink};
use tempfile::TempDir;

use crate::common::{Over, engel, query, reason};
use crate::history::generated::Draw;
use crate::jobs::{add, board, run_out};
use crate::plant::server::Server;
use crate::plant::way::{Cut, way};
use found::Found;
use network::Network;
use shelf::Shelf;

/// In bytes: a transaction with a run's record sends more than this, and any other one less.
const RUN: usize = 2_000;
/// How often the progress of the trial is checked.
const LOOK: Duration = Duration::from_millis(200);
/// How long a trial that does not wait for leases may make no progress until all of them are ended.
const HURRY: Duration = Duration::from_secs(2);
/// How long a trial may make no progress at all.
const STUCK: Duration = Duration::from_secs(300);

/// How large a trial is, and what happens in it.
#[derive(Clone, Debug)]
struct Shape {
    boards: u32,
    clients: u32,
    processes: u32,
    /// Stations in networks of their own, which need root.
    networks: u32,
    /// How often the server is killed.
    restarts: u32,
    /// For how long a station is stopped; none if leases are ended instead, as by the plant's clock.
    stall: Option<Duration>,
    /// Whether a run names its claim, and a board knows who has it. Without that, the trial is a control, which must fail.
    is_fenced: bool,
}

/// What has happened so far.
#[derive(Debug, Default)]
struct Happened {
    kills: AtomicU32,
    /// Cuts around COMMITs of runs.
    cuts: AtomicU32,
    /// Cuts around other COMMITs: of claims and of leases.
    other_cuts: AtomicU32,
    stalls: AtomicU32,
    unplugged: AtomicU32,
}

/// A trial under way.
struct Trial {
    shape: Shape,
    server: Mutex<Server>,
    /// The port of the relay to the server, which cuts connections now and then.
    port: u16,
    shelf: Shelf,
    happened: &'static Happened,
    is_over: AtomicBool,
    /// The jobs of a control, and the runs that were believed to be theirs.
    believed: Mutex<Vec<[String; 2]>>,
}

impl Trial {
    fn begin(shape: Shape) -> Self {
        let mut server = Server::prepared();
        let mut plant = Plant::connect(&server.address()).unwrap();
        let stations = shape.clients + shape.processes + shape.networks;
        for number in 0..stations + stations / 10 + 1 {
            plant.share(&board(number as usize, "mock"), "engel").unwrap();
        }
        add(&mut plant, shape.boards);
        drop(plant);
        if shape.networks > 0 {
            network::opened(&mut server);
        }
        let happened: &'static Happened = Box::leak(Box::default());
        let draw = Mutex::new(Draw(5));
        let cut = move |bytes| {
            let drawn = lock(&draw).below(1000);
            let (most, counted) =
                if bytes >= RUN { (120, &happened.cuts) } else { (20, &happened.other_cuts) };
            (drawn < most).then(|| {
                counted.fetch_add(1, Ordering::Relaxed);
                if drawn.is_multiple_of(2) { Cut::Before } else { Cut::After }
            })
        };
        let port = way(server.port(), cut);
        let (server, shelf, is_over) =
            (Mutex::new(server), Shelf::new(shape.is_fenced), AtomicBool::new(false));
        Self { shape, server, port, shelf, happened, is_over, believed: Mutex::default() }
    }

    /// The plant's address through the relay.
    fn address(&self) -> PlantAddress {
        PlantAddress::new(&self.url(), None, None).unwrap()
    }

    fn url(&self) -> String {
        format!("postgres://postgres@127.0.0.1:{}/plant", self.port)
    }

    fn is_over(&self) -> bool {
        self.is_over.load(Ordering::Relaxed)
    }

    /// Runs the trial until all jobs are done. Returns the folders of all stations, when nothing is left to be sent.
    fn run(&self) -> Vec<TempDir> {
        thread::scope(|scope| {
            // Dropped however this ends: stations that went on would keep a failed trial from ending.
            let over = Over(&self.is_over);
            let Shape { clients, processes, networks, .. } = self.shape;
            let clients = (0..clients).map(|number| scope.spawn(move || client::work(self, number)));
            let clients: Vec<_> = clients.collect();
            let programs = (0..processes + networks).map(|number| {
                let network = number.checked_sub(processes).map(Network::new);
                scope.spawn(move || process::work(self, number, network))
            });
            let programs: Vec<_> = programs.collect();
            self.watch();
            drop(over);
            clients.into_iter().chain(programs).map(|station| station.join().unwrap()).collect()
        })
    }

    /// Kills the server now and then, and revives jobs that failed, until all are done.
    fn watch(&self) {
        let mut restarts = 0;
        let (mut last, mut moved, begun) = (0, Instant::now(), Instant::now());
        loop {
            thread::sleep(LOOK);
            let done = self.done();
            if done == self.shape.boards {
                return;
            }
            if done != last {
                (last, moved) = (done, Instant::now());
            }
            if self.shape.stall.is_none() && moved.elapsed() > HURRY {
                run_out(&lock(&self.server));
            }
            assert!(
                moved.elapsed() < STUCK,
                "{done} jobs are done, and no other for long: {:?}",
                self.happened
            );
            if begun.elapsed().as_secs() % 60 == 0 {
                say(&format!("{done} of {} jobs are done, {:?}", self.shape.boards, self.happened));
                thread::sleep(Duration::from_secs(1));
            }
            if restarts < self.shape.restarts
                && done >= (restarts + 1) * self.shape.boards / (self.shape.restarts + 1)
            {
                let mut server = lock(&self.server);
                server.kill();
                thread::sleep(Duration::from_secs(1));
                server.again();
                restarts += 1;
            }
        }
    }

    /// How many jobs are done. Jobs that were claimed five times in vain are tried again, as an engineer would do.
    fn done(&self) -> u32 {
        let server = lock(&self.server);
        for dead in server.rows("SELECT id FROM job WHERE state = 'dead'") {
            let plant = PlantLink::new(server.address());
            plant
                .ask(|plant| plant.retry_job(&dead[0], engel(&reason("five stations in a row were killed"))))
                .unwrap();
        }
        server.rows("SELECT count(*) FROM job WHERE state = 'done'")[0][0].parse().unwrap()
    }

    /// Marks the job as done by this run, whoever has its claim.
    fn believed(&self, job: &str, run: &str) {
        lock(&self.believed).push([job, run].map(str::to_owned));
        let text =
            format!("UPDATE job SET state = 'done', run_id = '{run}', holder = NULL WHERE id = '{job}'");
        lock(&self.server).change(&text);
    }

    /// Ends the lease of this job and this board, as if the plant's clock had been set forward.
    fn run_out(&self, job: &str, board: &str) {
        let text = format!(
            "UPDATE job SET until_ms = 0 WHERE id = '{job}' AND state = 'claimed';
             UPDATE board SET until_ms = 0 WHERE name = '{board}' AND holder IS NOT NULL"
        );
        lock(&self.server).change(&text);
    }
}

fn lock<T>(of: &Mutex<T>) -> MutexGuard<'_, T> {
    of.lock().unwrap()
}

/// Informs whoever watches a long trial.
#[expect(clippy::print_stderr, reason = "a long trial is watched")]
fn say(text: &str) {
    eprintln!("{text}");
}

/// Runs a trial of this shape; returns it with the folders of its stations, and what was found.
fn tried(shape: Shape) -> (Trial, Vec<TempDir>, Found) {
    let trial = Trial::begin(shape);
    let begun = Instant::now();
    let folders = trial.run();
    let found = Found::of(&trial, &folders);
    let seconds = begun.elapsed().as_secs_f64();
    say(&format!(
        "{} jobs, {} stations, {seconds:.0} s: {found:?}, {:?}",
        trial.shape.boards,
        folders.len(),
        trial.happened
    ));
    (trial, folders, found)
}

/// Some stations and more than a hundred boards; nobody waits for a lease to run out.
const SHORT: Shape =
    Shape { boards: 150, clients: 8, processes: 2, networks: 0, restarts: 1, stall: None, is_fenced: true };

#[test]
fn whatever_happens_to_stations_every_job_is_judged_once() {
    let (trial, folders, found) = tried(SHORT);
    assert_eq!(found.wrong(), Vec::<String>::new());
    let happened = trial.happened;
    for count in [&happened.kills, &happened.cuts, &happened.stalls] {
        assert!(count.load(Ordering::Relaxed) > 0, "{happened:?}");
    }
    let has_passed = |folder: &TempDir| {
        !query(&process::data(folder), "SELECT id FROM run WHERE verdict = 'PASS'").is_empty()
    };
    assert!(folders[SHORT.clients as usize..].iter().any(has_passed), "no program judged a job");
    // The control: what the other control leaves in order is found as well.
    let of_station = rusqlite::Connection::open(process::data(&folders[0]).join("station.db")).unwrap();
    let other_hash = "UPDATE run SET record_sha256 = hex(zeroblob(32))
        WHERE id = (SELECT min(id) FROM run WHERE state = 'final')";
    assert_eq!(of_station.execute(other_hash, []).unwrap(), 1);
    let mut plant = lock(&trial.server).client("plant");
    let counted = "UPDATE day_count SET runs = runs + 1 WHERE ctid IN (SELECT ctid FROM day_count LIMIT 1)";
    let undone = "UPDATE job SET run_id = 'none' WHERE id = (SELECT min(id) FROM job)";
    for change in [counted, undone] {
        assert_eq!(plant.execute(change, &[]).unwrap(), 1);
    }
    let Found { unlike, miscounted, undone, .. } = Found::of(&trial, &folders);
    assert_eq!((unlike, miscounted, undone), (2, 1, 1));
}

/// The control: what would happen if stations that come too late were believed.
#[test]
fn without_fences_boards_are_judged_twice_at_once_and_jobs_twice() {
    let (.., found) = tried(Shape { boards: 60, processes: 0, restarts: 0, is_fenced: false, ..SHORT });
    assert!(found.doubles > 0 && found.at_once > 0, "{found:?}");
    assert_eq!((found.undone, found.unlike), (0, 0), "{found:?}");
}

#[test]
#[ignore = "for scripts/soak: half an hour, and root"]
fn a_hundred_stations_judge_ten_thousand_boards_once_each_whatever_happens() {
    let boards = std::env::var("HALFROW_TRIAL_BOARDS").map_or(10_000, |count| count.parse().unwrap());
    let stall = Some(Duration::from_secs(33));
    let (clients, processes, networks, restarts) = (80, 16, 4, 5);
    let (trial, _, found) = tried(Shape { boards, clients, processes, networks, restarts, stall, ..SHORT });
    assert_eq!(found.wrong(), Vec::<String>::new());
    let happened = trial.happened;
    let least = [(&happened.kills, 10), (&happened.cuts, 10), (&happened.stalls, 5)];
    for (count, percent) in least {
        assert!(count.load(Ordering::Relaxed) * 100 >= boards * percent, "{happened:?}");
    }
    assert!(happened.unplugged.load(Ordering::Relaxed) >= networks, "{happened:?}");
}
