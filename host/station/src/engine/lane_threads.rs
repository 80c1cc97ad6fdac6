//! What works for one lane: a thread for its run, one for the hooks of a verdict, one to save a result that could not
//! be saved. Each reports to the engine how it went; none waits for another lane.

use std::error::Error;
use std::path::PathBuf;
use std::sync::mpsc::Sender;
use std::sync::{Arc, OnceLock};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use halfrow::Verdict;
use halfrow::verdict::StoppedBy;

use super::figures::Counter;
use super::hooks;
use super::logged::LoggedOfLanes;
use super::{Input, LaneEvent};
use crate::floor::{Accepted, Event, Shown};
use crate::guard::guarded;
use crate::lane::Doing;
use crate::outbox::{Sent, awaited, needs_person};
use crate::record::DeviceSeen;
use crate::run::{self, Order, RunError, Saved, Stage, Watch};
use crate::said::{Said, Saying};
use crate::settings::{Hook, Settings};
use crate::store::SharedStore;

/// How long to wait before trying again to save a result.
const AGAIN: Duration = Duration::from_secs(2);

/// How long a verdict waits for a plant that must have it.
const PLANT: Duration = Duration::from_secs(10);

/// What all lanes have in common.
#[derive(Debug)]
pub(super) struct Shared {
    pub(super) settings: Settings,
    pub(super) store: SharedStore,
    /// The program whose `lane` is started.
    pub(super) program: PathBuf,
    pub(super) inbox: Sender<Input>,
    pub(super) figures: Arc<Counter>,
    pub(super) logged: LoggedOfLanes,
}

impl Shared {
    /// What is started for this verdict, or when none is shown any more.
    pub(super) fn hooks(&self, on: Option<Verdict>) -> impl Iterator<Item = &Hook> {
        self.settings.hooks.iter().filter(move |hook| hook.on == on)
    }

    /// Logs and counts what happened to a lane.
    pub(super) fn note(&self, lane: usize, event: &Event) {
        let name = self.settings.lanes.get(lane).map_or("", |lane| lane.name.as_str());
        if let Some(reason) = self.logged.note(lane, name, event) {
            self.figures.refused(reason);
        }
    }

    fn tell(&self, lane: usize, heard: LaneEvent) {
        // An engine that has ended saw all runs end first.
        let _ = self.inbox.send(Input::Heard { lane, heard });
    }
}

/// Who wants a run to end, once somebody does.
pub(super) type StopAsked = Arc<OnceLock<StoppedBy>>;

/// Begins the run of what was accepted in `lane`.
pub(super) fn begin(
    shared: &Arc<Shared>,
    lane: usize,
    accepted: Accepted,
    stop: StopAsked,
) -> std::io::Result<JoinHandle<()>> {
    let shared = Arc::clone(shared);
    thread::Builder::new().name(format!("run in lane {lane}")).spawn(move || {
        let run = || carried_out(&shared, lane, &accepted, stop);
        let event = guarded(run).unwrap_or_else(|fault| unsaved(&fault));
        shared.tell(lane, LaneEvent::Happened(event));
    })
}

/// Carries out the run, and returns what came of it.
fn carried_out(shared: &Shared, lane: usize, accepted: &Accepted, stop: StopAsked) -> Event {
    let Settings { name, lanes, plans, silence, memory_mib, .. } = &shared.settings;
    let (Some(of), Some(file)) = (lanes.get(lane), plans.get(accepted.plan)) else {
        return Event::NotBegun { why: Saying::NoLaneOrPlan.into() };
    };
    let order = Order {
        plan: &file.plan,
        plan_file: &file.path,
        serial: &accepted.serial,
        board: &of.board,
        station: name,
        lane: &of.name,
        operator: &accepted.operator,
        program: &shared.program,
        // A lane that owes its shift a check takes no other board.
        counts: file.plan.production.counts(&accepted.serial),
        job: None,
        silence: *silence,
        memory_mib: *memory_mib,
    };
    let mut watched = RunWatch { shared, lane, run: String::new(), stop };
    match run::run(&shared.store, &order, &mut watched) {
        Ok(saved) => at_plant(shared, saved, PLANT),
        Err(error @ RunError::Unsaved { .. }) => unsaved(&error),
        Err(error) => Event::NotBegun { why: Said::of(&error) },
    }
}

/// Waits a while, and then tries to save the result of `run`.
pub(super) fn recover(shared: &Arc<Shared>, lane: usize, run: String) -> std::io::Result<JoinHandle<()>> {
    let shared = Arc::clone(shared);
    thread::Builder::new().name(format!("recovery in lane {lane}")).spawn(move || {
        thread::sleep(AGAIN);
        let event = guarded(|| match run::recover_run(&shared.store, &run) {
            Ok(saved) => at_plant(&shared, saved, Duration::ZERO),
            Err(error) => unsaved(&error),
        });
        shared.tell(lane, LaneEvent::Happened(event.unwrap_or_else(|fault| unsaved(&fault))));
    })
}

/// The run whose verdict is shown, and its serial number.
pub(super) fn named(shown: &Shown) -> [String; 2] {
    [shown.run.clone(), shown.serial.clone()]
}

/// Runs the hooks for what is shown on `lane`, or for that nothing is any more, one after another.
pub(super) fn hook(shared: &Shared, lane: usize, shown: Option<&Shown>) {
    let name = shared.settings.lanes.get(lane).map_or("", |lane| lane.name.as_str());
    for hook in shared.hooks(shown.map(|shown| shown.verdict)) {
        let said = match guarded(|| hooks::run(hook, name, shown)) {
            Ok(Ok(())) => continue,
            Ok(Err(error)) => Said::of(&error),
            Err(fault) => Said::of(&fault),
        };
        shared.tell(lane, LaneEvent::Hook { of: shown.map(named), said });
    }
}

/// The verdict of a run that is saved, which is counted. If the plant must have it, too, this waits until it does, or
/// reports after `patience` that it does not, or at once that it never will as things are.
fn at_plant(shared: &Shared, saved: Saved, patience: Duration) -> Event {
    shared.figures.saved(&saved.record);
    if !shared.settings.is_green_at_plant() {
        return Event::Ended(shown(saved));
    }
    let (folder, until) = (shared.store.folder(), Instant::now() + patience);
    match awaited(folder, &saved.record.run.id, &|| Instant::now() >= until) {
        Ok(Sent::Yes) => Event::Ended(shown(saved)),
        Ok(Sent::NotYet) => {
            Event::NotAtPlant { why: Said { causes: needs_person(folder), ..Saying::NotAtPlant.into() } }
        }
        Ok(Sent::Refused(why)) => Event::NotAtPlant { why },
        Err(error) => unsaved(&error),
    }
}

/// All that is known of the run is what is in the store, where the recovery looks.
fn unsaved(error: &(dyn Error + 'static)) -> Event {
    Event::Unsaved { why: Said::of(error) }
}

fn shown(saved: Saved) -> Shown {
    let Saved { record, stored, saved_ms, .. } = saved;
    Shown {
        run: record.run.id,
        serial: record.run.serial,
        verdict: record.conclusion.verdict,
        record_sha256: stored.record_sha256,
        headline: record.conclusion.headline,
        remedy: record.conclusion.remedy,
        finding: record.conclusion.finding,
        saved_ms,
        board_kind: record.board.map(|board| board.kind),
        is_identity_checked: record.device != DeviceSeen::NotChecked,
    }
}

/// A run whose progress is reported to the engine.
struct RunWatch<'a> {
    shared: &'a Shared,
    lane: usize,
    run: String,
    stop: StopAsked,
}

impl RunWatch<'_> {
    fn name(&self) -> &str {
        self.shared.settings.lanes.get(self.lane).map_or("", |lane| lane.name.as_str())
    }
}

impl Watch for RunWatch<'_> {
    fn stop(&self) -> Option<StoppedBy> {
        self.stop.get().copied()
    }

    fn hear(&mut self, stage: Stage<'_>) {
        let heard = match stage {
            Stage::Begun(run) => {
                self.run.clone_from(&run.id);
                LaneEvent::Happened(Event::Begun { run: run.id.clone() })
            }
            Stage::Saving { was_killed, is_stuck } => {
                self.shared.figures.ended(&self.run);
                if was_killed {
                    self.shared.figures.killed(self.name());
                }
                if is_stuck {
                    // Whatever becomes of the result.
                    self.shared.tell(self.lane, LaneEvent::Happened(Event::Stuck));
                }
                LaneEvent::Happened(Event::Saving)
            }
            Stage::AwaitsPlace(name) => {
                LaneEvent::Doing { run: self.run.clone(), what: Doing::Place(name.to_owned()) }
            }
            Stage::Told(message) => match Doing::of(message) {
                Some(what) => LaneEvent::Doing { run: self.run.clone(), what },
                None => return,
            },
        };
        self.shared.tell(self.lane, heard);
    }
}
