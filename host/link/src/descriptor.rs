//! A file descriptor that never blocks and is read and written in one call: what a serial port and a socket have in common.

use std::io;
use std::os::fd::RawFd;
use std::time::{Duration, Instant};

use nix::errno::Errno;
use nix::fcntl::{FcntlArg, OFlag, fcntl};
use nix::poll::{PollFd, PollFlags, poll};
use nix::unistd::{read, write};

/// Bytes taken in one read. A serial port returns 4 KiB at most, a socket as much as fits.
const CHUNK: usize = 64 * 1024;

/// Why nothing can be exchanged any more.
#[derive(Debug)]
pub enum Gone {
    /// The other end has hung up.
    HungUp,
    /// The system reports an error.
    Failed(io::Error),
}

/// Makes reads and writes return at once.
///
/// # Errors
/// The system's reason.
pub fn never_block(fd: RawFd) -> io::Result<()> {
    let flags = OFlag::from_bits_truncate(fcntl(fd, FcntlArg::F_GETFL)?);
    fcntl(fd, FcntlArg::F_SETFL(flags | OFlag::O_NONBLOCK))?;
    Ok(())
}

/// Moves bytes through a descriptor that does not block.
#[derive(Debug)]
pub struct Pump {
    chunk: Vec<u8>,
}

impl Default for Pump {
    fn default() -> Self {
        Self { chunk: vec![0; CHUNK] }
    }
}

impl Pump {
    /// Like [`Link::exchange`](super::Link::exchange). A signal ends the wait early, so that a request to stop is noticed.
    ///
    /// # Errors
    /// [`Gone`] when the other end is gone, or the system refuses.
    pub fn exchange(
        &mut self,
        fd: RawFd,
        outgoing: &[u8],
        incoming: &mut Vec<u8>,
        wait: Duration,
    ) -> Result<usize, Gone> {
        // None means no limit.
        let deadline = Instant::now().checked_add(wait);
        loop {
            let received = self.receive(fd, incoming)?;
            let taken = match send(fd, outgoing) {
                // What was received counts; the next call will fail again.
                Err(_) if received > 0 => 0,
                taken => taken?,
            };
            if received + taken > 0 {
                return Ok(taken);
            }
            let left = deadline.map_or(Duration::MAX, |end| end.saturating_duration_since(Instant::now()));
            if left.is_zero() || !is_ready(fd, !outgoing.is_empty(), left)? {
                return Ok(0);
            }
        }
    }

    /// Appends the bytes that have arrived, and returns their number.
    ///
    /// # Errors
    /// [`Gone`] when the other end is gone, or the system refuses.
    pub fn receive(&mut self, fd: RawFd, incoming: &mut Vec<u8>) -> Result<usize, Gone> {
        match read(fd, &mut self.chunk) {
            Ok(0) => Err(Gone::HungUp),
            Ok(received) => {
                incoming.extend_from_slice(&self.chunk[..received]);
                Ok(received)
            }
            Err(error) => nothing_yet(error),
        }
    }
}

/// Writes as many bytes as the descriptor takes, and returns their number.
///
/// # Errors
/// [`Gone`] when the other end is gone, or the system refuses.
pub fn send(fd: RawFd, outgoing: &[u8]) -> Result<usize, Gone> {
    if outgoing.is_empty() { Ok(0) } else { write(fd, outgoing).or_else(nothing_yet) }
}

fn nothing_yet(error: Errno) -> Result<usize, Gone> {
    match error {
        Errno::EAGAIN | Errno::EINTR => Ok(0),
        // A terminal that hung up returns EIO, and one whose device was pulled out ENXIO or ENODEV.
        Errno::EIO | Errno::EPIPE | Errno::ENXIO | Errno::ENODEV | Errno::ECONNRESET => Err(Gone::HungUp),
        error => Err(Gone::Failed(error.into())),
    }
}

/// Waits until there is something to read or, if `to_write`, room to write. Returns false when the time is over or a signal came.
///
/// # Errors
/// [`Gone`] when the other end is gone, or the system refuses.
pub fn is_ready(fd: RawFd, to_write: bool, wait: Duration) -> Result<bool, Gone> {
    let mut events = PollFlags::POLLIN;
    events.set(PollFlags::POLLOUT, to_write);
    let milliseconds = i32::try_from(wait.as_micros().div_ceil(1000)).unwrap_or(i32::MAX);
    match poll(&mut [PollFd::new(fd, events)], milliseconds) {
        Ok(ready) => Ok(ready > 0),
        Err(Errno::EINTR) => Ok(false),
        Err(error) => Err(Gone::Failed(error.into())),
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;
    use std::os::fd::AsRawFd as _;
    use std::os::unix::net::UnixStream;

    use super::*;

    #[test]
    fn whoever_would_wait_for_ever_gets_what_comes() {
        let (near, mut far) = UnixStream::pair().unwrap();
        never_block(near.as_raw_fd()).unwrap();
        far.write_all(b"here").unwrap();
        let mut incoming = Vec::new();
        let taken = Pump::default().exchange(near.as_raw_fd(), &[], &mut incoming, Duration::MAX).unwrap();
        assert_eq!((taken, incoming.as_slice()), (0, b"here".as_slice()));
    }

    #[test]
    fn what_came_before_the_other_end_hung_up_is_taken_before_that_is_said() {
        let (near, mut far) = UnixStream::pair().unwrap();
        never_block(near.as_raw_fd()).unwrap();
        far.write_all(b"last").unwrap();
        drop(far);
        let (mut pump, mut incoming) = (Pump::default(), Vec::new());
        let mut exchange =
            |incoming: &mut Vec<u8>| pump.exchange(near.as_raw_fd(), b"more", incoming, Duration::ZERO);
        assert_eq!(exchange(&mut incoming).unwrap(), 0);
        assert_eq!(incoming, b"last");
        assert!(matches!(exchange(&mut incoming), Err(Gone::HungUp)));
    }
}
