//! The engine's news for every open page: the present state, then what changes, and a beat each second.
//!
//! A page that hears no beat does not show verdicts as live. The beat also stops when the engine's thread does.

use std::collections::{BTreeMap, HashMap};
use std::io;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::sync::{Arc, Weak};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use parking_lot::Mutex;
use tokio::sync::{broadcast, oneshot};

use crate::clock::{self, Moment};
use crate::engine::{Became, Engine, FailedHook, LaneDoing, LaneState, News, in_time};
use crate::floor::{ScanError, Word};
use crate::guard::guarded;

/// How often there is a beat.
const BEAT: Duration = Duration::from_secs(1);
/// How long after the last beat that a page heard its requests are carried out. Later another board may be there, and the page
/// has long said that it is not live.
const FRESH: Duration = Duration::from_secs(5);
/// How many events a page may lag behind. One that lags further is dropped, and connects anew.
const BACKLOG: usize = 1024;

/// An event for pages.
#[derive(Clone, Debug)]
pub(super) enum EventKind {
    /// A beat, with its moment.
    Beat(String),
    News(Box<News>),
}

/// An event with its number. A page that misses a number takes everything anew.
#[derive(Clone, Debug)]
pub(super) struct Event {
    pub(super) id: u64,
    pub(super) what: EventKind,
}

/// Everything as it is at one moment.
#[derive(Clone, Debug, Default)]
pub(super) struct Now {
    /// The number of the last event.
    pub(super) id: u64,
    /// This moment, as pages name it.
    pub(super) beat: String,
    pub(super) lanes: Vec<LaneState>,
    pub(super) doing: BTreeMap<String, LaneDoing>,
    /// The last hook of each lane that failed since the lane came to show what it shows.
    pub(super) failed: BTreeMap<String, FailedHook>,
}

impl Now {
    fn take(&mut self, news: &News) {
        match news {
            News::Lane(state) => {
                let is_over = state.run.is_none();
                if is_over {
                    self.doing.remove(&state.lane);
                }
                if let Some(known) = self.lanes.iter_mut().find(|known| known.lane == state.lane) {
                    let is_other = shows(known) != shows(state);
                    known.clone_from(state);
                    if is_other {
                        self.failed.remove(&state.lane);
                    }
                }
            }
            News::Doing(doing) => drop(self.doing.insert(doing.lane.clone(), doing.clone())),
            News::Hook(failed) => drop(self.failed.insert(failed.lane.clone(), failed.clone())),
            News::Scan(_) => {}
        }
    }
}

/// The source of all events for pages.
#[derive(Debug)]
pub(super) struct Live {
    now: Mutex<Now>,
    pages: broadcast::Sender<Event>,
    asked: Mutex<HashMap<u64, oneshot::Sender<Became>>>,
    numbers: AtomicU64,
    /// When it began, by a monotonic clock.
    begun: Moment,
    /// Tells this start of the station from others.
    start: String,
}

impl Live {
    /// Follows the engine's news from now on, in the thread that is returned.
    ///
    /// # Errors
    /// When the system has no thread for it.
    pub(super) fn start(engine: &Arc<Engine>) -> io::Result<(Arc<Self>, JoinHandle<()>)> {
        let live = Arc::new(Self::of(engine.lanes()));
        let (heard, engine, told) = (engine.listen(), Arc::clone(engine), Arc::downgrade(&live));
        let work = move || {
            if let Err(fault) = guarded(|| listen(&engine, heard, &told)) {
                tracing::error!("the pages hear no news any more: {fault}");
            }
        };
        Ok((live, thread::Builder::new().name("live".to_owned()).spawn(work)?))
    }

    fn of(lanes: Vec<LaneState>) -> Self {
        Self {
            now: Mutex::new(Now { lanes, ..Now::default() }),
            pages: broadcast::Sender::new(BACKLOG),
            asked: Mutex::default(),
            numbers: AtomicU64::new(0),
            begun: Moment::now(),
            start: clock::now_ms().to_string(),
        }
    }

    /// Everything as it is, and the events from then on.
    pub(super) fn follow(&self) -> (Now, broadcast::Receiver<Event>) {
        let now = self.now.lock();
        (Now { beat: self.moment(), ..now.clone() }, self.pages.subscribe())
    }

    /// Everything as it is.
    pub(super) fn now(&self) -> Now {
        self.now.lock().clone()
    }

    /// What this run does in this lane, as far as it was told.
    pub(super) fn doing(&self, lane: &str, run: &str) -> Option<LaneDoing> {
        let now = self.now.lock();
        now.doing.get(lane).filter(|doing| doing.run == run).cloned()
    }

    /// This moment, as pages name it.
    fn moment(&self) -> String {
        format!("{}-{}", self.start, self.begun.elapsed().as_millis())
    }

    /// Until when a request may be carried out of a page that last heard the station at the moment `beat`. A page that names
    /// none hears no news, and its user is trusted to know which board is there.
    ///
    /// # Errors
    /// [`ScanError::Late`] when it is too late already, or the moment belongs to another start.
    pub(super) fn until(&self, beat: &str) -> Result<Option<Moment>, ScanError> {
        if beat.is_empty() {
            return Ok(None);
        }
        let of_this = beat.split_once('-').filter(|(start, _)| *start == self.start);
        let heard = of_this.and_then(|(_, ms)| Some(self.begun + Duration::from_millis(ms.parse().ok()?)));
        let until = heard.ok_or(ScanError::Late)?.min(Moment::now()) + FRESH;
        in_time(Some(until)).map(|()| Some(until))
    }

    /// A number for a scan or an act, and the receiver of its result.
    pub(super) fn ask(&self) -> (u64, oneshot::Receiver<Became>) {
        let number = self.numbers.fetch_add(1, Ordering::Relaxed) + 1;
        let (sender, receiver) = oneshot::channel();
        let mut asked = self.asked.lock();
        asked.retain(|_, sender| !sender.is_closed());
        asked.insert(number, sender);
        (number, receiver)
    }

    fn hear(&self, news: News) {
        let answered = if let News::Scan(became) = &news { Some(became.clone()) } else { None };
        self.tell(EventKind::News(Box::new(news)));
        if let Some(became) = answered {
            let mut asked = self.asked.lock();
            // A page that is gone does not wait for its scan any more.
            let _ = asked.remove(&became.number).map(|sender| sender.send(became));
        }
    }

    /// News of the engine were missed. Every page finds a number missing, and takes everything anew; whoever waits for an
    /// answer is told that there is none.
    fn missed(&self) {
        let mut now = self.now.lock();
        now.id += 1;
        now.doing.clear();
        drop(now);
        self.asked.lock().clear();
    }

    /// Tells that the engine works, if it does.
    fn beat(&self, engine: &Engine) {
        if engine.is_well() {
            self.tell(EventKind::Beat(self.moment()));
        }
    }

    fn tell(&self, what: EventKind) {
        let mut now = self.now.lock();
        if let EventKind::News(news) = &what {
            now.take(news);
        }
        now.id += 1;
        // This fails when no page is open.
        let _ = self.pages.send(Event { id: now.id, what });
    }
}

/// By what pages tell whether a lane has something else to say.
fn shows(state: &LaneState) -> (Word, Option<&str>) {
    let shown = state.shown.as_ref().filter(|_| state.state.is_verdict());
    (state.state, shown.map(|shown| shown.run.as_str()))
}

/// Passes the engine's news on until nobody is left to hear them.
fn listen(engine: &Engine, mut heard: Receiver<News>, told: &Weak<Live>) {
    let mut beat = Instant::now();
    while let Some(live) = told.upgrade() {
        match heard.recv_timeout(BEAT.saturating_sub(beat.elapsed())) {
            Ok(news) => live.hear(news),
            Err(RecvTimeoutError::Timeout) => {}
            // There is no more news. Whoever still waits for an answer is told by the end of the connection.
            Err(RecvTimeoutError::Disconnected) if engine.is_ending() => return,
            // This thread was too slow for the engine. It listens anew, which begins with all lanes.
            Err(RecvTimeoutError::Disconnected) => {
                heard = engine.listen();
                live.missed();
            }
        }
        if beat.elapsed() >= BEAT {
            beat = Instant::now();
            live.beat(engine);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::tests::stopped;
    use crate::lane::Doing;

    /// `assets/live.js` takes everything anew when a number is not the one after the last.
    #[test]
    fn news_that_were_missed_are_missed_by_no_page_silently() {
        let live = Live::of(Vec::new());
        let (now, mut page) = live.follow();
        let (_, mut answer) = live.ask();
        live.tell(EventKind::Beat(String::new()));
        live.missed();
        live.tell(EventKind::Beat(String::new()));
        let heard = [page.try_recv().unwrap().id, page.try_recv().unwrap().id];
        assert_eq!((now.id, heard), (0, [1, 3]));
        assert!(
            matches!(answer.try_recv(), Err(oneshot::error::TryRecvError::Closed)),
            "it is not waited for"
        );
    }

    /// docs/station-lanes.md: a page does not show verdicts as live when it hears no beat.
    #[test]
    fn an_engine_that_does_not_work_has_no_beat() {
        let folder = tempfile::tempdir().unwrap();
        let (_, engine) = stopped(folder.path());
        let live = Live::of(Vec::new());
        let (_, mut page) = live.follow();
        engine.silent_for(Duration::from_secs(6));
        live.beat(&engine);
        assert!(page.try_recv().is_err());
        engine.silent_for(Duration::ZERO);
        live.beat(&engine);
        assert!(matches!(page.try_recv().unwrap().what, EventKind::Beat(_)));
    }

    /// docs/station-operator.md: what comes more than five seconds after the news that its page heard last is refused.
    #[test]
    fn a_request_may_come_five_seconds_after_the_beat_that_its_page_heard() {
        let begun = Moment::ago(Duration::from_secs(100));
        let live = Live { begun, ..Live::of(Vec::new()) };
        let until = |ms: u64| live.until(&format!("{}-{ms}", live.start));
        assert_eq!(until(99_000).unwrap(), Some(begun + Duration::from_secs(104)));
        assert!(matches!(until(94_000), Err(ScanError::Late)));
    }

    /// A lane that is drawn anew while its run goes on.
    #[test]
    fn what_a_run_does_is_known_while_it_does_it_and_is_not_that_of_another_run() {
        let live = Live::of(Vec::new());
        let doing = LaneDoing { lane: "1".to_owned(), run: "a".to_owned(), what: Doing::Rows(3, 9) };
        live.hear(News::Doing(doing.clone()));
        assert_eq!(live.doing("1", "a"), Some(doing));
        assert_eq!([live.doing("1", "b"), live.doing("2", "a")], [None, None]);
    }
}
