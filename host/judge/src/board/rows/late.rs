//! Rows that were asked for again, and whether that was needless.

use std::collections::BTreeMap;
use std::time::Duration;

/// Rows that are remembered. What was sent again needlessly comes again soon behind the first.
const KEPT: usize = 64;

/// How long the last rows took that were asked for again, and how often they were.
#[derive(Default)]
pub(super) struct LateRows(BTreeMap<u32, (Duration, u32)>);

impl LateRows {
    /// A row came, `took` after it was waited for first and asked for `again` so many times.
    pub(super) fn came(&mut self, row_sequence: u32, again: u32, took: Duration) {
        if again > 0 {
            self.0.insert(row_sequence, (took, again));
        }
        if self.0.len() > KEPT {
            self.0.pop_first();
        }
    }

    /// A row came once more. Returns how long the first took if the board was asked again for what was only late.
    pub(super) fn came_again(&mut self, row_sequence: u32) -> Option<Duration> {
        let (took, again) = self.0.get_mut(&row_sequence)?;
        *again = again.checked_sub(1)?;
        Some(*took)
    }
}
