//! A plant's figures, over all stations.

use std::collections::BTreeMap;

use super::text::{Label, Metric, Text, counter, gauge, info};
use super::{counted, turns};
use crate::history::counts::{Cell, Count};
use crate::history::mismatch::mismatches;
use crate::history::stations::{Station, stations};
use crate::store::{
    JobState, JobsInState, SharedBoard, Snapshot, StoreError, boards, counted_jobs, open_jobs,
};
use crate::web::state::App;
use crate::web::visit::Visit;

const PLANT: Metric = info("halfrow_plant", "The plant's name.");
const UP: Metric = gauge(
    "halfrow_plant_up",
    "1 if the plant's database is reachable and has this program's version, 0 if all other figures are missing here.",
);
const VERSION: Metric = gauge("halfrow_plant_schema_version", "The version of the plant's tables.");
const RUNS: Metric = counter("halfrow_plant_runs", "Finished runs at the plant.");
const UNITS: Metric =
    gauge("halfrow_plant_units_judged", "Units at the plant that were first judged at the station.");
const FIRST: Metric =
    gauge("halfrow_plant_units_first_passed", "Judged units whose first judgement is PASS.");
const SEEN: Metric = gauge(
    "halfrow_plant_station_seen_timestamp_seconds",
    "When the station was last heard from, by the plant's clock; it reports every half minute.",
);
const UNSENT: Metric = gauge(
    "halfrow_plant_station_unsent_entries",
    "Entries that the plant does not have from the station yet, as the station last reported.",
);
const DEAD: Metric =
    gauge("halfrow_plant_station_dead_letters", "Entries among these that wait for a person.");

const MISMATCHES: Metric = gauge(
    "halfrow_plant_device_mismatches",
    "Devices and units that are bound to each other at a station but not at the plant.",
);

const JOBS: Metric =
    gauge("halfrow_plant_jobs", "Jobs that are not done, without those that a person cancelled.");
const OLDEST: Metric = gauge(
    "halfrow_plant_jobs_oldest_waiting_seconds",
    "Age of the oldest job that no station has; 0 if there is none.",
);
const BOARDS: Metric = gauge("halfrow_plant_boards", "Boards that several stations share.");

/// What the plant holds.
#[derive(Default)]
struct PlantFigures {
    version: Option<u64>,
    counts: BTreeMap<Cell, Count>,
    stations: Vec<Station>,
    mismatches: Option<usize>,
    shared: Option<Shared>,
}

/// Jobs and boards.
struct Shared {
    open: Vec<JobsInState>,
    dead: u32,
    boards: Vec<SharedBoard>,
}

/// How many jobs wait for a person.
fn dead_jobs(now: &Snapshot) -> Result<u32, StoreError> {
    let dead = counted_jobs(now)?.into_iter().find(|&(state, _)| state == JobState::Dead);
    Ok(dead.map_or(0, |(_, jobs)| jobs))
}

/// Writes all figures. They say so if the plant is away.
pub(super) async fn write(text: &mut Text, app: &App, visit: &Visit) {
    let held = turns::counted(app, visit, |now, turns| {
        let version = Some(now.version()?.unsigned_abs());
        let mismatches = Some(mismatches(now)?.len());
        let (counts, stations) = (turns.tally.counts(now)?, stations(now)?);
        let dead = turns.dead_jobs.get(|| dead_jobs(now))?;
        let shared = Some(Shared { open: open_jobs(now)?, dead, boards: boards(now)? });
        Ok(PlantFigures { version, counts, stations, mismatches, shared })
    });
    let held = held.await;
    text.of(&PLANT).put(&[("plant", app.station())], 1);
    text.of(&UP).put(&[], u64::from(held.is_some()));
    let PlantFigures { version, counts, stations, mismatches, shared } = held.unwrap_or_default();
    let mut of = text.of(&VERSION);
    if let Some(version) = version {
        of.put(&[], version);
    }
    counted(text, [&RUNS, &UNITS, &FIRST], &counts, labels);
    heard(text, &stations);
    let mut of = text.of(&MISMATCHES);
    if let Some(mismatches) = mismatches {
        of.put(&[], mismatches);
    }
    lent(text, shared.as_ref());
}

fn labels(Cell { plan, station, .. }: &Cell) -> [Label<'_>; 3] {
    [("station", station), ("product", &plan.product), ("plan", &plan.plan)]
}

fn heard(text: &mut Text, stations: &[Station]) {
    let mut of = text.of(&SEEN);
    for station in stations {
        of.put(&[("station", &station.name)], station.seen_ms as f64 / 1000.0);
    }
    let mut of = text.of(&UNSENT);
    for station in stations {
        of.put(&[("station", &station.name)], station.unsent);
    }
    let mut of = text.of(&DEAD);
    for station in stations {
        of.put(&[("station", &station.name)], station.dead);
    }
}

/// Jobs and boards by state, also for states without any: an alert must see that there are none.
fn lent(text: &mut Text, shared: Option<&Shared>) {
    let of_state = |state| move |jobs: &&JobsInState| jobs.state == state;
    let mut of = text.of(&JOBS);
    if let Some(Shared { open, dead, .. }) = shared {
        let jobs = |state| open.iter().find(of_state(state)).map_or(0, |found| found.jobs);
        let [waiting, claimed] = [JobState::Waiting, JobState::Claimed].map(|state| (state, jobs(state)));
        for (state, jobs) in [waiting, claimed, (JobState::Dead, *dead)] {
            of.put(&[("state", &state.to_string())], jobs);
        }
    }
    let mut of = text.of(&OLDEST);
    if let Some(Shared { open, .. }) = shared {
        let oldest_ms = open.iter().find(of_state(JobState::Waiting)).map_or(0, |found| found.oldest_ms);
        of.put(&[], oldest_ms.max(0) as f64 / 1000.0);
    }
    let mut of = text.of(&BOARDS);
    if let Some(Shared { boards, .. }) = shared {
        for state in ["free", "held", "out"] {
            of.put(&[("state", state)], boards.iter().filter(|board| state_of(board) == state).count());
        }
    }
}

fn state_of(board: &SharedBoard) -> &'static str {
    match (&board.out, &board.holder) {
        (Some(_), _) => "out",
        (None, Some(_)) => "held",
        (None, None) => "free",
    }
}
