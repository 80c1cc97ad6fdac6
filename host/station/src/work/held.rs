//! What is held at a plant: a thread renews it, and says when it is lost.

use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::sync::{Arc, OnceLock};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crate::guard::guarded;
use crate::said::Said;
use crate::store::{Claim, LEASE_MS, Lease, Plant, PlantAddress, StoreError};

/// How long it is held from the last time that it was renewed.
const HELD: Duration = Duration::from_millis(LEASE_MS.unsigned_abs());
/// How often it is renewed: three times as often as it must be.
const RENEWED: Duration = Duration::from_millis(LEASE_MS.unsigned_abs() / 3);
/// How soon it is tried again when the plant did not answer.
const AGAIN: Duration = Duration::from_secs(1);
/// What is ended needs so long until nothing is asked of the board any more.
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
    /// Somebody took it: the lease had run out, a person took the board out, or the job was cancelled.
    #[error(
        "the board {board} is not ours any more: it was taken out, its job cancelled, or it was not heard of us for too long"
    )]
    Taken {
        /// The board.
        board: String,
    },
    /// The plant was not reached for so long that somebody else may have it.
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

/// Something that is held until this is dropped or ended, or it is lost.
#[derive(Debug)]
pub struct Holding {
    lost: Arc<OnceLock<Lost>>,
    /// Dropped, it ends the thread.
    stop: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Holding {
    /// Renews what is held from now on, which it is since a moment ago.
    #[must_use]
    pub fn begin(address: PlantAddress, held: Held) -> Self {
        let (stop, stopped) = mpsc::channel::<()>();
        let lost = Arc::new(OnceLock::new());
        let noted = Arc::clone(&lost);
        let renew = move || {
            let mut plant = None;
            let (mut since, mut wait) = (Instant::now(), RENEWED);
            while stopped.recv_timeout(wait) == Err(RecvTimeoutError::Timeout) {
                let asked = Instant::now();
                match renewed(&address, &held, &mut plant) {
                    Ok(true) => (since, wait) = (asked, RENEWED),
                    Ok(false) => {
                        let _ = noted.set(Lost::Taken { board: held.lease().board.clone() });
                        return;
                    }
                    Err(error) => {
                        (plant, wait) = (None, AGAIN);
                        if since.elapsed() + ENDS >= HELD {
                            let (board, said) = (held.lease().board.clone(), Said::of(&error).to_string());
                            let seconds = since.elapsed().as_secs();
                            let _ = noted.set(Lost::Unreached { board, seconds, said });
                            return;
                        }
                    }
                }
            }
            give_back(&address, &held, plant);
        };
        let thread = thread::Builder::new().name("lease".to_owned()).spawn(move || {
            if let Err(fault) = guarded(renew) {
                tracing::error!("{fault}");
            }
        });
        if thread.is_err() {
            // Nothing renews it.
            let _ = lost.set(Lost::Unreached {
                board: String::new(),
                seconds: 0,
                said: "the system has no thread for it; end other programs".to_owned(),
            });
        }
        Self { lost, stop: Some(stop), thread: thread.ok() }
    }

    /// Whether it is lost.
    #[must_use]
    pub fn is_lost(&self) -> bool {
        self.lost.get().is_some()
    }

    /// Why it is lost, if it is.
    #[must_use]
    pub fn lost(&self) -> Option<Lost> {
        self.lost.get().cloned()
    }

    /// Gives it back.
    pub fn end(self) {}
}

impl Drop for Holding {
    fn drop(&mut self) {
        self.stop = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn renewed(address: &PlantAddress, held: &Held, plant: &mut Option<Plant>) -> Result<bool, StoreError> {
    let connected = match plant.take() {
        Some(plant) => plant,
        None => Plant::connect(address)?,
    };
    held.renew(plant.insert(connected))
}

fn give_back(address: &PlantAddress, held: &Held, plant: Option<Plant>) {
    let back = match plant {
        Some(mut plant) => plant.give_back(held.lease()),
        None => Plant::connect(address).and_then(|mut plant| plant.give_back(held.lease())),
    };
    if let Err(error) = back {
        tracing::warn!(
            "the board {} is free when its lease has run out: {}",
            held.lease().board,
            Said::of(&error)
        );
    }
}
