//! Every deadline and how often each is tried, in one table.

use std::time::Duration;

/// What a host waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// The reply to HELLO: the peer may be a chip that was just powered, with stale bytes in its buffers, or no board.
    Hello,
    /// The reply to any other request. The slowest, COMMIT and TABLE_WRITE of the longest tables, take the Verilog of this project
    /// 28,000 clocks (WIRE.md, "Reply times").
    Request,
    /// The next row: the board plays it in about 3,000 clocks.
    Row,
    /// The reply to the RESET that ends a session: somebody is waiting for the program to end.
    Close,
    /// A reply that only tells whether the board is still there.
    Probe,
}

/// How long a step may take in addition to the time that its bytes need, and how often it is tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Deadline {
    /// For the board and the chips in between: a USB serial chip holds short packets for 16 ms, and a hub may take as long.
    pub fixed: Duration,
    /// The wait doubles from try to try up to this: what is not answered may be lost, or wait in a queue that does not move.
    pub longest: Duration,
    /// Tries in all, the first included.
    pub attempts: u32,
}

/// The longest wait for an answer that a link is known to hold back. With it the third try comes before a board gives up a host
/// that is silent for 10 s.
const LONGEST: Duration = Duration::from_millis(4800);

impl Step {
    /// The table. Except for HELLO and closing, the tries outlast a link that stands still for 10 s, after which another host may
    /// have the board.
    #[must_use]
    pub const fn deadline(self) -> Deadline {
        let (fixed, longest, attempts) = match self {
            Self::Hello => (300, 300, 6),
            Self::Request => (200, 2000, 8),
            Self::Row => (250, 2000, 8),
            Self::Close => (200, 200, 8),
            Self::Probe => (200, 200, 1),
        };
        Deadline { fixed: Duration::from_millis(fixed), longest: Duration::from_millis(longest), attempts }
    }

    /// How long to wait at the try `attempt`, from 0, when `bytes` have to travel, both ways together, over a link of
    /// `bytes_per_second` that has held an answer back for `slowest`. The time on the wire is doubled, since chips and kernels
    /// queue. A link with an unknown rate is taken for a slow one.
    #[must_use]
    pub fn wait(
        self,
        attempt: u32,
        bytes: usize,
        bytes_per_second: Option<f64>,
        slowest: Duration,
    ) -> Duration {
        const SLOW: f64 = 100_000.0;
        let Deadline { fixed, longest, .. } = self.deadline();
        let grown = fixed.saturating_mul(1 << attempt.min(16)).min(longest);
        let known = slowest.saturating_mul(3) / 2;
        let rate = bytes_per_second.unwrap_or(SLOW).max(1.0);
        grown.max(known.min(LONGEST)) + Duration::from_secs_f64(2.0 * bytes as f64 / rate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NEVER: Duration = Duration::ZERO;

    #[test]
    fn a_deadline_grows_with_its_bytes() {
        // 2,922 bytes each way at 1.2 MB/s take 4.87 ms; twice that is 9.74 ms.
        let wait = Step::Row.wait(0, 5844, Some(1.2e6), NEVER);
        assert_eq!(wait.as_micros(), 250_000 + 9_740);
        assert_eq!(Step::Request.wait(0, 5000, None, NEVER).as_millis(), 200 + 100);
    }

    #[test]
    fn all_tries_together_outlast_ten_seconds_of_silence() {
        let in_all = |step: Step| (0..step.deadline().attempts).map(|n| step.wait(n, 0, None, NEVER)).sum();
        let [row, request, hello, close]: [Duration; 4] =
            [Step::Row, Step::Request, Step::Hello, Step::Close].map(in_all);
        assert_eq!((row.as_millis(), request.as_millis()), (11_750, 11_000));
        assert_eq!((hello.as_millis(), close.as_millis()), (1800, 1600));
    }

    #[test]
    fn a_link_that_holds_answers_back_is_given_half_as_long_again_but_not_for_ever() {
        let wait = |slowest| Step::Row.wait(0, 0, None, Duration::from_millis(slowest)).as_millis();
        assert_eq!([wait(100), wait(1000), wait(2000), wait(60_000)], [250, 1500, 3000, 4800]);
    }
}
