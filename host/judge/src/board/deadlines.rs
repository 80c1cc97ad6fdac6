//! Every deadline and every retry, in one table.

use std::time::Duration;

/// What a host waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// The reply to HELLO: the peer may be a chip that has just been powered, with stale bytes in its buffers.
    Hello,
    /// The reply to any other request. Reading a table back takes a board some 2,000 clocks.
    Request,
    /// The next row: the board plays it in some 3,000 clocks.
    Row,
}

/// How long a step may take beyond the time that its bytes need, and how often it is tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Deadline {
    /// For the board and the chips in between: a USB serial chip holds short packets for 16 ms, a hub may take as long.
    pub fixed: Duration,
    /// Tries in all, the first included.
    pub attempts: u32,
}

impl Step {
    /// The table.
    #[must_use]
    pub const fn deadline(self) -> Deadline {
        let (milliseconds, attempts) = match self {
            Self::Hello => (300, 6),
            Self::Request => (200, 8),
            Self::Row => (250, 8),
        };
        Deadline { fixed: Duration::from_millis(milliseconds), attempts }
    }

    /// How long to wait when `bytes` have to travel, both ways together, over a link of `bytes_per_second`. Twice the time
    /// on the wire is given, since chips and kernels queue. A link that does not know its rate is taken for a slow one.
    #[must_use]
    pub fn wait(self, bytes: usize, bytes_per_second: Option<f64>) -> Duration {
        const SLOW: f64 = 100_000.0;
        let rate = bytes_per_second.unwrap_or(SLOW).max(1.0);
        self.deadline().fixed + Duration::from_secs_f64(2.0 * bytes as f64 / rate)
    }
}

/// How many packets may be sent again before a link is too poor to judge a board over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RetryLimit {
    /// Retries that any run may have, for the noise of plugging in.
    pub fixed: u64,
    /// And of the packets sent, this share.
    pub share: f64,
}

impl Default for RetryLimit {
    /// 16 and 5 %.
    fn default() -> Self {
        Self { fixed: 16, share: 0.05 }
    }
}

impl RetryLimit {
    /// The most retries among `packets` packets.
    #[must_use]
    pub fn of(self, packets: u64) -> u64 {
        self.fixed + (packets as f64 * self.share) as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_deadline_grows_with_its_bytes() {
        // 2,922 bytes both ways at 1.2 MB/s are 4.87 ms, twice that is 9.74 ms.
        let wait = Step::Row.wait(5844, Some(1.2e6));
        assert_eq!(wait.as_micros(), 250_000 + 9_740);
        assert_eq!(Step::Request.wait(5000, None).as_millis(), 200 + 100);
    }

    #[test]
    fn the_retry_limit_is_a_share_beyond_a_fixed_number() {
        assert_eq!(RetryLimit::default().of(0), 16);
        assert_eq!(RetryLimit::default().of(1000), 66);
    }
}
