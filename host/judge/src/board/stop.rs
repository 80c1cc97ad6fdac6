//! What ends a run early: a signal, or the run's own time limit.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use super::BoardError;
use crate::verdict::Exit;

/// Asked between any two exchanges whether to go on.
#[derive(Clone, Debug, Default)]
pub struct Stop {
    signal: Arc<AtomicUsize>,
    limit: Option<Duration>,
    /// Of the limit, what had passed when the link's clock began.
    spent: Duration,
    /// The limit on this computer's clock, and since when it counts.
    wall: Option<(Instant, Duration)>,
}

impl Stop {
    /// Stops when `signal` holds an exit code other than 0, or when the link's clock has passed `limit`.
    #[must_use]
    pub fn new(signal: Arc<AtomicUsize>, limit: Option<Duration>) -> Self {
        Self { signal, limit, spent: Duration::ZERO, wall: None }
    }

    /// Stops also when `limit` from here on has passed on this computer's clock, which a board in this program or a
    /// recording does not keep to.
    #[must_use]
    pub fn within(self, limit: Option<Duration>) -> Self {
        Self { wall: limit.map(|limit| (Instant::now(), limit)), ..self }
    }

    /// The same for a link whose clock began when `spent` of the limit had passed.
    pub(crate) fn after(&self, spent: Duration) -> Self {
        Self { spent, ..self.clone() }
    }

    pub(crate) fn check(&self, now: Duration) -> Result<(), BoardError> {
        match self.signal.load(Ordering::Relaxed) {
            0 => {}
            code => return Err(BoardError::Stopped(Exit::of_signal(code).unwrap_or(Exit::Interrupted))),
        }
        if let Some((_, limit)) = self.wall.filter(|(begun, limit)| begun.elapsed() > *limit) {
            return Err(BoardError::Timeout { limit });
        }
        match self.limit {
            Some(limit) if self.spent + now > limit => Err(BoardError::Timeout { limit }),
            _ => Ok(()),
        }
    }
}
