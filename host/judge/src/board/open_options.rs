//! How a session is opened.

use super::{RetryLimit, SessionIds, Stop};

/// How a session is opened.
#[derive(Clone, Debug, Default)]
pub struct OpenOptions {
    /// What tells its packets from those of another one.
    pub ids: SessionIds,
    /// What to do if another host holds the board.
    pub when_held: WhenHeld,
    /// After every stream, and after every request that was repeated, ask the board how many packets it received. This tells a
    /// packet that came twice from a lost one.
    pub counts: bool,
    /// How many packets may be sent again.
    pub retry_limit: RetryLimit,
    /// What ends the run early.
    pub stop: Stop,
}

/// What to do if another host holds the board.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WhenHeld {
    /// Leave the board to it. A board can have two links, so it may be there even if this program is the only one on this link.
    Leave,
    /// Take the board if this program is the only one on the link: then it is held by a run that was killed, as long as
    /// nobody has it over another link.
    #[default]
    TakeFromKilled,
    /// Take the board from whoever holds it.
    Take,
}

impl WhenHeld {
    /// What whoever starts a run wants, who may have asked that the board be taken from anybody.
    #[must_use]
    pub const fn wanted(take_over: bool) -> Self {
        if take_over { Self::Take } else { Self::TakeFromKilled }
    }
}
