//! The byte pipe to a board in this process, on a virtual clock. It has a speed, a delay, and deliberate faults.
//!
//! ```text
//! host ── exchange ─► Lane to the board ─► Endpoint::receive
//!          │           speed, delay,          │
//!          ◄────────── Lane to the host ◄─────┘ Endpoint::outgoing
//!                      damage by a fault
//! ```
//!
//! It is simulated event by event. The clock stands still while bytes can move; when none can, it jumps to the next
//! arrival. So a run takes only the real time that its computing takes, and has the same result every time.

mod catalogue;
mod chance;
mod damage;
mod endpoint;
mod fault;
mod lane;
mod meant;
mod options;
mod queue;
mod target;
mod value;

use std::time::Duration;

use damage::{Damage, Side};
use lane::Lane;
use queue::ByteQueue;

pub use catalogue::{Fault, FaultError, FaultInfo, Parameter, Parameters, Place, Range, Values};
pub use endpoint::Endpoint;
pub use fault::{FAULTS, PipeFault};
pub use meant::meant;
pub use options::PipeOptions;
pub use target::{BoardOptions, NoOptions, PipeSetup, TargetError};
pub use value::{Limits, ValueError, parse_word};

/// A pipe that carries nothing any more.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Broken<F> {
    /// The fault `disconnect` has struck.
    #[error("the wire broke at {:.3} s and stays broken; open a new one", at.as_secs_f64())]
    Disconnected {
        /// When it broke, on the pipe's clock.
        at: Duration,
    },
    /// The board has failed.
    #[error("the board stopped at {:.3} s", at.as_secs_f64())]
    Board {
        /// When, on the pipe's clock.
        at: Duration,
        /// Why.
        #[source]
        failure: F,
    },
}

/// A board and the byte pipe to it.
#[derive(Debug)]
pub struct Pipe<B: Endpoint> {
    board: B,
    options: PipeOptions,
    now: Duration,
    to_board: Lane,
    to_host: Lane,
    /// What the board has sent and the lane to the host has not accepted.
    unsent: ByteQueue,
    /// What reaches the board at one instant; kept to reuse its memory.
    arrived: Vec<u8>,
    broken: Option<Broken<B::Failure>>,
}

impl<B: Endpoint> Pipe<B> {
    /// A pipe to `board`, which is switched on now: the clock starts at 0.
    #[must_use]
    pub fn new(board: B, options: PipeOptions, fault: Option<PipeFault>) -> Self {
        let lane = |side| Lane::new(&options, Damage::new(fault, side));
        Self {
            to_board: lane(Side::Board),
            to_host: lane(Side::Host),
            board,
            options,
            now: Duration::ZERO,
            unsent: ByteQueue::default(),
            arrived: Vec::new(),
            broken: None,
        }
    }

    /// Moves bytes both ways: takes from the front of `outgoing` what the pipe accepts, and appends to `incoming` what
    /// has arrived. Returns the number of bytes taken as soon as a byte has moved either way, or 0 if none has moved
    /// once `wait` has passed on the virtual clock.
    ///
    /// # Errors
    /// [`Broken`] once the pipe is broken. The call in which it breaks still returns the bytes that moved; the next
    /// one fails.
    pub fn exchange(
        &mut self,
        outgoing: &[u8],
        incoming: &mut Vec<u8>,
        wait: Duration,
    ) -> Result<usize, Broken<B::Failure>> {
        let deadline = self.now.saturating_add(wait);
        let before = incoming.len();
        loop {
            let taken = self.settle(outgoing, incoming);
            if taken > 0 || incoming.len() > before {
                return Ok(taken);
            }
            if let Some(broken) = &self.broken {
                return Err(broken.clone());
            }
            match self.next_arrival().filter(|&arrival| arrival <= deadline) {
                Some(arrival) => self.now = arrival,
                None => {
                    self.now = deadline;
                    return Ok(0);
                }
            }
        }
    }

    /// The virtual clock: time since the board was switched on.
    #[must_use]
    pub fn now(&self) -> Duration {
        self.now
    }

    /// Bytes per second that either direction carries; none for a pipe without a limit.
    #[must_use]
    pub fn bytes_per_second(&self) -> Option<f64> {
        self.options.speed.map(|speed| speed.get() as f64)
    }

    /// Moves all that can move at this instant. Returns the number of bytes taken.
    fn settle(&mut self, outgoing: &[u8], incoming: &mut Vec<u8>) -> usize {
        let before = incoming.len();
        let mut rest = outgoing;
        while self.broken.is_none() {
            let accepted =
                if self.accepts(incoming.len() > before) { self.to_board.accept(rest, self.now) } else { 0 };
            rest = &rest[accepted..];
            if accepted + self.carry(incoming) == 0 {
                break;
            }
        }
        outgoing.len() - rest.len()
    }

    /// Whether the host may send at all. A pipe without a buffer takes nothing while the board has something to send, or
    /// when something was `heard` in this call: the host gets that only when the call returns.
    fn accepts(&self, heard: bool) -> bool {
        self.options.buffer > 0 || !heard && self.unsent.is_empty() && self.to_host.is_empty()
    }

    /// Hands over what has arrived on either side, and puts what the board sends on its lane. Returns how many bytes
    /// moved, summed over the three steps; 0 when nothing moved.
    fn carry(&mut self, incoming: &mut Vec<u8>) -> usize {
        self.arrived.clear();
        let to_board = self.to_board.deliver(self.now, &mut self.arrived);
        if !self.arrived.is_empty() {
            let received = self.board.receive(&self.arrived, self.now);
            self.broken = received.err().map(|failure| Broken::Board { at: self.now, failure });
        }
        self.unsent.take_over(self.board.outgoing());
        let sent = self.to_host.accept(self.unsent.as_slice(), self.now);
        self.unsent.consume(sent);
        let to_host = self.to_host.deliver(self.now, incoming);
        if to_board.broken || to_host.broken {
            self.broken.get_or_insert(Broken::Disconnected { at: self.now });
        }
        to_board.bytes + sent + to_host.bytes
    }

    fn next_arrival(&self) -> Option<Duration> {
        self.to_board.next_arrival().into_iter().chain(self.to_host.next_arrival()).min()
    }
}
