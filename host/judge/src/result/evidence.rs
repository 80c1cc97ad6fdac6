//! Frames that were kept.

use halfrow_model::Frame;

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
