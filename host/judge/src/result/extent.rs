//! Where differences lie.

use serde::{Deserialize, Serialize};

/// Which rows or columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Extent {
    /// A single one.
    One {
        /// Which.
        at: usize,
    },
    /// All.
    Every {},
    /// All from one on.
    From {
        /// That one.
        first: usize,
    },
    /// All between two, these included.
    Between {
        /// The first.
        first: usize,
        /// The last.
        last: usize,
    },
    /// Only even ones.
    Even {
        /// How many.
        count: usize,
    },
    /// Only odd ones.
    Odd {
        /// How many.
        count: usize,
    },
    /// Some.
    Some {
        /// How many.
        count: usize,
        /// Of so many.
        total: usize,
        /// The first.
        first: usize,
        /// The last.
        last: usize,
    },
}
