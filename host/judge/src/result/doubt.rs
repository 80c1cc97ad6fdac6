//! Why a difference may not be the board's fault.

use serde::{Deserialize, Serialize};

use super::{Finding, wording};

/// Why a sound board may not be in the state that the host put it into.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "of", rename_all = "kebab-case")]
pub enum Doubt {
    /// Requests that change the board may have reached it twice.
    RequestsTwice {
        /// How many.
        requests: u64,
    },
    /// The board's count of packets is not what can have reached it, or what was sent.
    PacketsMiscounted {
        /// What it counts.
        counted: u64,
        /// How many were sent, without those known to be lost.
        sent: u64,
    },
    /// Only counters are wrong that a link can change too, by bringing one packet twice and losing another.
    CountersOfLinks {},
    /// The board does not say how many packets reached it.
    PacketsUncounted {},
    /// An answer that the board must give did not come back, however often it was asked for, or what it was told had no effect,
    /// however often it was told.
    AnswerLost {},
    /// The board counts fewer damaged packets than were sent to it: something on the way may have made the others whole.
    DamageUncounted {
        /// What it counts.
        counted: u32,
        /// How many were sent.
        sent: u32,
    },
}

impl Doubt {
    /// The doubt as a clause after "because" or "since".
    #[must_use]
    pub fn clause(self) -> String {
        wording::because(self)
    }
}

/// What was to be looked at a second time, and why that broke off.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BrokenOff {
    /// What was wrong.
    pub found: Finding,
    /// Why the link may have caused it.
    pub doubt: Doubt,
    /// What ended the second look, in another session.
    pub reason: Finding,
}
