//! What a report says about frames and rows.

use std::fmt;

use halfrow_model::Phase;
use serde::{Deserialize, Serialize};

use super::{MissingRows, as_text};
use crate::compare::Comparison;
use crate::run::DECOY;

/// The comparisons of several frames, added up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameTotals {
    /// How many there are.
    pub frames: usize,
    /// How many of them have differences.
    pub differing_frames: usize,
    /// Samples that were compared.
    pub samples: usize,
    /// Samples that differ.
    pub differences: usize,
}

impl FrameTotals {
    /// The totals of `frames`.
    #[must_use]
    pub fn of(frames: &[FrameReport]) -> Self {
        let compared = || frames.iter().map(|frame| &frame.comparison);
        Self {
            frames: frames.len(),
            differing_frames: compared().filter(|one| one.differences > 0).count(),
            samples: compared().map(|one| one.samples).sum(),
            differences: compared().map(|one| one.differences).sum(),
        }
    }
}

/// One streamed frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrameReport {
    /// `builtin:NAME`, or the file's path.
    pub name: String,
    /// The frame's number on the wire.
    pub number: u16,
    /// SHA-256 of the samples that went in, 16 bits each, little endian.
    pub sha256: String,
    /// Bayer phase.
    #[serde(with = "as_text")]
    pub phase: Phase,
    /// The generation of the tables that it was made with.
    pub generation: u8,
    /// How its rows were played.
    pub timing: FrameTiming,
    /// The setting in which it differs from the plan's tables.
    #[serde(default)]
    pub variation: Option<Variation>,
    /// How its samples compare with the reference.
    pub comparison: Comparison,
    /// How many rows from the top were streamed, if the frame was not streamed whole.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_rows: Option<usize>,
    /// Rows that came back.
    pub rows: usize,
    /// Rows that did not come back.
    #[serde(default, skip_serializing_if = "MissingRows::is_empty")]
    pub missing: MissingRows,
    /// Seconds on the wall clock from when the frame before it had come back until this one had.
    pub seconds: f64,
}

/// A frame in JSON, with what its generation means.
#[derive(Serialize)]
pub(super) struct WithTables<'a> {
    #[serde(flatten)]
    frame: &'a FrameReport,
    tables: &'static str,
}

impl<'a> From<&'a FrameReport> for WithTables<'a> {
    fn from(frame: &'a FrameReport) -> Self {
        Self { frame, tables: if frame.is_decoy() { "decoy" } else { "judged" } }
    }
}

impl FrameReport {
    /// Whether it was made with the decoy tables, and not with those to judge with.
    pub(crate) const fn is_decoy(&self) -> bool {
        self.generation == DECOY
    }

    /// The rows that were streamed. Only a frame of which all came back may be without counts by row.
    #[must_use]
    pub fn height(&self) -> usize {
        self.rows.max(self.comparison.by_row.len())
    }
}

/// The setting that a frame of its own tries and no other frame has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Variation {
    /// Another optical centre.
    Centre {
        /// C, twice its column.
        centre2: u32,
    },
    /// Another depth.
    Depth {
        /// Bits of a sample.
        bits: u32,
    },
}

impl fmt::Display for Variation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Centre { centre2 } => write!(f, "centre {:.1}", f64::from(*centre2) / 2.0),
            Self::Depth { bits } => write!(f, "{bits} bits"),
        }
    }
}

/// How the rows of a frame were played.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum FrameTiming {
    /// The fewest pixel clocks between rows that the board allows.
    LeastBlanking {
        /// Their number.
        clocks: u16,
    },
    /// A given number of pixel clocks between rows.
    Blanking {
        /// Their number.
        clocks: u16,
    },
    /// Random gaps in and between rows.
    Gaps {
        /// Their seed.
        seed: u32,
    },
}

impl fmt::Display for FrameTiming {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::LeastBlanking { clocks } => write!(f, "least blanking ({clocks} clocks)"),
            Self::Blanking { clocks } => write!(f, "{clocks} clocks of blanking"),
            Self::Gaps { seed } => write!(f, "gaps, seed {seed}"),
        }
    }
}

/// The latency of every row, in pixel clocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct LatencyReport {
    /// D = W/2 + L by the board's own L.
    pub claimed: u32,
    /// The most that any board may take, W/2 + 32.
    pub limit: u32,
    /// The smallest that was measured.
    pub least: u32,
    /// The largest.
    pub most: u32,
    /// Rows measured.
    pub rows: usize,
    /// Rows whose first or last latency is not the claimed one.
    pub wrong_rows: usize,
}
