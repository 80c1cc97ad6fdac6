//! A board in this process as a link: on its pipe's virtual clock, or paced as a real one would be.

use std::time::Duration;

use halfrow_pipe::{Broken, Endpoint, Pipe};

use super::{Link, LinkError};

/// A pipe to a board in this process.
#[derive(Debug)]
pub struct WireLink<B: Endpoint> {
    pipe: Pipe<B>,
    board: &'static str,
    paced: bool,
}

impl<B: Endpoint> WireLink<B> {
    /// A link over `pipe` to what is called `board`; `paced` lets its clock run as fast as the wall's and no faster.
    #[must_use]
    pub fn new(pipe: Pipe<B>, board: &'static str, paced: bool) -> Self {
        Self { pipe, board, paced }
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
        let moved = self.pipe.exchange(outgoing, incoming, wait);
        if self.paced {
            std::thread::sleep(self.pipe.now().saturating_sub(before));
        }
        moved.map_err(|broken| match broken {
            Broken::Disconnected { .. } => LinkError::Closed { link: self.name(), at: self.now() },
            Broken::Board { failure, .. } => {
                LinkError::Stopped { board: self.board, at: self.now(), source: Box::new(failure) }
            }
        })
    }

    fn now(&self) -> Duration {
        self.pipe.now()
    }

    fn bytes_per_second(&self) -> Option<f64> {
        self.pipe.bytes_per_second()
    }

    fn name(&self) -> String {
        let (board, clock) = (self.board, if self.paced { "paced" } else { "virtual clock" });
        match self.pipe.bytes_per_second() {
            Some(rate) => format!("{board}'s wire ({rate:.0} bytes/s, {clock})"),
            None => format!("{board}'s wire (unlimited, {clock})"),
        }
    }
}
