//! The threads that send, one for each sink.

use std::io;
use std::sync::mpsc::{self, Sender};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use super::{Sink, send};
use crate::guard::guarded;
use crate::store::{SharedStore, StoreError};

/// How long to wait at the end for what is under way.
const LAST: Duration = Duration::from_secs(5);

/// The threads that send.
#[derive(Debug, Default)]
pub struct Outbox {
    /// Dropping them ends the threads.
    stops: Vec<Sender<()>>,
    threads: Vec<JoinHandle<()>>,
}

impl Outbox {
    /// Sends to these sinks, including what was kept before.
    ///
    /// # Errors
    /// [`OutboxError`]
    pub fn start(store: &SharedStore, sinks: Vec<Box<dyn Sink>>) -> Result<Self, OutboxError> {
        if !sinks.is_empty() {
            let names = sinks.iter().map(|sink| sink.name().to_owned()).collect();
            store.with(|store| store.sends_to(names))?;
        }
        let mut outbox = Self::default();
        for sink in sinks {
            let (stop, stopped) = mpsc::channel();
            let (store, name) = (store.clone(), format!("outbox to {}", sink.name()));
            let work = move || {
                if let Err(fault) = guarded(|| send(&store, sink, &stopped)) {
                    tracing::error!("nothing is sent on any more: {fault}");
                }
            };
            outbox.stops.push(stop);
            outbox.threads.push(thread::Builder::new().name(name).spawn(work)?);
        }
        Ok(outbox)
    }

    /// Refuses to go on when something is not sent any more.
    ///
    /// # Errors
    /// [`SendingEnded`] when one of the threads has ended.
    pub(crate) fn refuse_ended(&self) -> Result<(), SendingEnded> {
        if self.threads.iter().any(JoinHandle::is_finished) { Err(SendingEnded) } else { Ok(()) }
    }

    /// Ends the threads. What takes too long is abandoned, and sent again at the next start.
    pub fn close(mut self) {
        self.stops.clear();
        let until = Instant::now() + LAST;
        for thread in self.threads {
            while !thread.is_finished() && Instant::now() < until {
                thread::sleep(Duration::from_millis(10));
            }
        }
    }
}

/// An outbox that cannot start.
#[derive(Debug, thiserror::Error)]
pub enum OutboxError {
    /// The system gives the program no thread for sending results.
    #[error("the system has no thread for what is to be sent; end other programs")]
    Thread(#[from] io::Error),
    /// The store does not take what is to be sent.
    #[error(transparent)]
    Store(#[from] StoreError),
}

/// A thread that sends has ended unasked.
#[derive(Debug, thiserror::Error)]
#[error(
    "the station has stopped sending on what it keeps, by a fault of its own that the log describes; start it again"
)]
pub(crate) struct SendingEnded;

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::outbox::{HeardClock, Undelivered};
    use crate::said::Said;
    use crate::store::{Folder, Parcel, Store};

    /// A sink with a fault of the program's own that no parcel brings out.
    pub(crate) struct Faulty;

    impl Sink for Faulty {
        fn name(&self) -> &str {
            "mes"
        }
        fn take(&mut self, _: &Parcel) -> Result<(), Undelivered> {
            Ok(())
        }
        fn beat(&mut self, _: u32, _: u32) -> Result<Option<HeardClock>, Said> {
            panic!("a fault of the program's own")
        }
    }

    #[test]
    fn a_thread_that_sends_no_more_is_noticed() {
        let place = tempfile::tempdir().unwrap();
        let store = SharedStore::new(Store::open(&Folder::new(place.path())).unwrap());
        let outbox = Outbox::start(&store, vec![Box::new(Faulty)]).unwrap();
        let begun = Instant::now();
        while outbox.refuse_ended().is_ok() {
            assert!(begun.elapsed() < Duration::from_secs(60), "nobody notices");
            thread::sleep(Duration::from_millis(10));
        }
        outbox.close();
    }
}
