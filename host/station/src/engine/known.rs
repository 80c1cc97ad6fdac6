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

/// What is known of a lane.
#[derive(Clone, Copy, Debug)]
pub(super) struct KnownOfLane {
    known: Known,
    /// When it was asked about last.
    asked: Option<Instant>,
}

impl KnownOfLane {
    /// A lane of which nothing is known.
    pub(super) const NOTHING: Self = Self { known: Known::Nothing, asked: None };

    /// Those of `lanes` that are to be asked about, first those that were not asked about for longest: lanes about which the store
    /// fails let every other one have its turn.
    pub(super) fn due<'a>(lanes: impl Iterator<Item = &'a Self>, now_ms: i64, now: Instant) -> Vec<usize> {
        let mut due: Vec<_> = lanes.enumerate().filter(|(_, of)| of.known.is_due(now_ms, now)).collect();
        due.sort_by_key(|(_, of)| of.asked);
        due.into_iter().map(|(lane, _)| lane).collect()
    }

    /// Notes what is known of it, after it was asked about just `now`.
    pub(super) fn told(&mut self, known: Known, now: Instant) {
        *self = Self { known, asked: Some(now) };
    }

    /// Notes that it was not asked about, since the store had just failed about another one.
    pub(super) fn passed_over(&mut self, now: Instant) {
        self.known = Known::Untold(now);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A store that answers about the lanes from `sound` on, and fails about those before; it is asked `every` so often for a minute,
    /// as [`KnownOfLane::due`] says. Returns after how many times each lane was known.
    fn turns(lanes: usize, sound: usize, every: Duration, first: &[usize]) -> Vec<Option<usize>> {
        let begun = Instant::now();
        let (mut of, mut known_at) = (vec![KnownOfLane::NOTHING; lanes], vec![None; lanes]);
        // What was asked about alone before is due at other times than the rest.
        first.iter().for_each(|lane| of[*lane].told(Known::Untold(begun), begun));
        for turn in 0..(60 * REST.as_millis() / every.as_millis()) as usize {
            let now = begun + REST / 2 + every * turn as u32;
            let mut has_failed = false;
            for lane in KnownOfLane::due(of.iter(), 0, now) {
                if has_failed {
                    of[lane].passed_over(now);
                } else if lane < sound {
                    has_failed = true;
                    of[lane].told(Known::Untold(now), now);
                } else {
                    known_at[lane].get_or_insert(turn);
                    of[lane].told(Known::Between(0, i64::MAX), now);
                }
            }
        }
        known_at
    }

    #[test]
    fn lanes_about_which_the_store_fails_keep_no_other_one_from_its_turn() {
        // Two turns in a REST.
        let every = REST / 2;
        for first in [&[][..], &[0], &[1], &[0, 1]] {
            let known_at = turns(5, 2, every, first);
            assert_eq!(known_at[..2], [None, None], "{first:?}");
            let late = known_at[2..].iter().filter(|at| at.is_none_or(|at| at > 4)).count();
            assert_eq!(late, 0, "{first:?}: {known_at:?}");
        }
    }

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
