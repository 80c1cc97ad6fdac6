//! The engine's own thread.

use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::Receiver;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use halfrow::verdict::StoppedBy;
use parking_lot::Mutex;

use super::hook_queue::{NotStarted, Shows};
use super::known::{Known, KnownOfLane};
use super::lane_threads::{self, Shared, StopAsked};
use super::lane_work::LaneWork;
use super::news::{Became, FailedHook, LaneDoing, LaneState, News};
use super::unsent;
use super::{Input, LaneEvent, LiveState, in_time};
use crate::clock;
use crate::floor::{Accepted, Effect, Event, Floor, Owes, ScanError, ScanOutcome, Shown, Word};
use crate::labgrid;
use crate::presence::USB;
use crate::said::{Said, Saying};
use crate::settings::{PlanFile, Settings};
use crate::store::{AgainError, InLane, Owed};

/// How often to check which boards are there.
const LOOK: Duration = Duration::from_millis(500);
/// How often the end looks whether it is over.
const LOOK_AT_END: Duration = Duration::from_millis(10);

/// What only the engine's thread has.
pub(super) struct AtWork {
    floor: Floor,
    shared: Arc<Shared>,
    live: Arc<Mutex<LiveState>>,
    lanes: Vec<LaneWork>,
    threads: Vec<JoinHandle<()>>,
    begun: Instant,
}

impl AtWork {
    pub(super) fn new(floor: Floor, shared: Arc<Shared>, live: Arc<Mutex<LiveState>>) -> Self {
        let lanes = floor.lanes().iter().map(|_| LaneWork::new()).collect();
        Self { floor, shared, live, lanes, threads: Vec::new(), begun: Instant::now() }
    }

    /// Works until it is told to close and every run is over.
    pub(super) fn run(mut self, inbox: &Receiver<Input>) {
        // An earlier start may have left a lamp on.
        (0..self.lanes.len()).for_each(|lane| self.hook(lane, None));
        let (mut looked, mut is_closing) = (None::<Instant>, false);
        while !(is_closing && self.is_idle()) {
            self.works();
            if !is_closing && looked.is_none_or(|looked| looked.elapsed() >= LOOK) {
                looked = Some(Instant::now());
                self.look();
            }
            let Ok(input) = inbox.recv_timeout(LOOK) else { continue };
            // A shift whose hours have just ended takes no more boards.
            self.check_due();
            match input {
                Input::Scan { .. } | Input::Label { .. } | Input::Act { .. } if is_closing => {}
                Input::Scan { number, text, operator } => self.scan(number, text, &operator),
                Input::Label { number, lane, label, operator, until } => {
                    let answer = in_time(until).and_then(|()| self.label(lane, &label, &operator));
                    self.answer(number, label, answer);
                }
                Input::Act { number, lane, act, of, operator, until } => {
                    let answer = in_time(until).and_then(|()| self.floor.press(lane, act, &of, &operator));
                    self.answer(number, act.barcode(), answer);
                }
                Input::Heard { lane, heard } => self.heard(lane, heard),
                Input::Close(by) => {
                    is_closing = true;
                    (0..self.lanes.len()).for_each(|lane| self.stop(lane, by));
                }
            }
        }
        self.end(inbox);
    }

    /// Shows a sign of life.
    fn works(&self) {
        self.live.lock().worked = Some(Instant::now());
    }

    /// Waits for hooks, recoveries and what labgrid lent, and publishes what hooks still report.
    fn end(mut self, inbox: &Receiver<Input>) {
        // Nobody would put a lamp out over the next board.
        (0..self.lanes.len()).for_each(|lane| self.hook(lane, None));
        let hooks = std::mem::take(&mut self.lanes).into_iter().flat_map(|of| of.hooks.into_threads());
        let threads: Vec<_> = std::mem::take(&mut self.threads).into_iter().chain(hooks).collect();
        while threads.iter().any(|thread| !thread.is_finished()) {
            inbox.recv_timeout(LOOK_AT_END).into_iter().for_each(|input| self.told_of_hook(input));
        }
        inbox.try_iter().for_each(|input| self.told_of_hook(input));
        for thread in threads {
            if thread.join().is_err() {
                tracing::error!("a thread of a lane ended early; look at what it said before");
            }
        }
        labgrid::wait_until_left(self.shared.settings.lanes.iter().map(|lane| &lane.board));
    }

    /// Takes what a hook reports while nothing else counts any more.
    fn told_of_hook(&mut self, input: Input) {
        if let Input::Heard { lane, heard: heard @ LaneEvent::Hook { .. } } = input {
            self.heard(lane, heard);
        }
    }

    /// Whether no run is under way. A run that could not be saved is found open at the next start.
    fn is_idle(&self) -> bool {
        !self.floor.lanes().iter().any(|lane| matches!(lane.word(), Word::Running | Word::Saving))
    }

    fn now(&self) -> Duration {
        self.begun.elapsed()
    }

    /// Checks which boards are there, and tries again to save the runs that there was no thread for.
    fn look(&mut self) {
        self.check_due();
        for lane in 0..self.lanes.len() {
            let run = self.lanes.get_mut(lane).and_then(|of| of.unrecovered.take());
            self.effect(lane, run.map(|run| Effect::Recover { run }));
        }
        let now = self.now();
        let lanes = self.shared.settings.lanes.iter().zip(&mut self.lanes).enumerate();
        let changed = lanes.filter_map(|(lane, (settings, of))| {
            Some((lane, of.presence.look(settings.board.is_there(Path::new(USB)), now)?))
        });
        let changed: Vec<_> = changed.collect();
        for (lane, effect) in self.floor.looked(&changed, now) {
            self.carry_out(lane, effect);
        }
    }

    /// What a lane owes its shift, as the store says. While that cannot be found out, the lane is out of service.
    fn owed(&self, lane: usize) -> (Option<Owes>, Known) {
        let Settings { name, lanes, plans, .. } = &self.shared.settings;
        let (now_ms, mut until_ms) = (clock::now_ms(), i64::MAX);
        let Some(lane) = lanes.get(lane) else { return (None, Known::Between(now_ms, until_ms)) };
        for &plan in &lane.plans {
            let Some(PlanFile { plan: of, .. }) = plans.get(plan) else { continue };
            // A store in trouble takes its time for each question.
            self.works();
            match self.shared.store.folder().owed(&InLane::of(name, &lane.name, of), now_ms) {
                Ok(checked) => {
                    until_ms = until_ms.min(checked.until_ms);
                    if let Some(Owed { serial, why }) = checked.owed {
                        let owes = Owes { plan, serial: Some(serial), why };
                        return (Some(owes), Known::Between(now_ms, until_ms));
                    }
                }
                Err(error) => {
                    let owes = Owes { plan, serial: None, why: Said::of(&error) };
                    return (Some(owes), Known::Untold(Instant::now()));
                }
            }
        }
        (None, Known::Between(now_ms, until_ms))
    }

    /// Asks what a lane owes; returns why the store failed, if it did.
    fn check(&mut self, lane: usize) -> Option<Said> {
        let (owed, known) = self.owed(lane);
        if let Some(of) = self.lanes.get_mut(lane) {
            of.known.told(known, Instant::now());
        }
        let failed = owed.as_ref().filter(|_| matches!(known, Known::Untold(_))).map(|owes| owes.why.clone());
        self.happened(lane, Event::Owes(owed));
        failed
    }

    /// Asks what lanes owe, where that is no longer known. In between only runs of this station change it, and each of
    /// them is followed by a check. A store that fails is not asked about the other lanes for now: they are out of service, too,
    /// and those that waited longest are asked about next.
    fn check_due(&mut self) {
        let mut failed = None::<Said>;
        let known = self.lanes.iter().map(|of| &of.known);
        for lane in KnownOfLane::due(known, clock::now_ms(), Instant::now()) {
            let passed_over = failed.clone().zip(self.with_shift(lane));
            let Some((why, plan)) = passed_over else {
                failed = self.check(lane).or(failed);
                continue;
            };
            if let Some(of) = self.lanes.get_mut(lane) {
                of.known.passed_over(Instant::now());
            }
            self.happened(lane, Event::Owes(Some(Owes { plan, serial: None, why })));
        }
    }

    /// The first plan of a lane whose shifts are checked. The store is not asked about a lane without one.
    fn with_shift(&self, lane: usize) -> Option<usize> {
        let Settings { lanes, plans, .. } = &self.shared.settings;
        let has_shift = |plan: &usize| plans.get(*plan).is_some_and(|of| of.plan.production.shift.is_some());
        lanes.get(lane)?.plans.iter().copied().find(has_shift)
    }

    fn scan(&mut self, number: u64, text: String, operator: &str) {
        let now = self.now();
        let answer = match self.shared.settings.scanner.label(&text) {
            Some(label) => self.floor.scan(label, operator, now),
            None => Err(ScanError::Incomplete),
        };
        self.answer(number, text, answer);
    }

    fn label(&mut self, lane: Option<usize>, label: &str, operator: &str) -> Result<ScanOutcome, ScanError> {
        let now = self.now();
        match lane {
            Some(lane) => self.floor.scan_for(lane, label, operator, now),
            None => self.floor.scan(label, operator, now),
        }
    }

    /// Publishes what became of a scan, and carries out its effect.
    fn answer(&mut self, number: u64, scanned: String, answer: Result<ScanOutcome, ScanError>) {
        let (is_taken, lane, effect, said) = match answer {
            Ok(ScanOutcome { lane: Some(lane), effect, said }) => match self.admit(lane, effect) {
                Ok(effect) => (true, Some(lane), effect, said),
                Err(why) => (false, Some(lane), None, why),
            },
            Ok(ScanOutcome { lane: None, effect, said }) => (true, None, effect, said),
            Err(error) => (false, None, None, Said::of(&error)),
        };
        let name = lane.and_then(|lane| Some(self.floor.lanes().get(lane)?.name().to_owned()));
        self.tell(&News::Scan(Became { number, scanned, is_taken, lane: name, said }));
        if let Some(lane) = lane {
            self.publish(lane);
            self.effect(lane, effect);
        }
    }

    fn heard(&mut self, lane: usize, heard: LaneEvent) {
        let name = || self.floor.lanes().get(lane).map_or_else(String::new, |lane| lane.name().to_owned());
        match heard {
            LaneEvent::Happened(event) => {
                // A verdict is published together with what the lane owes after it.
                if matches!(event, Event::Ended(_)) {
                    self.check(lane);
                }
                self.happened(lane, event);
            }
            LaneEvent::Doing { run, what } => {
                self.tell(&News::Doing(LaneDoing { lane: name(), run, what }));
            }
            LaneEvent::Hook { of, said } => {
                let lane = name();
                let [run, serial] = of.map_or([None, None], |of| of.map(Some));
                // Pages show it only until the next board is judged in the lane.
                let unit = serial.as_ref().map_or_else(String::new, |serial| format!(", {serial}"));
                tracing::warn!("lane {lane}{unit}: {}", said.with_codes());
                self.tell(&News::Hook(FailedHook { lane, run, serial, said }));
            }
        }
    }

    fn happened(&mut self, lane: usize, event: Event) {
        self.shared.note(lane, &event);
        let effect = self.floor.happened(lane, event);
        self.carry_out(lane, effect);
    }

    /// Publishes what has become of a lane, and carries out the effect.
    fn carry_out(&mut self, lane: usize, effect: Option<Effect>) {
        // When plugging a board in started the run, it is the lane that says why it was not begun.
        let effect = self.admit(lane, effect).ok().flatten();
        self.publish(lane);
        self.effect(lane, effect);
    }

    /// The effect, unless it would begin a run that must not begin: then the lane and the error say why not.
    fn admit(&mut self, lane: usize, effect: Option<Effect>) -> Result<Option<Effect>, Said> {
        let Some(Effect::Begin(of)) = &effect else { return Ok(effect) };
        let Some(why) = self.why_not(lane, of) else { return Ok(effect) };
        let not_begun = Event::NotBegun { why: why.clone() };
        self.shared.note(lane, &not_begun);
        self.floor.happened(lane, not_begun);
        Err(why)
    }

    /// Why this unit must not be tested now: too much is not at the plant yet, or it passed already. Some plans only
    /// ask for its label once more then; if the next scan in the lane answers that, it is tested.
    fn why_not(&mut self, lane: usize, of: &Accepted) -> Option<Said> {
        let PlanFile { plan, .. } = self.shared.settings.plans.get(of.plan)?;
        let asked = &mut self.lanes.get_mut(lane)?.asked;
        let was_answered = asked.is_answered(of, Instant::now());
        let (folder, settings) = (self.shared.store.folder(), &self.shared.settings);
        if let Some(why) = unsent::refuses(settings, folder) {
            return Some(why);
        }
        match folder.again(plan, &of.serial, "scan it once more", settings.is_green_at_plant()) {
            Ok(None) => None,
            Ok(Some(AgainError::Asked { .. })) if was_answered => None,
            Ok(Some(error)) => {
                asked.note(&error, of, Instant::now());
                Some(Said::of(&error))
            }
            Err(error) => Some(Said::of(&error)),
        }
    }

    /// Carries out an effect. The state is published first, so that a lamp says nothing that the screen does not.
    fn effect(&mut self, lane: usize, effect: Option<Effect>) {
        let Some(effect) = effect else { return };
        let started = match effect.clone() {
            Effect::Stop => return self.stop(lane, Some(StoppedBy::Person)),
            Effect::Hooks(shown) => {
                self.hook(lane, Some(shown));
                if !self.has_verdict(lane) {
                    self.hook(lane, None);
                }
                return;
            }
            Effect::Begin(accepted) => self.begin(lane, accepted),
            Effect::Recover { run } => lane_threads::recover(&self.shared, lane, run),
        };
        self.threads.retain(|thread| !thread.is_finished());
        match started {
            Ok(thread) => self.threads.push(thread),
            Err(error) => self.without_thread(lane, effect, &error),
        }
    }

    /// Deals with an effect that the system has no thread for.
    fn without_thread(&mut self, lane: usize, effect: Effect, error: &std::io::Error) {
        let why = Said::from(Saying::NoThread { error: error.to_string() });
        match effect {
            Effect::Begin(_) => self.happened(lane, Event::NotBegun { why }),
            Effect::Recover { run } => {
                tracing::warn!("the run {run} is not saved yet: {}", why.with_codes());
                if let Some(of) = self.lanes.get_mut(lane) {
                    of.unrecovered = Some(run);
                }
            }
            Effect::Hooks(_) | Effect::Stop => {}
        }
    }

    /// Whether the lane shows a verdict.
    fn has_verdict(&self, lane: usize) -> bool {
        self.floor.lanes().get(lane).is_some_and(|lane| lane.word().is_verdict())
    }

    /// Starts the hooks for what is shown, or for that nothing is any more, or reports why not.
    fn hook(&mut self, lane: usize, shown: Option<Shown>) {
        let (on, unit) = (shown.as_ref().map(|shown| shown.verdict), shown.as_ref().map(lane_threads::named));
        let Some(of) = self.lanes.get_mut(lane).filter(|_| self.shared.hooks(on).next().is_some()) else {
            return;
        };
        let shared = Arc::clone(&self.shared);
        let shows = if shown.is_some() { Shows::Verdict } else { Shows::Nothing };
        let work = move || lane_threads::hook(&shared, lane, shown.as_ref());
        let begun = of.hooks.begin(shows, format!("hooks of lane {lane}"), work);
        let why = match begun {
            Ok(()) => return,
            Err(NotStarted::Behind(verdicts)) => Saying::HooksBehind { verdicts },
            Err(NotStarted::NoThread(error)) => Saying::NoThread { error: error.to_string() },
        };
        self.heard(lane, LaneEvent::Hook { of: unit, said: why.into() });
    }

    fn begin(&mut self, lane: usize, accepted: Accepted) -> std::io::Result<JoinHandle<()>> {
        let stop = StopAsked::default();
        if let Some(of) = self.lanes.get_mut(lane) {
            of.stop = Arc::clone(&stop);
        }
        lane_threads::begin(&self.shared, lane, accepted, stop)
    }

    fn stop(&mut self, lane: usize, by: Option<StoppedBy>) {
        if let Some((of, by)) = self.lanes.get(lane).zip(by) {
            // Only the first request counts.
            let _ = of.stop.set(by);
        }
    }

    /// Publishes the state of a lane if it has changed. Once it shows no verdict any more, lamps are put out.
    fn publish(&mut self, lane: usize) {
        let Some(state) = self.floor.lanes().get(lane).map(LaneState::from) else { return };
        let mut live = self.live.lock();
        let Some(known) = live.lanes.get_mut(lane).filter(|known| **known != state) else { return };
        let is_cleared = known.state.is_verdict() && !state.state.is_verdict();
        known.clone_from(&state);
        live.listeners.tell(&News::Lane(state));
        drop(live);
        if is_cleared {
            self.hook(lane, None);
        }
    }

    fn tell(&self, news: &News) {
        self.live.lock().listeners.tell(news);
    }
}
