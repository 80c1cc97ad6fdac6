//! A board in this program for other programs, behind a pseudo-terminal or a TCP port.
//!
//! ```text
//! other program ── pseudo-terminal or connection ──► Hosted ──► Link ──► mock or simulated board
//! ```
//!
//! The board's clock is virtual. It is kept at real time, so that speed and silences are real.

mod pty;
mod tcp;
#[cfg(test)]
mod tests;

use std::os::fd::AsRawFd;
use std::time::{Duration, Instant};

use crate::exit::Exit;
use halfrow::link::descriptor::{Gone, Pump, is_ready, send};
use halfrow::link::{Link, LinkError, OpenError, open};
use halfrow::target::Target;
use halfrow_protocol::Decoder;

pub use pty::{Name, Pty};
pub use tcp::{NoTcpPlace, Port, TcpPlace};

/// How many bytes may wait in either direction before the sender has to wait.
const QUEUE: usize = 64 * 1024;
/// How often a board is served that has moved bytes recently, since more may be under way on its wire.
const BUSY_TICK: Duration = Duration::from_millis(1);
/// How often on a wire with a speed, for which [`BUSY_TICK`] would be too coarse.
const PACED_TICK: Duration = Duration::from_micros(100);
/// How often at other times.
const IDLE_TICK: Duration = Duration::from_millis(20);
/// How long after its last byte a board counts as busy.
const BUSY: Duration = Duration::from_secs(1);

/// A board that cannot be served any more.
#[derive(Debug, thiserror::Error)]
pub enum ServeError {
    /// The place where the board is to be served cannot be opened.
    #[error("{what} cannot be made; choose another one")]
    Door {
        /// Which door.
        what: String,
        /// Why.
        #[source]
        source: std::io::Error,
    },
    /// The link to the served board cannot be made, because something of that name exists.
    #[error("{0} is there already; remove it, or choose another name with --link")]
    Exists(std::path::PathBuf),
    /// The link to the served board would have a name that no target can have.
    #[error("no target can name {0}, since a comma ends a path there; choose another name with --link")]
    Unnameable(std::path::PathBuf),
    /// The board that was being served is gone.
    #[error("the board that was served is gone; check its cable and power, then serve it again")]
    Board(#[source] LinkError),
}

impl ServeError {
    /// The exit code of a command that ends with it.
    #[must_use]
    pub fn exit(&self) -> Exit {
        match self {
            Self::Exists(_) | Self::Unnameable(_) => Exit::Usage,
            Self::Door { .. } | Self::Board(_) => Exit::Error,
        }
    }
}

/// What a served board has moved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Traffic {
    /// Bytes from the host.
    pub to_board: u64,
    /// Bytes to the host.
    pub to_host: u64,
    /// When the last whole packet came from the present host.
    pub heard: Option<Instant>,
}

/// Why a host is no longer served.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Left {
    /// It hung up.
    Host,
    /// `ended` said so.
    Ended,
}

/// A board with the bytes on their way to it and from it.
pub struct Hosted {
    link: Box<dyn Link>,
    /// When the board's clock was 0.
    switched_on: Instant,
    pump: Pump,
    to_board: Vec<u8>,
    to_host: Vec<u8>,
    traffic: Traffic,
    moved_at: Instant,
    /// Decodes what the present host sends.
    said: Decoder,
}

impl Hosted {
    /// The board that `target` names, switched on now.
    ///
    /// # Errors
    /// [`OpenError`], like [`open`].
    pub fn open(target: &Target) -> Result<Self, OpenError> {
        let mut target = target.clone();
        // The board is kept at real time here: a link that also sleeps would never catch up.
        target.options.retain(|(key, value)| (key.as_str(), value.as_str()) != ("pace", "real"));
        Ok(Self::new(open(&target)?.link))
    }

    /// The board at the end of `link`, switched on now.
    #[must_use]
    pub fn new(link: Box<dyn Link>) -> Self {
        let now = Instant::now();
        Self {
            switched_on: now.checked_sub(link.now()).unwrap_or(now),
            link,
            pump: Pump::default(),
            to_board: Vec::new(),
            to_host: Vec::new(),
            traffic: Traffic::default(),
            moved_at: now,
            said: Decoder::new(),
        }
    }

    /// Passes bytes between the host at `door` and the board, until the host hangs up or `ended` says so. The next host
    /// finds the board as this one left it.
    ///
    /// # Errors
    /// [`ServeError::Board`] when the board is gone.
    pub(crate) fn attend(
        &mut self,
        door: &impl AsRawFd,
        ended: &mut dyn FnMut(Traffic) -> bool,
    ) -> Result<Left, ServeError> {
        (self.said, self.traffic.heard) = (Decoder::new(), None);
        loop {
            if ended(self.traffic) {
                return self.leave(Left::Ended);
            }
            // The board's clock stands while no host is served, and must be at real time for what comes now.
            self.run_board()?;
            let before = self.traffic;
            if self.listen(door).and_then(|()| self.speak(door)).is_err() {
                return self.leave(Left::Host);
            }
            self.run_board()?;
            if self.traffic != before {
                self.moved_at = Instant::now();
            } else if self.to_host.is_empty() || self.speak(door).is_ok_and(|()| self.traffic == before) {
                self.wait(door);
            }
        }
    }

    /// What the host sent last still reaches the board; answers that it did not wait for are dropped.
    fn leave(&mut self, why: Left) -> Result<Left, ServeError> {
        self.run_board()?;
        self.to_board.clear();
        self.to_host.clear();
        Ok(why)
    }

    fn wait(&self, door: &impl AsRawFd) {
        let is_busy = self.moved_at.elapsed() < BUSY;
        if is_busy && self.link.bytes_per_second().is_some() {
            std::thread::sleep(PACED_TICK);
            return;
        }
        let tick = if is_busy { BUSY_TICK } else { IDLE_TICK };
        // If the door is gone, the next attempt to use it shows that.
        let _ = is_ready(door.as_raw_fd(), !self.to_host.is_empty(), tick);
    }

    fn listen(&mut self, door: &impl AsRawFd) -> Result<(), Gone> {
        if self.to_board.len() < QUEUE {
            let old = self.to_board.len();
            self.traffic.to_board += self.pump.receive(door.as_raw_fd(), &mut self.to_board)? as u64;
            self.hear(old);
        }
        Ok(())
    }

    /// Notes the time if there is a whole packet in what the host sent after the first `old` bytes.
    fn hear(&mut self, old: usize) {
        let mut bytes = &self.to_board[old..];
        while let Some(packet) = self.said.next(&mut bytes) {
            if packet.is_ok() {
                self.traffic.heard = Some(Instant::now());
            }
        }
    }

    fn speak(&mut self, door: &impl AsRawFd) -> Result<(), Gone> {
        let sent = send(door.as_raw_fd(), &self.to_host)?;
        self.to_host.drain(..sent);
        self.traffic.to_host += sent as u64;
        Ok(())
    }

    /// Lets the board do everything that it could have done by now.
    fn run_board(&mut self) -> Result<(), ServeError> {
        while self.to_host.len() < QUEUE {
            let behind = self.switched_on.elapsed().saturating_sub(self.link.now());
            let before = self.to_host.len();
            let exchanged = self.link.exchange(&self.to_board, &mut self.to_host, behind);
            let taken = exchanged.map_err(ServeError::Board)?;
            self.to_board.drain(..taken);
            if taken == 0 && self.to_host.len() == before {
                break;
            }
        }
        Ok(())
    }
}
