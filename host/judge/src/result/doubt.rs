//! Why what was found may not be the board's.

use serde::{Deserialize, Serialize};

use super::{Finding, wording};

/// Why a board may not be as the host made it, although it is sound.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "of", rename_all = "kebab-case")]
pub enum Doubt {
    /// Requests that change the board may have come to it twice.
    RequestsTwice {
        /// How many.
        requests: u64,
    },
    /// The board counts other packets than can have come to it, or than were sent.
    PacketsMiscounted {
        /// What it counts.
        counted: u64,
        /// What was sent, without what is known to be lost.
        sent: u64,
    },
    /// Nothing but counters is wrong that a link moves as well, which brings one packet twice and loses another.
    CountersOfLinks {},
    /// The board does not tell how many packets came to it.
    PacketsUncounted {},
    /// What the board was asked and must have said did not come back, however often it was asked for.
    AnswerLost {},
}

impl Doubt {
    /// It as a part of a sentence.
    #[must_use]
    pub fn sentence(self) -> String {
        wording::because(self)
    }
}

/// What was to be looked at again, and why that came to nothing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BrokenOff {
    /// What was wrong.
    pub found: Finding,
    /// Why it may come from the link.
    pub doubt: Doubt,
    /// What the look in another session ended with.
    pub reason: Finding,
}
