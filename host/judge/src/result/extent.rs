//! The rows or columns in which differences lie.

use serde::{Deserialize, Serialize};

/// A set of rows or columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Extent {
    /// A single one.
    One {
        /// Its number.
        at: usize,
    },
    /// All.
    Every {},
    /// All from a given one on.
    From {
        /// The first.
        first: usize,
    },
    /// All between two, both included.
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
        /// Of how many.
        total: usize,
        /// The first.
        first: usize,
        /// The last.
        last: usize,
    },
}
