//! Sends what the station keeps on to every sink, until the sink has it for certain. One thread per sink; nothing
//! waits for it.
//!
//! ```text
//!  run, waiver, audit ─► entry, in the same transaction ─► round: parcel ─► sink ─► read back there ─► done
//!                                                            ▲    └ not now: again, later and later
//!                                                            └ nobody there: all of it waits
//! ```

mod back_off;
mod plant;
mod quiet;
mod sent;
mod sinks;
mod standing;
mod threads;

use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

pub use crate::clock::HeardClock;
pub use plant::PlantSink;
pub(crate) use sent::{Sent, awaited, needs_person};
pub(crate) use sinks::SinkError;
pub use sinks::{SinkSettingsError, open};
pub use standing::Standing;
pub(crate) use threads::SendingEnded;
#[cfg(test)]
pub(crate) use threads::tests::Faulty;
pub use threads::{Outbox, OutboxError};

use crate::clock;
use crate::guard::guarded;
use crate::said::Said;
use crate::store::{Backlog, Entry, LONGEST_WAIT_MS, Parcel, SharedStore, Snapshot, StoreError, Tried};
use quiet::Quiet;

/// How often to check whether there is something to send.
const LOOK: Duration = Duration::from_millis(200);
/// The least time between two writes of what became of entries. Each write has all that came since the last one, and
/// waits for the disk.
const KEPT: Duration = Duration::from_millis(200);
/// How often a sink is told how much it does not have.
const BEAT: Duration = Duration::from_secs(30);
/// How long a sink that has nothing to do stays connected.
const IDLE: Duration = Duration::from_secs(10);

/// Something to which the station sends what it keeps.
pub trait Sink: Send {
    /// Its name, under which the outbox notes what it has.
    fn name(&self) -> &str;

    /// Takes a parcel, which it may have been given before. When this returns without an error, it has it for certain.
    ///
    /// # Errors
    /// [`Undelivered`]
    fn take(&mut self, parcel: &Parcel) -> Result<(), Undelivered>;

    /// Tells it how much is to be sent to it, and how much of that waits for a person. Returns the clock by which it
    /// orders what several stations send, if it has one.
    ///
    /// # Errors
    /// Why it is away, if that is known.
    fn beat(&mut self, _unsent: u32, _dead: u32) -> Result<Option<HeardClock>, Said> {
        Ok(None)
    }

    /// Tells it that there is nothing to do for now.
    fn rest(&mut self) {}
}

/// Why a sink has not taken something, as far as is known.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Undelivered {
    /// It is not there, so nothing else need be tried.
    Away(Said),
    /// It does not take this for now.
    NotNow(Said),
    /// It does not have the runs that this belongs to, whatever it had before.
    Early(Said),
    /// It will never take this as it is; a person has to look at it.
    Refused(Said),
}

/// What a round came to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Round {
    /// Entries that it now has for certain.
    pub sent: usize,
    /// Entries that it has not taken.
    pub failed: usize,
    /// Whether the sink is away.
    pub is_away: bool,
}

/// Gives `sink` what is due for it, and keeps what became of it: an entry that the sink has is noted without waiting
/// for all that follow. How the sink is, is logged where it differs from its `standing`.
///
/// # Errors
/// [`StoreError`] when the store cannot be read or written. What was sent is then sent again, which changes nothing.
pub fn round(store: &SharedStore, sink: &mut dyn Sink, standing: &mut Standing) -> Result<Round, StoreError> {
    let due = store.folder().due(sink.name(), clock::now_ms(), LONGEST_WAIT_MS)?;
    let round = given(store, sink, due, |name, entry, why| standing.refused(name, entry, why))?;
    if round.sent + round.failed > 0 && !round.is_away {
        standing.there(sink.name(), round.sent, || left(store, sink));
    }
    Ok(round)
}

/// Gives `sink` all that it does not have, each entry once, however recently it was tried, unless the entry waits for
/// a person or the sink is away.
///
/// # Errors
/// Like [`round`].
pub fn all(store: &SharedStore, sink: &mut dyn Sink) -> Result<Round, StoreError> {
    store.with(|store| store.due_at_once(sink.name()))?;
    let (mut all, begun_ms) = (Round::default(), clock::now_ms());
    loop {
        // What is tried from here on is due again only after `begun_ms`.
        let due = store.folder().due(sink.name(), begun_ms, i64::MAX)?;
        if due.is_empty() || all.is_away {
            return Ok(all);
        }
        let Round { sent, failed, is_away } = given(store, sink, due, |_, _, _| ())?;
        all = Round { sent: all.sent + sent, failed: all.failed + failed, is_away };
    }
}

/// Gives `sink` what is `due`; `refused` is called for each entry that it has not taken.
fn given(
    store: &SharedStore,
    sink: &mut dyn Sink,
    due: Vec<Entry>,
    mut refused: impl FnMut(&str, &Entry, &Undelivered),
) -> Result<Round, StoreError> {
    let mut round = Round::default();
    let (mut tried, mut kept) = (Vec::new(), None::<Instant>);
    let keep = |name: &str, tried: &[_]| store.with(|store| store.tried(name, tried, clock::now_ms()));
    for entry in due {
        let taken = match store.folder().parcel(&entry) {
            Ok(parcel) => taken(sink, &parcel),
            Err(error) => Err(Undelivered::NotNow(Said::of(&error))),
        };
        round.sent += usize::from(taken.is_ok());
        round.failed += usize::from(taken.is_err());
        round.is_away = matches!(taken, Err(Undelivered::Away(_)));
        if let Err(why) = &taken {
            refused(sink.name(), &entry, why);
        }
        let became = became(&entry, taken);
        tried.push((entry, became));
        if round.is_away {
            break;
        }
        if kept.is_none_or(|kept| kept.elapsed() >= KEPT) {
            keep(sink.name(), &tried)?;
            tried.clear();
            kept = Some(Instant::now());
        }
    }
    if !tried.is_empty() {
        keep(sink.name(), &tried)?;
    }
    Ok(round)
}

/// What a sink makes of a parcel. A fault of the program's own is that of this one parcel: lanes go on, and other parcels are sent.
fn taken(sink: &mut dyn Sink, parcel: &Parcel) -> Result<(), Undelivered> {
    guarded(|| sink.take(parcel)).unwrap_or_else(|fault| {
        // Its connection may be in any state.
        sink.rest();
        Err(Undelivered::NotNow(Said::of(&fault)))
    })
}

fn became(entry: &Entry, taken: Result<(), Undelivered>) -> Tried {
    let Err(why) = taken else { return Tried::Done };
    let next_ms = clock::now_ms().saturating_add(back_off::ms(entry.attempts));
    match why {
        Undelivered::Away(said) | Undelivered::NotNow(said) => Tried::Again { next_ms, said },
        Undelivered::Early(said) => Tried::Early { next_ms, said },
        Undelivered::Refused(said) => Tried::Dead { said },
    }
}

fn left(store: &SharedStore, sink: &dyn Sink) -> Result<Backlog, StoreError> {
    Snapshot::take(store.folder())?.backlog(sink.name())
}

fn beat(store: &SharedStore, sink: &mut dyn Sink, standing: &mut Standing) {
    let read = left(store, sink);
    match &read {
        Ok(left) => standing.left = Some(*left),
        Err(error) => {
            tracing::error!(
                "what waits for {} cannot be counted: {}",
                sink.name(),
                Said::of(error).with_codes()
            );
        }
    }
    let Some(left) = standing.left else { return };
    let heard = sink.beat(left.entries, left.dead);
    match &heard {
        Ok(Some(clock)) => store.with(|store| store.heard_plant(*clock)),
        Ok(None) => {}
        Err(said) => standing.away(sink.name(), said),
    }
    // If something waits, whether that is taken says more.
    if matches!(heard, Ok(Some(_))) && left.entries == left.dead {
        standing.there(sink.name(), 0, || read);
    }
}

/// How long to wait after a round; `vain` counts the rounds before it for which the sink was away.
fn wait_after(round: Round, vain: &mut u32) -> Duration {
    if round.is_away {
        let wait = back_off::ms(*vain);
        *vain = vain.saturating_add(1);
        return Duration::from_millis(wait.unsigned_abs());
    }
    *vain = 0;
    // There may be more.
    if round.sent > 0 { Duration::ZERO } else { LOOK }
}

/// A round, unless nothing can be due yet.
fn looked(
    store: &SharedStore,
    sink: &mut dyn Sink,
    standing: &mut Standing,
    quiet: &mut Option<Quiet>,
) -> Result<Round, StoreError> {
    if quiet.as_ref().is_some_and(|quiet| quiet.lasts(store)) {
        return Ok(Round::default());
    }
    let round = round(store, sink, standing)?;
    *quiet = if round == Round::default() { Some(Quiet::of(store, sink.name())?) } else { None };
    Ok(round)
}

/// Sends until the outbox is closed.
fn send(store: &SharedStore, mut sink: Box<dyn Sink>, stopped: &Receiver<()>) {
    let (mut vain, mut worked, mut beaten) = (0, Instant::now(), None::<Instant>);
    let (mut standing, mut quiet) = (Standing::default(), None::<Quiet>);
    loop {
        if beaten.is_none_or(|beaten| beaten.elapsed() > BEAT) {
            beaten = Some(Instant::now());
            beat(store, &mut *sink, &mut standing);
        }
        let looked = looked(store, &mut *sink, &mut standing, &mut quiet);
        let round = looked.unwrap_or_else(|error| {
            tracing::error!("what is to be sent on stays here: {}", Said::of(&error).with_codes());
            Round { is_away: true, ..Round::default() }
        });
        if round.sent + round.failed > 0 {
            worked = Instant::now();
        } else if worked.elapsed() > IDLE {
            sink.rest();
        }
        if stopped.recv_timeout(wait_after(round, &mut vain)) == Err(RecvTimeoutError::Disconnected) {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::{Deed, Folder, Kind};

    /// docs/station-results.md: a second, then two, four, up to five minutes.
    #[test]
    fn what_is_not_taken_is_tried_again_later_and_later() {
        for (attempts, most) in [(0, 1_000), (3, 8_000), (20, 300_000)] {
            let entry = Entry { kind: Kind::Run, subject: "run".to_owned(), attempts };
            let said = Said::from(crate::said::Saying::PlanChanged);
            let before = clock::now_ms();
            let Tried::Again { next_ms, .. } = became(&entry, Err(Undelivered::NotNow(said))) else {
                panic!("it is tried again")
            };
            assert!(next_ms >= before + 3 * most / 4 && next_ms <= clock::now_ms() + most, "{attempts}");
        }
    }

    /// A sink that keeps what it is told in a beat.
    struct Listening(Option<(u32, u32)>);

    impl Sink for Listening {
        fn name(&self) -> &str {
            "mes"
        }
        fn take(&mut self, _: &Parcel) -> Result<(), Undelivered> {
            Ok(())
        }
        fn beat(&mut self, unsent: u32, dead: u32) -> Result<Option<HeardClock>, Said> {
            self.0 = Some((unsent, dead));
            Ok(None)
        }
    }

    /// A store with three entries for that sink, of which one waits for a person.
    fn store(place: &Folder) -> SharedStore {
        let mut store = crate::store::Store::open(place).unwrap();
        store.sends_to(vec!["mes".to_owned()]).unwrap();
        ["1", "2", "3"].iter().for_each(|number| {
            store.note(Deed { operator: "weber", act: "scan", subject: "1", detail: number }).unwrap();
        });
        let first = place.due("mes", clock::now_ms(), i64::MAX).unwrap().remove(0);
        let dead = Tried::Dead { said: Said::uncoded("no".to_owned()) };
        store.tried("mes", &[(first, dead)], clock::now_ms()).unwrap();
        SharedStore::new(store)
    }

    /// It hears of both in a beat, and the plant shows where a person has to look at something.
    #[test]
    fn what_waits_for_a_person_is_told_from_what_is_tried_again() {
        let place = tempfile::tempdir().unwrap();
        let mut sink = Listening(None);
        beat(&store(&Folder::new(place.path())), &mut sink, &mut Standing::default());
        assert_eq!(sink.0, Some((3, 1)));
    }

    /// A sink with a fault of the program's own, which the first parcel brings out.
    struct Stumbling {
        has_stumbled: bool,
        has_rested: bool,
    }

    impl Sink for Stumbling {
        fn name(&self) -> &str {
            "mes"
        }
        fn take(&mut self, _: &Parcel) -> Result<(), Undelivered> {
            assert!(std::mem::replace(&mut self.has_stumbled, true), "a fault of the program's own");
            Ok(())
        }
        fn rest(&mut self) {
            self.has_rested = true;
        }
    }

    #[test]
    fn a_parcel_that_brings_out_a_fault_keeps_no_other_from_being_sent() {
        let place = tempfile::tempdir().unwrap();
        let folder = Folder::new(place.path());
        let store = store(&folder);
        let mut sink = Stumbling { has_stumbled: false, has_rested: false };
        let round = round(&store, &mut sink, &mut Standing::default()).unwrap();
        assert_eq!((round, sink.has_rested), (Round { sent: 1, failed: 1, is_away: false }, true));
        let [left] = &Snapshot::take(&folder).unwrap().unsent().unwrap()[..] else { panic!("one waits") };
        assert_eq!(left.said.as_ref().map(|said| &*said.code), Some("program-failed"));
    }

    /// The plant would show that nothing waits just when the store is in trouble.
    #[test]
    fn a_sink_hears_no_other_figures_while_the_outbox_cannot_be_read() {
        let place = tempfile::tempdir().unwrap();
        let folder = Folder::new(place.path());
        let (store, mut standing) = (store(&folder), Standing::default());
        beat(&store, &mut Listening(None), &mut standing);
        std::fs::rename(folder.database(), place.path().join("away")).unwrap();
        let heard = |standing: &mut Standing| {
            let mut sink = Listening(None);
            beat(&store, &mut sink, standing);
            sink.0
        };
        assert_eq!(heard(&mut standing), Some((3, 1)), "as before");
        assert_eq!(heard(&mut Standing::default()), None, "nothing was ever read");
    }

    #[test]
    fn a_sink_that_was_away_once_is_asked_as_soon_when_it_is_away_again() {
        let (away, idle) = (Round { is_away: true, ..Round::default() }, Round::default());
        let mut vain = 0;
        for (round, most_ms) in [(away, 1_000), (away, 2_000), (away, 4_000), (idle, 200), (away, 1_000)] {
            let wait = wait_after(round, &mut vain).as_millis();
            assert!((3 * most_ms / 4..=most_ms).contains(&wait), "{wait} ms, not {most_ms}");
        }
        assert_eq!(wait_after(Round { sent: 1, ..idle }, &mut vain), Duration::ZERO, "there may be more");
    }
}
