//! A host that is kept from running: its clock goes on, and so does the board, while nobody looks at the link.

use std::sync::{Mutex, MutexGuard};
use std::time::Duration;

use halfrow::link::{Link, LinkError};

/// What a kernel hands out in one read of a terminal.
const READ: usize = 4096;

/// A link whose host stands still for `pause` at every `every`-th look at the clock, which is where it may be interrupted.
pub struct LateHost {
    every: u32,
    pause: Duration,
    state: Mutex<State>,
}

struct State {
    link: Box<dyn Link>,
    looks: u32,
    /// What the board said while nobody read, as a kernel keeps it.
    came: Vec<u8>,
    failure: Option<LinkError>,
}

impl State {
    /// Lets time pass without the host.
    fn pass(&mut self, time: Duration) {
        let end = self.link.now() + time;
        while self.failure.is_none() && self.link.now() < end {
            let wait = end - self.link.now();
            self.failure = self.link.exchange(&[], &mut self.came, wait).err();
        }
    }
}

impl LateHost {
    /// `link`, which must be on a virtual clock, for such a host.
    #[must_use]
    pub fn new(link: Box<dyn Link>, every: u32, pause: Duration) -> Self {
        let state = Mutex::new(State { link, looks: 0, came: Vec::new(), failure: None });
        Self { every, pause, state }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap()
    }
}

impl Link for LateHost {
    fn exchange(
        &mut self,
        outgoing: &[u8],
        incoming: &mut Vec<u8>,
        wait: Duration,
    ) -> Result<usize, LinkError> {
        let mut state = self.state();
        let State { link, came, failure, .. } = &mut *state;
        if came.is_empty()
            && let Some(failure) = failure.take()
        {
            return Err(failure);
        }
        let wait = if came.is_empty() { wait } else { Duration::ZERO };
        let taken = match link.exchange(outgoing, came, wait) {
            Ok(taken) => taken,
            Err(error) if came.is_empty() => return Err(error),
            Err(error) => {
                *failure = Some(error);
                0
            }
        };
        let read = came.len().min(READ);
        incoming.extend(came.drain(..read));
        Ok(taken)
    }

    fn now(&self) -> Duration {
        let mut state = self.state();
        state.looks += 1;
        if state.looks.is_multiple_of(self.every) {
            state.pass(self.pause);
        }
        state.link.now()
    }

    fn bytes_per_second(&self) -> Option<f64> {
        self.state().link.bytes_per_second()
    }

    fn name(&self) -> String {
        self.state().link.name()
    }
}
