//! What is held at a plant: a thread renews the lease, and notes when it is lost.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use parking_lot::Mutex;

use crate::clock::Moment;
use crate::guard::guarded;
use crate::said::Said;
use crate::store::{Claim, LEASE_MS, Lease, Plant, PlantLink, StoreError};

/// How long it is held after it was last renewed.
const HELD: Duration = Duration::from_millis(LEASE_MS.unsigned_abs());
/// The time between two renewals, which are three times as often as they must be.
const RENEWED: Duration = Duration::from_millis(LEASE_MS.unsigned_abs() / 3);
/// How soon a renewal is tried again when the plant did not answer.
const AGAIN: Duration = Duration::from_secs(1);
/// How long before the end of its lease something counts as lost: in this time a lane that heeds its station stops using the
/// board. One that does not is killed some seconds later, when somebody else may have the board; by then the board itself refuses
/// its packets, because its session is over.
const ENDS: Duration = Duration::from_secs(4);

/// What is held.
#[derive(Clone, Debug)]
pub enum Held {
    /// A board.
    Board(Lease),
    /// A job with its board.
    Job(Claim),
}

impl Held {
    /// The board.
    const fn lease(&self) -> &Lease {
        match self {
            Self::Board(lease) | Self::Job(Claim { lease, .. }) => lease,
        }
    }

    fn renew(&self, plant: &mut Plant) -> Result<bool, StoreError> {
        match self {
            Self::Board(lease) => plant.renew(lease),
            Self::Job(claim) => plant.renew_claim(claim),
        }
    }
}

/// Why something is not held any more.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Lost {
    /// The station has lost the board: its lease ran out, a person took the board out, or the job was cancelled.
    #[error(
        "the board {board} is not ours any more: it was taken out, its job was cancelled, or nothing was heard of \
         this station for too long"
    )]
    Taken {
        /// The board.
        board: String,
    },
    /// The plant could not be reached for so long that somebody else may have the board.
    #[error(
        "the plant was not reached for {seconds} s, and somebody else may have the board {board} by now ({said})"
    )]
    Unreached {
        /// The board.
        board: String,
        /// How long.
        seconds: u64,
        /// Why.
        said: String,
    },
}

/// Something that is held until this is dropped or ended, or until it is lost.
#[derive(Debug)]
pub struct Holding {
    known: Arc<Known>,
    /// Ends the thread when it is dropped.
    stop: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Holding {
    /// Renews what is held from now on.
    #[must_use]
    pub fn begin(plant: PlantLink, held: Held) -> Self {
        let (stop, stopped) = mpsc::channel::<()>();
        let known = Arc::new(Known::of(held.lease()));
        let noted = Arc::clone(&known);
        let renew = move || {
            if renew(&plant.hasty(), &held, &noted, &stopped) && !noted.runs_out.load(Ordering::Relaxed) {
                give_back(&plant, &held);
            }
        };
        let thread = thread::Builder::new().name("lease".to_owned()).spawn(move || {
            if let Err(fault) = guarded(renew) {
                tracing::error!("{fault}");
            }
        });
        if thread.is_err() {
            known.note("the system has no thread that renews it; end other programs".to_owned());
        }
        Self { known, stop: Some(stop), thread: thread.ok() }
    }

    /// Whether it is lost.
    #[must_use]
    pub fn is_lost(&self) -> bool {
        self.lost().is_some()
    }

    /// Why it is lost, if it is.
    #[must_use]
    pub fn lost(&self) -> Option<Lost> {
        self.known.lost()
    }

    /// Gives the board back.
    pub fn end(self) {}

    /// Holds the board until its lease runs out, so that nobody gets it before that.
    pub(super) fn run_out(self) {
        self.known.runs_out.store(true, Ordering::Relaxed);
    }
}

impl Drop for Holding {
    fn drop(&mut self) {
        self.stop = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// What is known of something that is held. The mere passing of time loses it, since the thread that renews it may be stuck in a
/// question.
#[derive(Debug)]
struct Known {
    board: String,
    is_taken: AtomicBool,
    /// Whether it is not given back.
    runs_out: AtomicBool,
    renewed: Mutex<Renewed>,
}

#[derive(Debug)]
struct Renewed {
    since: Moment,
    /// Why it was not renewed since then.
    said: String,
}

impl Known {
    fn of(Lease { board, since, .. }: &Lease) -> Self {
        let renewed = Mutex::new(Renewed { since: *since, said: "it does not answer".to_owned() });
        let [is_taken, runs_out] = [false; 2].map(AtomicBool::new);
        Self { board: board.clone(), is_taken, runs_out, renewed }
    }

    fn lost(&self) -> Option<Lost> {
        let board = self.board.clone();
        if self.is_taken.load(Ordering::Relaxed) {
            return Some(Lost::Taken { board });
        }
        let Renewed { since, said } = &*self.renewed.lock();
        let passed = since.elapsed();
        (passed + ENDS >= HELD).then(|| Lost::Unreached {
            board,
            seconds: passed.as_secs(),
            said: said.clone(),
        })
    }

    /// Notes that it was still held after `since`.
    fn renew(&self, since: Moment) {
        self.renewed.lock().since = since;
    }

    fn note(&self, said: String) {
        self.renewed.lock().said = said;
    }
}

/// Renews what is held until it is stopped or lost; returns whether the board is to be given back: it is held even when its job is
/// not any more. If the plant is away for too long, the lease ends by itself.
fn renew(plant: &PlantLink, held: &Held, known: &Known, stopped: &Receiver<()>) -> bool {
    let mut wait = RENEWED;
    while stopped.recv_timeout(wait) == Err(RecvTimeoutError::Timeout) {
        let asked = Moment::now();
        match plant.ask(|plant| held.renew(plant)) {
            Ok(true) => {
                known.renew(asked);
                wait = RENEWED;
            }
            Ok(false) => known.is_taken.store(true, Ordering::Relaxed),
            Err(error) => {
                known.note(Said::of(&error).to_string());
                wait = AGAIN;
            }
        }
        match known.lost() {
            None => {}
            Some(Lost::Unreached { .. }) => return false,
            Some(Lost::Taken { .. }) => {
                // Its lane may still use it until then.
                let _ = stopped.recv();
                break;
            }
        }
    }
    true
}

fn give_back(plant: &PlantLink, held: &Held) {
    if let Err(error) = plant.ask(|plant| plant.give_back(held.lease())) {
        tracing::warn!(
            "the board {} is free when its lease has run out: {}",
            held.lease().board,
            Said::of(&error).with_codes()
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Something that was last renewed this long ago.
    fn renewed(ago: Duration) -> Known {
        let since = Moment::ago(ago);
        let renewed = Mutex::new(Renewed { since, said: "no route to host".to_owned() });
        let [is_taken, runs_out] = [false; 2].map(AtomicBool::new);
        Known { board: "shelf-1".to_owned(), is_taken, runs_out, renewed }
    }

    /// The thread that renews it may be stuck in a question, and so may not note that it is lost.
    #[test]
    fn time_alone_loses_what_is_held_before_somebody_else_may_have_it() {
        let lost = renewed(HELD.checked_sub(ENDS).unwrap()).lost().unwrap();
        assert!(
            matches!(&lost, Lost::Unreached { seconds: 26, said, .. } if said == "no route to host"),
            "{lost:?}"
        );
        let held = renewed(RENEWED);
        assert_eq!(held.lost(), None);
        held.renew(Moment::now());
        held.is_taken.store(true, Ordering::Relaxed);
        assert_eq!(held.lost(), Some(Lost::Taken { board: "shelf-1".to_owned() }));
    }
}
