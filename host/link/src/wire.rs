//! A board in this process as a link, on its pipe's virtual clock or paced like a real one.

use std::error::Error;
use std::time::{Duration, Instant};

use halfrow_pipe::{Broken, Endpoint, Pipe};

use super::{HEED, Link, LinkError};

/// A pipe to a board in this process.
#[derive(Debug)]
pub struct WireLink<B: Endpoint> {
    pipe: Pipe<B>,
    board: &'static str,
    /// When the exchanged bytes would have passed over a real wire; none if the link is not paced.
    due: Option<Instant>,
}

/// How late a host may be while the wire stays busy: what chips and kernels buffer for it.
const BUFFERED: Duration = Duration::from_millis(10);

impl<B: Endpoint> WireLink<B> {
    /// A link over `pipe` to the board called `board`. If `paced`, its clock never runs faster than the wall's.
    #[must_use]
    pub fn new(pipe: Pipe<B>, board: &'static str, paced: bool) -> Self {
        Self { pipe, board, due: paced.then(Instant::now) }
    }
}

impl<B: Endpoint + Send> Link for WireLink<B>
where
    B::Failure: Send + Sync + 'static,
{
    fn exchange(
        &mut self,
        outgoing: &[u8],
        incoming: &mut Vec<u8>,
        wait: Duration,
    ) -> Result<usize, LinkError> {
        let before = self.pipe.now();
        let wait = if self.due.is_some() { wait.min(HEED) } else { wait };
        let moved = self.pipe.exchange(outgoing, incoming, wait);
        if let Some(due) = &mut self.due {
            let now = Instant::now();
            *due += self.pipe.now().saturating_sub(before);
            std::thread::sleep(due.saturating_duration_since(now));
            *due = (*due).max(now.checked_sub(BUFFERED).unwrap_or(now));
        }
        moved.map_err(|broken| match broken {
            Broken::Disconnected { .. } => LinkError::Closed { link: self.name(), at: self.now() },
            Broken::Board { failure, .. } => stopped(self.board, self.now(), Box::new(failure)),
        })
    }

    fn now(&self) -> Duration {
        self.pipe.now()
    }

    fn bytes_per_second(&self) -> Option<f64> {
        self.pipe.bytes_per_second()
    }

    fn name(&self) -> String {
        let (board, clock) = (self.board, if self.due.is_some() { "real time" } else { "simulated time" });
        match self.pipe.bytes_per_second() {
            Some(rate) => format!("{board}'s simulated link ({rate:.0} bytes/s, {clock})"),
            None => format!("{board}'s simulated link (no speed limit, {clock})"),
        }
    }
}

/// Why `board`, which is in this program, has stopped.
fn stopped(board: &'static str, at: Duration, source: Box<dyn Error + Send + Sync>) -> LinkError {
    // The board itself is well, and nobody needs to report it.
    #[cfg(feature = "sim")]
    if let Some(halfrow_sim::Failure::Trace(waveform)) = source.downcast_ref() {
        return waveform.clone().into();
    }
    LinkError::Stopped { board, at, source }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::open;

    /// Whatever else the computer does: on a wire that ran ahead, boards would be judged in less time than they take.
    #[test]
    fn a_paced_wire_is_never_ahead_of_the_wall() {
        let mut link = open(&"mock,pace=real,speed=20000".parse().unwrap()).unwrap().link;
        let (begun, mut incoming) = (Instant::now(), Vec::new());
        for _ in 0..20 {
            link.exchange(&[1; 50], &mut incoming, Duration::ZERO).unwrap();
            link.exchange(&[], &mut incoming, Duration::from_millis(4)).unwrap();
            assert!(begun.elapsed() + BUFFERED >= link.now(), "{:?}", link.now());
        }
        assert!(link.now() >= Duration::from_millis(50), "{:?}", link.now());
    }
}
