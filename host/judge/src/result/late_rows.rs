//! Rows whose latency is not the one that the board claims.

use serde::{Deserialize, Serialize};

/// Rows whose latency is not the one that the board claims.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct LateRows {
    /// How many.
    pub rows: usize,
    /// Of how many; 0 in reports of versions that did not count them.
    #[serde(default)]
    pub of_rows: usize,
    /// Whether all of them are the same row of their frames.
    #[serde(default)]
    pub is_one_row: bool,
    /// The first of them.
    pub row: usize,
    /// Its frame.
    pub frame: u16,
    /// From first sample in to first sample out, in pixel clocks.
    pub first: u32,
    /// From last sample in to last sample out, in pixel clocks.
    pub last: u32,
    /// What the board claims, in pixel clocks.
    pub claimed: u32,
}

impl LateRows {
    /// Whether other rows have the claimed latency.
    #[must_use]
    pub const fn are_some(&self) -> bool {
        self.rows < self.of_rows
    }

    /// Whether a single row is late, in more than one frame.
    #[must_use]
    pub const fn are_one_row(&self) -> bool {
        self.are_some() && self.is_one_row && self.rows > 1
    }

    /// Whether the late rows follow no pattern that the same logic would show on every board.
    #[must_use]
    pub const fn come_and_go(&self) -> bool {
        self.are_some() && !self.are_one_row()
    }
}
