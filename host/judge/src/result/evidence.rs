//! Frames that were kept for diagnosis and pictures.

use halfrow_model::Frame;
use serde::{Deserialize, Serialize};

use super::MissingRows;
use crate::compare::Comparison;

/// A frame that was kept: what went in, what came out and what should have.
#[derive(Clone, Debug)]
pub struct Evidence {
    /// Index into [`Report::frames`](super::Report::frames).
    pub index: usize,
    /// The frame that was sent.
    pub input: Frame,
    /// The frame that came back; missing rows are black.
    pub found: Frame,
    /// The frame that the reference gives.
    pub expected: Frame,
    /// The rows that did not come back.
    pub missing: MissingRows,
}

impl Evidence {
    /// The rows that came back: the number of each, what it should be, and what it is.
    pub(crate) fn returned(&self) -> impl Iterator<Item = (usize, &[u16], &[u16])> {
        let pairs = self.expected.rows().zip(self.found.rows()).enumerate();
        pairs
            .filter(|(row, _)| !self.missing.contains(*row))
            .map(|(row, (expected, found))| (row, expected, found))
    }

    /// Compares the rows that came back.
    pub(crate) fn compared(&self) -> Comparison {
        let mut comparison = Comparison::new(self.expected.width(), self.expected.height());
        self.returned().for_each(|(row, expected, found)| comparison.row(row, expected, found));
        comparison
    }
}

/// How many frames were kept for diagnosis and pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct EvidenceReport {
    /// Frames kept.
    pub kept: usize,
    /// The bytes of memory that they take.
    pub bytes: u64,
    /// Frames for which there was no room.
    pub left_out: usize,
}
