//! What the engine knows about what its lanes owe their shift, and for how long.

use std::time::{Duration, Instant};

/// How long to wait before asking again what a lane owes when that could not be found out: a store in trouble takes
/// its time to say so, and other lanes wait for it.
const REST: Duration = Duration::from_secs(1);

/// What is known about what a lane owes its shift.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Known {
    /// It was not asked for yet.
    Nothing,
    /// Known to hold between these moments, in milliseconds since 1970; a clock that was set back is outside them.
    Between(i64, i64),
    /// It could not be found out at this moment.
    Untold(Instant),
}

impl Known {
    /// Whether it is to be asked for.
    pub(super) fn is_due(self, now_ms: i64, now: Instant) -> bool {
        match self {
            Self::Nothing => true,
            Self::Between(since_ms, until_ms) => now_ms < since_ms || now_ms > until_ms,
            Self::Untold(since) => now.saturating_duration_since(since) >= REST,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_could_not_be_told_is_not_asked_for_before_every_scan() {
        let now = Instant::now();
        let known = Known::Untold(now);
        assert!(!known.is_due(0, now) && !known.is_due(i64::MAX, now + REST / 2));
        assert!(known.is_due(0, now + REST), "though the clock was set back");
    }

    #[test]
    fn what_is_owed_is_asked_for_again_when_its_time_is_over_or_the_clock_was_set_back() {
        let due = [2, 3, 5, 6].map(|now_ms| Known::Between(3, 5).is_due(now_ms, Instant::now()));
        assert_eq!(due, [true, false, false, true]);
    }
}
