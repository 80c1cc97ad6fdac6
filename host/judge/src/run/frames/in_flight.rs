//! A frame that is under way through the board.

use super::prepared::Prepared;
use crate::compare::Comparison;

/// A frame that was sent, with what has come back of it.
pub(super) struct InFlight {
    pub(super) prepared: Prepared,
    /// Samples of rows that have not come back are 0.
    pub(super) found: Vec<u16>,
    /// Which rows have come back.
    pub(super) returned: Vec<bool>,
    pub(super) rows: usize,
    pub(super) comparison: Comparison,
}

impl InFlight {
    /// A frame of which nothing has come back.
    pub(super) fn new(prepared: Prepared) -> Self {
        let (width, height) = (prepared.expected.width(), prepared.expected.height());
        Self {
            prepared,
            found: vec![0; width * height],
            returned: vec![false; height],
            rows: 0,
            comparison: Comparison::new(width, height),
        }
    }

    pub(super) fn is_whole(&self) -> bool {
        self.rows >= self.prepared.expected.height()
    }

    pub(super) fn is_wrong(&self) -> bool {
        self.comparison.differences > 0
    }
}
