//! Rows that were asked for again, and whether that was needless.

use std::collections::BTreeMap;
use std::time::Duration;

/// Rows that are remembered. The answer to a needless repetition comes soon after the first.
const KEPT: usize = 64;

/// For the last rows that were asked for again: how long they took, and how often they were asked for again.
#[derive(Default)]
pub(super) struct LateRows(BTreeMap<u32, (Duration, u32)>);

impl LateRows {
    /// A row came `took` after the wait for it began, having been asked for `again` more times.
    pub(super) fn came(&mut self, row_sequence: u32, again: u32, took: Duration) {
        if again > 0 {
            self.0.insert(row_sequence, (took, again));
        }
        if self.0.len() > KEPT {
            self.0.pop_first();
        }
    }

    /// A row came once more. If it had been asked for again although it was only late, returns how long the first copy took.
    pub(super) fn came_again(&mut self, row_sequence: u32) -> Option<Duration> {
        let (took, again) = self.0.get_mut(&row_sequence)?;
        *again = again.checked_sub(1)?;
        Some(*took)
    }
}
