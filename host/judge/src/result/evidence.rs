//! Frames that were kept for diagnosis and pictures.

use halfrow_model::Frame;
use serde::{Deserialize, Serialize};

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
