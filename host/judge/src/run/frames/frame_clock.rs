//! The time that frames take, without the times for which their stream is broken off.

use std::mem;
use std::time::{Duration, Instant};

/// The time since the last whole frame.
pub(super) struct FrameClock {
    /// When that frame came back or the stream began again; none while it is broken off.
    since: Option<Instant>,
    /// How long the stream had run before that.
    before: Duration,
}

impl FrameClock {
    pub(super) fn new() -> Self {
        Self { since: Some(Instant::now()), before: Duration::ZERO }
    }

    /// Leaves out what follows until the stream begins again.
    pub(super) fn pause(&mut self) {
        self.before += self.since.take().map_or(Duration::ZERO, |since| since.elapsed());
    }

    /// The stream begins again.
    pub(super) fn go_on(&mut self) {
        self.since = Some(Instant::now());
    }

    /// The seconds that the frame which is now done took; those of the next one begin.
    pub(super) fn lap(&mut self) -> f64 {
        let runs = self.since.is_some();
        self.pause();
        self.since = runs.then(Instant::now);
        mem::take(&mut self.before).as_secs_f64()
    }
}

#[cfg(test)]
mod tests {
    use std::thread;

    use super::*;

    #[test]
    fn an_outage_is_no_frame_s_time_and_what_was_before_it_is() {
        const TIME: Duration = Duration::from_millis(20);
        let begun = Instant::now();
        let mut clock = FrameClock::new();
        thread::sleep(TIME);
        clock.pause();
        thread::sleep(TIME);
        clock.go_on();
        let seconds = clock.lap() + clock.lap();
        let run = begun.elapsed() - TIME;
        assert!((TIME.as_secs_f64()..=run.as_secs_f64()).contains(&seconds), "{seconds}");
    }
}
