//! What ends a run early: whoever began it, or the run's own time limit.

use std::fmt;
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::BoardError;
use crate::verdict::StoppedBy;

/// Asked between any two exchanges whether to go on.
#[derive(Clone, Default)]
pub struct Stop {
    asked: Option<Arc<Asked>>,
    limit: Option<Duration>,
    /// Of the limit, what had passed when the link's clock began.
    spent: Duration,
    /// The limit on this computer's clock, and since when it counts.
    wall: Option<(Instant, Duration)>,
}

type Asked = dyn Fn() -> Option<StoppedBy> + Send + Sync;

impl Stop {
    /// Stops as soon as `asked` says who wants it to. It is asked often, and so must be quick, as a look at an atomic is.
    #[must_use]
    pub fn when(asked: impl Fn() -> Option<StoppedBy> + Send + Sync + 'static) -> Self {
        Self { asked: Some(Arc::new(asked)), ..Self::default() }
    }

    /// Stops as well when the link's clock has passed `limit`, if there is one.
    #[must_use]
    pub fn link_limit(self, limit: Option<Duration>) -> Self {
        Self { limit, ..self }
    }

    /// Stops also when `limit` from here on has passed on this computer's clock, which a board in this program or a
    /// recording does not keep to.
    #[must_use]
    pub fn wall_limit(self, limit: Option<Duration>) -> Self {
        Self { wall: limit.map(|limit| (Instant::now(), limit)), ..self }
    }

    /// The same for a link whose clock began when `spent` of the limit had passed.
    pub(crate) fn after(&self, spent: Duration) -> Self {
        Self { spent, ..self.clone() }
    }

    /// Whether to go on at `now`, when nothing has come for `silent`.
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
