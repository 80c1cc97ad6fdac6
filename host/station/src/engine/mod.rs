//! A station at work: several lanes at once, one store, and news for whoever listens.
//!
//! ```text
//!  scans, buttons ──► ┌────────┐ ──► news
//!  presence ────────► │ engine │ ──► a thread a run ──► a process a run
//!  what runs tell ──► └────────┘ ──► hooks, recovery
//!                     one thread, which owns the floor; it waits for its inbox, and for short queries of the store
//! ```

mod asked;
mod at_work;
mod figures;
mod hook_queue;
mod hooks;
mod known;
mod lane_threads;
mod lane_work;
mod logged;
mod news;
mod unsent;

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use halfrow::verdict::StoppedBy;
use parking_lot::Mutex;

pub use figures::{Figures, Histogram};
pub(crate) use hooks::HookError;
pub use news::{Became, FailedHook, LaneDoing, LaneState, News};

use crate::clock::Moment;
use crate::floor::{Act, Event, ScanError};
use crate::guard::guarded;
use crate::labgrid;
use crate::lane::Doing;
use crate::said::Said;
use crate::settings::Settings;
use crate::store::{SharedStore, Store};
use at_work::AtWork;
use figures::Counter;
use lane_threads::Shared;
use logged::LoggedOfLanes;
use news::Listeners;

/// How long its thread may show no sign of life. It shows one twice a second, and may have to wait for a slow disk.
const SILENT: Duration = Duration::from_secs(5);

/// Input for the engine.
#[derive(Debug)]
enum Input {
    Scan { number: u64, text: String, operator: String },
    Label { number: u64, lane: Option<usize>, label: String, operator: String, until: Option<Moment> },
    Act { number: u64, lane: usize, act: Act, of: String, operator: String, until: Option<Moment> },
    Heard { lane: usize, heard: LaneEvent },
    Close(Option<StoppedBy>),
}

/// What a lane reports.
#[derive(Debug)]
enum LaneEvent {
    Happened(Event),
    Doing {
        run: String,
        what: Doing,
    },
    /// With the run and the serial number whose verdict the hook should have shown, if any.
    Hook {
        of: Option<[String; 2]>,
        said: Said,
    },
}

/// A station at work.
#[derive(Debug)]
pub struct Engine {
    inbox: Sender<Input>,
    live: Arc<Mutex<LiveState>>,
    figures: Arc<Counter>,
    store: SharedStore,
    thread: Mutex<Option<JoinHandle<()>>>,
    /// Whether it was told to end.
    is_ending: AtomicBool,
}

/// The engine's thread has ended unasked.
#[derive(Debug, thiserror::Error)]
#[error("the station has stopped working, by a fault of its own that the log describes; start it again")]
pub(crate) struct EngineEnded;

/// What everybody may see: the lanes as they are, and who listens to changes.
#[derive(Debug, Default)]
struct LiveState {
    lanes: Vec<LaneState>,
    listeners: Listeners,
    /// When the engine's thread was last seen to work.
    worked: Option<Instant>,
}

impl Engine {
    /// Starts the station of these settings with its store, in which nothing may be open, and with `program`, whose
    /// `lane` is started for every run.
    ///
    /// # Errors
    /// When the system has no thread for it.
    pub fn start(settings: Settings, store: Store, program: PathBuf) -> std::io::Result<Self> {
        labgrid::give_back(settings.lanes.iter().map(|lane| &lane.board));
        let (inbox, received) = mpsc::channel();
        let floor = settings.floor();
        let lanes = floor.lanes().iter().map(LaneState::from).collect();
        let live = Arc::new(Mutex::new(LiveState { lanes, listeners: Listeners::default(), worked: None }));
        let store = SharedStore::new(store);
        let figures = Arc::new(Counter::of(&settings));
        let shared = Shared {
            settings,
            store: store.clone(),
            program,
            inbox: inbox.clone(),
            figures: Arc::clone(&figures),
            logged: LoggedOfLanes::of(floor.lanes().len()),
        };
        let at_work = AtWork::new(floor, Arc::new(shared), Arc::clone(&live));
        let thread =
            thread::Builder::new().name("engine".to_owned()).spawn(move || work(at_work, &received))?;
        let (thread, is_ending) = (Mutex::new(Some(thread)), AtomicBool::new(false));
        Ok(Self { inbox, live, figures, store, thread, is_ending })
    }

    /// Takes what `operator` scanned. What becomes of it is reported as news with the same `number`.
    pub fn scan(&self, number: u64, text: &str, operator: &str) {
        let (text, operator) = (text.to_owned(), operator.to_owned());
        self.put(Input::Scan { number, text, operator });
    }

    /// Like [`Self::scan`], for a label without what the scanner adds. It is for `lane` if there is one, and refused
    /// after `until`.
    pub fn label(
        &self,
        number: u64,
        lane: Option<usize>,
        label: &str,
        operator: &str,
        until: Option<Moment>,
    ) {
        let (label, operator) = (label.to_owned(), operator.to_owned());
        self.put(Input::Label { number, lane, label, operator, until });
    }

    /// Does with the lane at this index what `operator` wants who saw this run or serial number `of` in it, unless it is after
    /// `until`. What becomes of it is news, as for a scan.
    pub fn act(
        &self,
        number: u64,
        (lane, of): (usize, &str),
        act: Act,
        operator: &str,
        until: Option<Moment>,
    ) {
        let (of, operator) = (of.to_owned(), operator.to_owned());
        self.put(Input::Act { number, lane, act, of, operator, until });
    }

    /// Takes the lane at this index out of service, because a process of an earlier run may still have its board.
    pub(crate) fn stuck(&self, lane: usize) {
        self.put(Input::Heard { lane, heard: LaneEvent::Happened(Event::Stuck) });
    }

    /// All news from now on, after the present state of every lane. A listener that is too far behind hears no more.
    #[must_use]
    pub fn listen(&self) -> Receiver<News> {
        let mut live = self.live.lock();
        let lanes: Vec<_> = live.lanes.iter().cloned().map(News::Lane).collect();
        live.listeners.add(lanes.into_iter())
    }

    /// The state of every lane.
    #[must_use]
    pub fn lanes(&self) -> Vec<LaneState> {
        self.live.lock().lanes.clone()
    }

    /// What was counted since it began.
    #[must_use]
    pub fn figures(&self) -> Figures {
        self.figures.now()
    }

    /// Counts what a person did and the store could not enter, so that it did not reach the engine.
    pub(crate) fn refused_by_store(&self) {
        self.figures.refused(logged::STORE);
    }

    /// Whether its thread works, as seen within the last seconds.
    #[must_use]
    pub(crate) fn is_well(&self) -> bool {
        self.is_well_at(Instant::now())
    }

    fn is_well_at(&self, now: Instant) -> bool {
        self.live.lock().worked.is_some_and(|worked| now.duration_since(worked) < SILENT)
    }

    /// Makes it look as if its thread, which has ended, was last seen to work this long ago.
    #[cfg(test)]
    pub(crate) fn silent_for(&self, time: Duration) {
        self.live.lock().worked = Instant::now().checked_sub(time);
    }

    /// Whether its thread has ended, which it does unasked only because of a fault. It may also be alive and silent,
    /// as while a disk is slow.
    #[must_use]
    pub fn has_ended(&self) -> bool {
        let thread = self.thread.lock();
        thread.as_ref().is_none_or(JoinHandle::is_finished)
    }

    /// Whether it was told to end, so that it answers nothing more.
    #[must_use]
    pub(crate) fn is_ending(&self) -> bool {
        self.is_ending.load(Ordering::Acquire)
    }

    /// The store, for what is neither a scan nor a run.
    #[must_use]
    pub fn store(&self) -> SharedStore {
        self.store.clone()
    }

    /// Ends the engine once all runs under way are over, and their results saved. With `by` the runs are ended, too;
    /// without it they come to their own end.
    pub fn close(&self, by: Option<StoppedBy>) {
        let Some(thread) = self.thread.lock().take() else { return };
        self.is_ending.store(true, Ordering::Release);
        self.put(Input::Close(by));
        if thread.join().is_err() {
            tracing::error!("the engine ended early; look at what it said before");
        }
        // There is no more news, which ends the listeners.
        self.live.lock().listeners = Listeners::default();
    }

    fn put(&self, input: Input) {
        if self.inbox.send(input).is_err() && !self.is_ending() {
            tracing::error!("the engine has ended; start the station again");
        }
    }
}

/// Whether what was asked for may still be done.
///
/// # Errors
/// [`ScanError::Late`] after `until`.
pub(crate) fn in_time(until: Option<Moment>) -> Result<(), ScanError> {
    if until.is_some_and(|until| Moment::now() > until) { Err(ScanError::Late) } else { Ok(()) }
}

fn work(at_work: AtWork, inbox: &Receiver<Input>) {
    if let Err(fault) = guarded(|| at_work.run(inbox)) {
        tracing::error!("{fault}");
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use std::fs;
    use std::path::Path;

    use super::*;
    use crate::store::Folder;

    /// A station with one lane, whose settings are in `folder`.
    pub(crate) fn station(folder: &Path) -> (Settings, Arc<Engine>) {
        let path = folder.join("station.toml");
        let lane = "[[lane]]\nname = \"1\"\nboard = \"mock\"\nplans = [\"plan.toml\"]\n";
        fs::write(&path, format!("schema = 1\n[station]\nname = \"12\"\ndata = \"data\"\n{lane}")).unwrap();
        fs::write(folder.join("plan.toml"), include_str!("../../tests/station/quick.toml")).unwrap();
        let settings = Settings::load(&path).unwrap();
        let store = Store::open(&Folder::new(&settings.data)).unwrap();
        let engine = Engine::start(settings.clone(), store, "lane".into()).unwrap();
        (settings, Arc::new(engine))
    }

    /// The same with an engine that has ended, so that nothing shows that it works.
    pub(crate) fn stopped(folder: &Path) -> (Settings, Arc<Engine>) {
        let (settings, engine) = station(folder);
        engine.close(None);
        (settings, engine)
    }

    #[test]
    fn an_engine_that_was_silent_for_five_seconds_is_not_well() {
        let folder = tempfile::tempdir().unwrap();
        let (_, engine) = stopped(folder.path());
        engine.silent_for(Duration::ZERO);
        let worked = engine.live.lock().worked.unwrap();
        let is_well = [0, 4_999, 5_000].map(|ms| engine.is_well_at(worked + Duration::from_millis(ms)));
        assert_eq!(is_well, [true, true, false]);
    }
}
