//! The mock board as a link: on its virtual clock, or paced as a real one would be.

use std::time::Duration;

use halfrow_mock::Wire;

use super::{Link, LinkError};

/// A pipe to a mock board in this process.
#[derive(Debug)]
pub struct MockLink {
    wire: Wire,
    paced: bool,
}

impl MockLink {
    /// A link over `wire`; `paced` lets its clock run as fast as the wall's and no faster.
    #[must_use]
    pub fn new(wire: Wire, paced: bool) -> Self {
        Self { wire, paced }
    }
}

impl Link for MockLink {
    fn exchange(
        &mut self,
        outgoing: &[u8],
        incoming: &mut Vec<u8>,
        wait: Duration,
    ) -> Result<usize, LinkError> {
        let before = self.wire.now();
        let moved = self.wire.exchange(outgoing, incoming, wait);
        if self.paced {
            std::thread::sleep(self.wire.now().saturating_sub(before));
        }
        moved.map_err(|_| LinkError::Closed { link: self.name(), at: self.now() })
    }

    fn now(&self) -> Duration {
        self.wire.now()
    }

    fn bytes_per_second(&self) -> Option<f64> {
        self.wire.bytes_per_second()
    }

    fn name(&self) -> String {
        let clock = if self.paced { "paced" } else { "virtual clock" };
        match self.wire.bytes_per_second() {
            Some(rate) => format!("the mock board's wire ({rate:.0} bytes/s, {clock})"),
            None => format!("the mock board's wire (unlimited, {clock})"),
        }
    }
}
