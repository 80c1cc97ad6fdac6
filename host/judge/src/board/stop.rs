//! What ends a run early: a request to stop, or the run's own time limit.

use std::fmt;
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::BoardError;
use crate::verdict::StoppedBy;

/// Asked between any two exchanges whether to go on.
#[derive(Clone, Default)]
pub struct Stop {
    asked: Option<Arc<StopCheck>>,
    limit: Option<Duration>,
    /// How much of the limit had passed when the link's clock began.
    spent: Duration,
    /// The start and length of the limit on this computer's clock.
    wall: Option<(Instant, Duration)>,
}

type StopCheck = dyn Fn() -> Option<StoppedBy> + Send + Sync;

impl Stop {
    /// Stops as soon as `asked` says who wants it to. It is called often and must be quick, such as a read of an atomic.
    #[must_use]
    pub fn when(asked: impl Fn() -> Option<StoppedBy> + Send + Sync + 'static) -> Self {
        Self { asked: Some(Arc::new(asked)), ..Self::default() }
    }

    /// Also stops when the link's clock has passed `limit`, if there is one.
    #[must_use]
    pub fn link_limit(self, limit: Option<Duration>) -> Self {
        Self { limit, ..self }
    }

    /// Also stops when `limit` from now on has passed on this computer's clock. The link's clock may run otherwise, as with a
    /// board in this process or a recording.
    #[must_use]
    pub fn wall_limit(self, limit: Option<Duration>) -> Self {
        Self { wall: limit.map(|limit| (Instant::now(), limit)), ..self }
    }

    /// The same for a link whose clock began when `spent` of the limit had passed.
    pub(crate) fn after(&self, spent: Duration) -> Self {
        Self { spent, ..self.clone() }
    }

    /// Whether to go on, as far as that can be told without a link: for a caller that waits for something other than its board.
    ///
    /// # Errors
    /// [`BoardError::Stopped`] and [`BoardError::Timeout`].
    pub fn check_wall(&self) -> Result<(), BoardError> {
        let silent = self.wall.map(|(begun, _)| begun.elapsed());
        self.check(Duration::ZERO, silent.unwrap_or_default())
    }

    /// Whether to go on at `now`, when nothing has come for the time `silent`.
    pub(crate) fn check(&self, now: Duration, silent: Duration) -> Result<(), BoardError> {
        if let Some(by) = self.asked.as_ref().and_then(|asked| asked()) {
            return Err(BoardError::Stopped(by));
        }
        if let Some((_, limit)) = self.wall.filter(|(begun, limit)| begun.elapsed() > *limit) {
            return Err(BoardError::Timeout { limit, silent });
        }
        match self.limit {
            Some(limit) if self.spent + now > limit => Err(BoardError::Timeout { limit, silent }),
            _ => Ok(()),
        }
    }
}

impl fmt::Debug for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { asked, limit, spent, wall } = self;
        f.debug_struct("Stop")
            .field("is_asked", &asked.is_some())
            .field("limit", limit)
            .field("spent", spent)
            .field("wall", wall)
            .finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_counts_on_from_what_had_passed_when_a_link_was_opened_again() {
        let [one, two, eight, ten] = [1, 2, 8, 10].map(Duration::from_secs);
        let stop = Stop::default().link_limit(Some(ten)).after(eight);
        assert!(stop.check(two, Duration::ZERO).is_ok());
        let ended = stop.check(two + one, one);
        assert!(matches!(ended, Err(BoardError::Timeout { limit, silent }) if (limit, silent) == (ten, one)));
    }
}
