//! Frames that were kept.

use halfrow_model::Frame;
use serde::{Deserialize, Serialize};

/// A frame kept for pictures: how it went in, what came out, what should have.
#[derive(Clone, Debug)]
pub struct Evidence {
    /// Index into [`Report::frames`](super::Report::frames).
    pub index: usize,
    /// What went in.
    pub input: Frame,
    /// What the board gave; rows that did not come back are black.
    pub found: Frame,
    /// What the reference gives.
    pub expected: Frame,
}

/// Frames kept for diagnosis and pictures: what went in, what came out and what should have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct EvidenceReport {
    /// Frames kept.
    pub kept: usize,
    /// Their bytes in memory.
    pub bytes: u64,
    /// Frames for which there was no room.
    pub left_out: usize,
}
