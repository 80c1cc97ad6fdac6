//! A host that is kept from running: its clock and the board go on while nobody serves the link.

use std::sync::{Mutex, MutexGuard};
use std::time::Duration;

use halfrow::link::{Link, LinkError};

/// The most that a kernel returns in one read of a terminal.
const READ: usize = 4096;

/// A link whose host stands still for `pause` each time it reads the clock for the `every`-th time: a host may be interrupted
/// there.
pub struct LateHost {
    every: u32,
    pause: Duration,
    state: Mutex<State>,
}

struct State {
    link: Box<dyn Link>,
    looks: u32,
    /// What the board sent while nobody read, as a kernel buffers it.
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
    /// Such a host on `link`, which must have a virtual clock.
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
