//! Rows that take another latency than the board claims.

use serde::{Deserialize, Serialize};

/// Rows that take another latency than the board claims.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct LateRows {
    /// How many.
    pub rows: usize,
    /// Of so many; 0 where a report is of a version that did not tell.
    #[serde(default)]
    pub of_rows: usize,
    /// Whether they are the same row of each frame.
    #[serde(default)]
    pub is_one_row: bool,
    /// The first of them.
    pub row: usize,
    /// Its frame.
    pub frame: u16,
    /// From first sample in to first sample out, in pixel clocks.
    pub first: u32,
    /// From last to last.
    pub last: u32,
    /// What the board claims.
    pub claimed: u32,
}

impl LateRows {
    /// Whether other rows take the latency that the board claims.
    #[must_use]
    pub const fn are_some(&self) -> bool {
        self.rows < self.of_rows
    }

    /// Whether one row alone is late, in more frames than one.
    #[must_use]
    pub const fn are_one_row(&self) -> bool {
        self.are_some() && self.is_one_row && self.rows > 1
    }

    /// Whether rows are late that follow no pattern which the same logic would give on every board.
    #[must_use]
    pub const fn come_and_go(&self) -> bool {
        self.are_some() && !self.are_one_row()
    }
}
