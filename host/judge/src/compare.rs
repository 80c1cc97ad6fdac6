//! Compares the board's samples with the reference's, one by one.

use halfrow_model::Frame;
use serde::{Deserialize, Serialize};

/// A sample that differs from the reference's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Difference {
    /// Its row.
    pub row: usize,
    /// Its column.
    pub column: usize,
    /// The reference's sample.
    pub expected: u16,
    /// The board's.
    pub found: u16,
}

/// How one corrected frame compares with the reference's.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Comparison {
    /// Samples compared.
    pub samples: usize,
    /// Samples that differ.
    pub differences: usize,
    /// The first sample that differs, in reading order.
    pub first: Option<Difference>,
    /// The largest absolute difference.
    pub largest: u16,
    /// The most negative and the most positive difference, found − expected; none if nothing differs.
    pub extremes: Option<(i32, i32)>,
    /// The bits in which any sample differs, at their places in a sample.
    #[serde(default)]
    pub bits: u16,
    /// Differences in each row; empty where they are not kept.
    #[serde(with = "crate::result::counts_as_runs")]
    pub by_row: Vec<u32>,
    /// Differences in each column; empty where they are not kept.
    #[serde(with = "crate::result::counts_as_runs")]
    pub by_column: Vec<u32>,
}

impl Comparison {
    /// An empty comparison of a frame of `width` × `height`.
    #[must_use]
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            samples: 0,
            differences: 0,
            first: None,
            largest: 0,
            extremes: None,
            bits: 0,
            by_row: vec![0; height],
            by_column: vec![0; width],
        }
    }

    /// Compares one row. Rows may come in any order, each once.
    pub fn row(&mut self, row: usize, expected: &[u16], found: &[u16]) {
        self.samples += found.len();
        if expected == found {
            return;
        }
        for (column, (&expected, &found)) in expected.iter().zip(found).enumerate() {
            if expected != found {
                self.note(Difference { row, column, expected, found });
            }
        }
    }

    /// Compares two frames of the same size.
    #[must_use]
    pub fn of_frames(expected: &Frame, found: &Frame) -> Self {
        let mut comparison = Self::new(expected.width(), expected.height());
        for (row, (expected, found)) in expected.rows().zip(found.rows()).enumerate() {
            comparison.row(row, expected, found);
        }
        comparison
    }

    fn note(&mut self, difference: Difference) {
        let change = i32::from(difference.found) - i32::from(difference.expected);
        let (least, most) = self.extremes.unwrap_or((change, change));
        self.differences += 1;
        self.largest = self.largest.max(difference.found.abs_diff(difference.expected));
        self.extremes = Some((least.min(change), most.max(change)));
        self.bits |= difference.found ^ difference.expected;
        if let Some(count) = self.by_row.get_mut(difference.row) {
            *count += 1;
        }
        if let Some(count) = self.by_column.get_mut(difference.column) {
            *count += 1;
        }
        let place = |d: &Difference| (d.row, d.column);
        if self.first.as_ref().is_none_or(|first| place(&difference) < place(first)) {
            self.first = Some(difference);
        }
    }

    /// The rows that have differences, in ascending order.
    #[must_use]
    pub(crate) fn differing_rows(&self) -> Vec<usize> {
        (0..self.by_row.len()).filter(|&row| self.by_row[row] > 0).collect()
    }
}

/// The bits that are set in `changed`, the lowest first.
pub(crate) fn bits_in(changed: u32) -> Vec<u32> {
    (0..u32::BITS).filter(|bit| changed >> bit & 1 == 1).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_counted_where_they_are() {
        let mut comparison = Comparison::new(4, 3);
        comparison.row(2, &[1, 2, 3, 4], &[1, 0, 3, 9]);
        comparison.row(0, &[5, 5, 5, 5], &[5, 5, 5, 5]);
        comparison.row(1, &[5, 5, 5, 5], &[5, 5, 5, 4]);
        assert_eq!((comparison.samples, comparison.differences, comparison.largest), (12, 3, 5));
        assert_eq!((comparison.extremes, comparison.bits), (Some((-2, 5)), 2 | (4 ^ 9) | (5 ^ 4)));
        assert_eq!(comparison.first, Some(Difference { row: 1, column: 3, expected: 5, found: 4 }));
        assert_eq!((comparison.by_row, comparison.by_column), (vec![0, 1, 2], vec![0, 1, 0, 2]));
    }
}
