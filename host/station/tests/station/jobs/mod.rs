//! Jobs of a plant, and boards that several computers share, on a real PostgreSQL server.

mod again;
mod boards;
mod changed;
pub(crate) mod claims;
mod clock_set;
mod commands;
pub(crate) mod disk;
mod from_outside;
mod rate;
mod sent;
mod shift;
mod stuck;
mod unwell;
mod work;

use std::path::{Path, PathBuf};
use std::time::Instant;

use halfrow::verdict::StoppedBy;
use halfrow_station::plan::Plan;
use halfrow_station::settings::Settings;
use halfrow_station::store::{
    Folder, NewJob, Plant, PlantLink, SharedBoard, SharedStore, Store, Wanted, Worker,
};
use halfrow_station::work::{JobResult, SetAside, Work};

use crate::common::PLAN;
use crate::lanes::floor::HANG;
use crate::plant::server::Server;

/// The plan of every job.
pub(crate) fn plan() -> Plan {
    Plan::parse("plan.toml".as_ref(), PLAN.to_owned()).unwrap()
}

/// A board of this kind with this number, which every station reaches.
pub(crate) fn board(number: usize, kind: &str) -> SharedBoard {
    SharedBoard {
        name: format!("shelf-{number}"),
        kind: kind.to_owned(),
        target: "mock".to_owned(),
        product: "CAM-T".to_owned(),
        serial: format!("CAT{number:05}"),
        station: String::new(),
        out: None,
        fence: 0,
        holder: None,
        until_ms: None,
    }
}

/// A plant with `count` boards of the kind `mock`.
pub(crate) fn shared(count: usize) -> (Server, Plant) {
    let server = Server::prepared();
    let mut plant = Plant::connect(&server.address()).unwrap();
    for number in 0..count {
        assert!(plant.share(&board(number, "mock"), "engel").unwrap());
    }
    (server, plant)
}

/// A plant with one board and one job for it; the last member is the job's id.
fn with_a_job() -> (Server, Plant, String) {
    let (server, mut plant) = shared(1);
    let id = add(&mut plant, 1).remove(0);
    (server, plant, id)
}

/// Adds so many jobs for any board; returns their ids.
pub(crate) fn add(plant: &mut Plant, count: u32) -> Vec<String> {
    plant.add_jobs(&job(&plan(), &any()), count).unwrap()
}

pub(crate) fn any() -> Wanted {
    Wanted::Kind("mock".to_owned())
}

pub(crate) fn job<'a>(plan: &'a Plan, wanted: &'a Wanted) -> NewJob<'a> {
    NewJob { plan, wanted, needs: &[], priority: 0, operator: "engel" }
}

/// A worker of this station, which only has the plan.
pub(crate) fn worker(station: &str) -> Worker {
    let [holder, station] = [format!("{station} 1"), station.to_owned()];
    Worker {
        holder,
        station,
        plans: vec![plan().sha256],
        once: Vec::new(),
        references: Vec::new(),
        has: Vec::new(),
        unfit: Vec::new(),
    }
}

/// The state of each job, and how often it was claimed, in the order in which they were added.
fn states(server: &Server) -> Vec<Vec<String>> {
    server.rows("SELECT state, attempts FROM job ORDER BY id")
}

/// Lets all leases run out, as if their holders had been silent for long.
pub(crate) fn run_out(server: &Server) {
    server.change("UPDATE job SET until_ms = 0; UPDATE board SET until_ms = 0");
}

/// The settings of a worker of this name in `folder`.
fn settings(server: &Server, folder: &Path, name: &str) -> PathBuf {
    settings_of(&server.url(), folder, name)
}

/// The same with the plant at `url`.
pub(crate) fn settings_of(url: &str, folder: &Path, name: &str) -> PathBuf {
    let more = format!("{}[work]\nplans = [\"plan.toml\"]\n", crate::common::plant_settings(url));
    crate::common::settings(folder, name, "data", &more)
}

/// The station of these settings, whose lanes run `program`. Nothing that it stores is sent on.
fn at_work(settings: &Settings, program: PathBuf) -> Work<'_> {
    let plans = settings.plans.iter().map(|file| file.plan.sha256.clone()).collect();
    Work {
        plant: PlantLink::new(settings.plant.as_ref().unwrap().address().unwrap()),
        store: SharedStore::new(Store::open(&Folder::new(&settings.data)).unwrap()),
        program,
        worker: Worker { plans, ..worker(&settings.name) },
        settings,
        aside: SetAside::default(),
    }
}

/// The next job, judged; it is stopped if it takes too long.
fn judged(work: &Work<'_>) -> JobResult {
    let claim = work.claim().unwrap().unwrap();
    let begun = Instant::now();
    let stop = || (begun.elapsed() > HANG).then_some(StoppedBy::Person);
    work.judge(claim, &stop, &stop, &mut |_| ()).unwrap()
}
