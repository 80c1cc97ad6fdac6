//! How long a link holds answers back, as far as a run has seen.

use std::time::Duration;

use super::deadlines::Step;

/// After so many tries in vain an answer that comes is taken for late rather than lost: three losses in a row are rare.
const SELDOM_LOST: u32 = 3;
/// So many prompt answers in a row refute that: copies of late requests would have been answered too.
const PROMPT: u32 = 16;

/// The longest that an answer was held back which had to be asked for again.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Lateness {
    /// If every copy of the request was answered.
    known: Duration,
    /// If some copies may have been lost.
    guessed: Duration,
    /// Prompt answers in a row.
    prompt: u32,
}

impl Lateness {
    /// The first answer came `took` after its request, and another one followed: nothing was lost.
    pub(super) fn note_needless(&mut self, took: Duration) {
        self.known = self.known.max(took);
    }

    /// An answer came after `time`; its request had been repeated `again` times.
    pub(super) fn note_duration(&mut self, again: u32, time: Duration) {
        let is_prompt = again == 0 && time < Step::Request.deadline().fixed;
        self.prompt = if is_prompt { self.prompt.saturating_add(1) } else { 0 };
        if again >= SELDOM_LOST {
            self.guessed = self.guessed.max(time);
        } else if self.prompt >= PROMPT {
            self.guessed = Duration::ZERO;
        }
    }

    /// How long an answer may be held back.
    pub(super) fn longest(&self) -> Duration {
        self.known.max(self.guessed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_seems_late_is_late_until_answers_come_at_once() {
        let (mut late, long) = (Lateness::default(), Duration::from_secs(3));
        late.note_duration(2, long);
        assert_eq!(late.longest(), Duration::ZERO);
        late.note_duration(3, long);
        for _ in 1..PROMPT {
            late.note_duration(0, Duration::ZERO);
        }
        assert_eq!(late.longest(), long);
        late.note_duration(1, Duration::ZERO);
        (1..PROMPT).for_each(|_| late.note_duration(0, Duration::ZERO));
        assert_eq!(late.longest(), long, "one that was not, begins anew");
        late.note_duration(0, Duration::ZERO);
        assert_eq!(late.longest(), Duration::ZERO);
    }

    #[test]
    fn what_is_known_to_be_late_stays_so() {
        let (mut late, long) = (Lateness::default(), Duration::from_secs(3));
        late.note_needless(long);
        (0..10 * PROMPT).for_each(|_| late.note_duration(0, Duration::ZERO));
        assert_eq!(late.longest(), long);
    }
}
