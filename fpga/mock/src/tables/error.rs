//! What the tables refuse.

use super::MOST_GRID_ENTRY;
use crate::core::UNSTRETCHED;

/// The tables refused a write or a commit.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TableError {
    /// The entry is not in the table.
    #[error("entry {entry} is not in a table of {entries}; write entries below {entries}")]
    NoSuchEntry {
        /// The entry's number.
        entry: usize,
        /// Entries of the table.
        entries: usize,
    },
    /// The factor is zero or above one.
    #[error("the factor {factor} of row {row} is out of range; give 1 to {UNSTRETCHED}")]
    Factor {
        /// The entry's row.
        row: usize,
        /// What was to be written.
        factor: u32,
    },
    /// The entry of a grid is too large.
    #[error("the value {value} of entry {entry} is out of a grid's range; give 0 to {MOST_GRID_ENTRY}")]
    GridEntry {
        /// The entry's number.
        entry: usize,
        /// What was to be written.
        value: u32,
    },
    /// The build has five taps and the kernel needs seven.
    #[error("node {node} weighs G0 or G6, which this five-tap build lacks; use a five-tap kernel")]
    OuterTaps {
        /// The node's number.
        node: usize,
    },
    /// The shadow bank has been committed and no row has used it yet.
    #[error("the shadow bank waits for row 0 of frame {first_frame}; play that row first")]
    CommitPending {
        /// The frame at which the commit takes effect.
        first_frame: u16,
    },
}
