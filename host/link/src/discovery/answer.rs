//! What a device answered when it was asked whether it is a board.

use serde::Serialize;

/// The outcome of asking.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(tag = "state", rename_all = "lowercase")]
pub enum Answer {
    /// A halfrow board answered, and was left free.
    Board {
        /// Its name.
        name: String,
        /// The datapath that it computes.
        datapath: u16,
    },
    /// A halfrow board answered, but another host holds it.
    Held,
    /// Something answered, but not like a board of this program.
    Foreign {
        /// Why it is none.
        reason: String,
    },
    /// Nothing answered, and nothing came.
    Silent,
    /// Bytes came, but no answer among them: another device, or a board at another rate.
    Babble {
        /// How many.
        bytes: u64,
    },
    /// It is open in another program.
    Busy,
    /// It could not be opened.
    Failed {
        /// Why.
        reason: String,
    },
}
