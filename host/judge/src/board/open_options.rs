//! How a session is opened.

use super::{RetryLimit, SessionIds, Stop};

/// How a session is opened. The default draws a nonce, a host number and a sequence number, so that sessions differ.
#[derive(Clone, Debug)]
pub struct OpenOptions {
    /// The session's nonce, drawn at random.
    pub nonce: u32,
    /// The number of this host, drawn at random once per run of the program.
    pub host: u32,
    /// The sequence number before that of the first packet, drawn at random too. A refusal names no nonce, so one that is still
    /// under way to an earlier program must not match by its number.
    pub sequence: u16,
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

impl From<SessionIds> for OpenOptions {
    fn from(SessionIds { nonce, host, sequence }: SessionIds) -> Self {
        Self {
            nonce,
            host,
            sequence,
            when_held: WhenHeld::default(),
            counts: false,
            retry_limit: RetryLimit::default(),
            stop: Stop::default(),
        }
    }
}

impl Default for OpenOptions {
    fn default() -> Self {
        SessionIds::default().into()
    }
}
