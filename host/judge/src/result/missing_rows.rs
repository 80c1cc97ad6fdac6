//! The rows of a frame that did not come back.

use std::cmp::Ordering;

use serde::{Deserialize, Serialize};

/// The rows of a frame that did not come back: the first and the last of each range, in ascending order.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct MissingRows(Vec<(usize, usize)>);

impl MissingRows {
    /// Those of a frame of which `returned` says, row by row, whether it came back.
    #[must_use]
    pub fn of(returned: &[bool]) -> Self {
        let mut ranges: Vec<(usize, usize)> = Vec::new();
        for (row, _) in returned.iter().enumerate().filter(|(_, returned)| !**returned) {
            match ranges.last_mut() {
                Some((_, last)) if *last + 1 == row => *last = row,
                _ => ranges.push((row, row)),
            }
        }
        Self(ranges)
    }

    /// Whether all rows came back.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether `row` did not come back.
    #[must_use]
    pub fn contains(&self, row: usize) -> bool {
        let from_row = |&(first, last): &(usize, usize)| match (first > row, last < row) {
            (true, _) => Ordering::Greater,
            (_, true) => Ordering::Less,
            _ => Ordering::Equal,
        };
        self.0.binary_search_by(from_row).is_ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_have_the_rows_that_did_not_come_back_and_no_others() {
        let returned = [false, true, false, false, true, true, false];
        let missing = MissingRows::of(&returned);
        assert_eq!(serde_json::to_string(&missing).unwrap(), "[[0,0],[2,3],[6,6]]");
        assert!(returned.iter().enumerate().all(|(row, returned)| missing.contains(row) != *returned));
        assert!(!missing.contains(7) && MissingRows::of(&[true]).is_empty());
    }
}
