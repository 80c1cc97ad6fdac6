//! A station's figures.

use std::collections::BTreeMap;

use strum::VariantArray as _;

use super::text::{Label, Metric, Text, counter, gauge, histogram, info};
use super::{counted, turns};
use crate::clock;
use crate::disk::Room;
use crate::engine::{Figures, LaneState};
use crate::floor::Word;
use crate::history::counts::{Cell, Count};
use crate::plan::PlanName;
use crate::settings::Settings;
use crate::store::{SINK_OF_PLANT, Unsent};
use crate::web::state::App;
use crate::web::trouble::Trouble;
use crate::web::visit::Visit;

const STATION: Metric = info("halfrow_station", "The station's name.");
const WELL: Metric = gauge(
    "halfrow_engine_well",
    "1 while the engine works, 0 once its thread has not responded for five seconds.",
);
const READABLE: Metric = gauge(
    "halfrow_store_readable",
    "1 if the station's store could be read, 0 if its figures are missing here.",
);
const STATE: Metric = gauge("halfrow_lane_state", "1 for the lane's present state, 0 for all others.");
const UNSAVED: Metric =
    gauge("halfrow_unsaved_results", "Results that could not be saved yet; their lanes accept no board.");
const AWAITS: Metric = gauge(
    "halfrow_lane_awaits_plant",
    "1 while the lane is UNSAVED although its result is saved, because it must reach the plant and has not yet.",
);
const KILLS: Metric = counter(
    "halfrow_lane_kills",
    "Runs since the start whose process had to be killed because it was silent or took too long.",
);
const REFUSALS: Metric = counter(
    "halfrow_refusals",
    "Scans since the start that led to no run, and acts that the audit could not take, because of the station itself.",
);
const RUNS: Metric = counter("halfrow_runs", "Finished runs in the store.");
const UNITS: Metric = gauge("halfrow_units_judged", "Judged units in the store.");
const FIRST: Metric = gauge("halfrow_units_first_passed", "Judged units whose first judgement is PASS.");
const SECONDS: Metric = histogram("halfrow_run_seconds", "How long runs took, since the start.");
const COMMIT: Metric = histogram(
    "halfrow_commit_seconds",
    "Time from the end of a run until its result was saved and read back, since the start.",
);
const ENTRIES: Metric = gauge("halfrow_outbox_entries", "Entries that the sink does not have yet.");
const RESULTS: Metric = gauge("halfrow_outbox_results", "Runs and waivers that the sink does not have yet.");
const LIMIT: Metric = gauge(
    "halfrow_outbox_results_limit",
    "With more results than this that the plant does not have yet, lanes accept no board.",
);
const DEAD: Metric = gauge(
    "halfrow_outbox_dead_letters",
    "Entries that wait for a person, among those that the sink does not have yet.",
);
const OLDEST: Metric = gauge(
    "halfrow_outbox_oldest_seconds",
    "Age of the oldest entry that the sink does not have yet; 0 if there is none.",
);

const FREE: Metric =
    gauge("halfrow_store_free_bytes", "Room that is left on the disk with the station's folder.");
const SIZE: Metric =
    gauge("halfrow_store_size_bytes", "Room on the disk with the station's folder, used or left.");

/// What the store holds, and how much more it can.
type StoreFigures = (BTreeMap<Cell, Count>, Vec<Unsent>, Option<Room>);

/// Writes all figures. If the store cannot be read they say so, and still have what lanes do.
pub(super) async fn write(text: &mut Text, app: &App, visit: &Visit) -> Result<(), Trouble> {
    let engine = &app.lanes(visit)?.engine;
    let data = app.settings().data.clone();
    let kept: Option<StoreFigures> = turns::counted(app, visit, move |now, turns| {
        Ok((turns.tally.counts(now)?, now.unsent()?, Room::of(&data).ok()))
    })
    .await;
    text.of(&STATION).put(&[("station", app.station())], 1);
    text.of(&WELL).put(&[], u64::from(engine.is_well()));
    text.of(&READABLE).put(&[], u64::from(kept.is_some()));
    lanes(text, &engine.lanes());
    since_the_start(text, &engine.figures());
    let (counts, unsent, room) = match kept {
        Some((counts, unsent, room)) => (with_all(app.settings(), counts), Some(unsent), room),
        None => Default::default(),
    };
    counted(text, [&RUNS, &UNITS, &FIRST], &counts, labels);
    outbox(text, app.settings(), unsent.as_deref());
    disk(text, room);
    Ok(())
}

fn lanes(text: &mut Text, lanes: &[LaneState]) {
    let mut of = text.of(&STATE);
    for lane in lanes {
        for word in Word::VARIANTS {
            of.put(&[("lane", &lane.lane), ("state", word.as_ref())], u64::from(lane.state == *word));
        }
    }
    let is_unsaved = |lane: &&LaneState| lane.state == Word::Unsaved && !lane.awaits_plant;
    text.of(&UNSAVED).put(&[], lanes.iter().filter(is_unsaved).count());
    let mut of = text.of(&AWAITS);
    for lane in lanes {
        of.put(&[("lane", &lane.lane)], u64::from(lane.awaits_plant));
    }
}

fn since_the_start(text: &mut Text, figures: &Figures) {
    let mut of = text.of(&KILLS);
    for (lane, kills) in &figures.kills {
        of.put(&[("lane", lane)], *kills);
    }
    let mut of = text.of(&REFUSALS);
    for (reason, refusals) in &figures.refusals {
        of.put(&[("reason", reason)], *refusals);
    }
    let mut of = text.of(&SECONDS);
    for ((PlanName { product, plan }, lane), seconds) in &figures.runs {
        of.spread(&[("product", product), ("plan", plan), ("lane", lane)], seconds);
    }
    text.of(&COMMIT).spread(&[], &figures.commits);
}

/// Adds the plans and lanes of the settings that had no run yet: a counter shows its first run only if it began at 0.
fn with_all(settings: &Settings, kept: BTreeMap<Cell, Count>) -> BTreeMap<Cell, Count> {
    let mut counts = BTreeMap::<Cell, Count>::new();
    for lane in &settings.lanes {
        for file in settings.plans_of(lane) {
            let (plan, station) = (PlanName::from(&file.plan), String::new());
            counts.insert(Cell { plan, station, lane: lane.name.clone() }, Count::default());
        }
    }
    for (cell, count) in kept {
        // A station that had another name before is the same station.
        counts.entry(Cell { station: String::new(), ..cell }).or_default().add(&count);
    }
    counts
}

fn labels(Cell { plan, lane, .. }: &Cell) -> [Label<'_>; 3] {
    [("product", &plan.product), ("plan", &plan.plan), ("lane", lane)]
}

/// What is unsent at every sink, also at those that have everything.
fn outbox(text: &mut Text, settings: &Settings, unsent: Option<&[Unsent]>) {
    let now_ms = clock::now_ms();
    let mut sinks: BTreeMap<&str, Waiting> = BTreeMap::new();
    if let Some(unsent) = unsent {
        sinks.extend(settings.sink_names().map(|sink| (sink, Waiting::default())));
        for Unsent { sink, entries, results, dead, since_ms, .. } in unsent {
            let age = now_ms.saturating_sub(*since_ms).max(0) as f64 / 1000.0;
            sinks.insert(sink, Waiting { entries: *entries, results: *results, dead: *dead, age });
        }
    }
    let mut put = |metric, count: fn(&Waiting) -> u32| {
        let mut of = text.of(metric);
        for (sink, waiting) in &sinks {
            of.put(&[("sink", sink)], count(waiting));
        }
    };
    put(&ENTRIES, |of| of.entries);
    put(&RESULTS, |of| of.results);
    put(&DEAD, |of| of.dead);
    let mut of = text.of(&LIMIT);
    if let Some(plant) = &settings.plant {
        of.put(&[("sink", SINK_OF_PLANT)], plant.most_unsent);
    }
    let mut of = text.of(&OLDEST);
    for (sink, Waiting { age, .. }) in &sinks {
        of.put(&[("sink", sink)], *age);
    }
}

/// What a sink does not have yet.
#[derive(Default)]
struct Waiting {
    entries: u32,
    results: u32,
    dead: u32,
    /// How old the oldest entry is, in seconds.
    age: f64,
}

fn disk(text: &mut Text, room: Option<Room>) {
    for (metric, bytes) in [(&FREE, room.map(|room| room.free)), (&SIZE, room.map(|room| room.size()))] {
        let mut of = text.of(metric);
        if let Some(bytes) = bytes {
            of.put(&[], bytes);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use axum::http::HeaderMap;
    use tokio::runtime::Builder;

    use super::*;
    use crate::web::metrics::text::Format;
    use crate::web::request_guard::tests::station;

    #[test]
    fn an_engine_that_does_not_work_is_not_said_to_be_well() {
        let folder = tempfile::tempdir().unwrap();
        let (app, engine) = station(folder.path());
        engine.close(None);
        let runtime = Builder::new_current_thread().enable_all().build().unwrap();
        for (seconds, line) in [(0, "\nhalfrow_engine_well 1\n"), (6, "\nhalfrow_engine_well 0\n")] {
            engine.silent_for(Duration::from_secs(seconds));
            let mut text = Text::new(Format::asked(&HeaderMap::new()));
            let visit = app.stranger(&HeaderMap::new());
            runtime.block_on(write(&mut text, &app, &visit)).unwrap();
            let text = text.end();
            assert!(text.contains(line), "{text}");
        }
    }
}
