//! What defects say beside their codes and figures.

use serde::{Deserialize, Serialize};

/// What a broken bit makes of a word.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Reading {
    /// What was uploaded, in the tables of `generation`.
    pub uploaded: i64,
    /// What is read instead.
    pub read: i64,
    /// The tables.
    pub generation: u8,
    /// Whether the other tables are read right.
    pub only: bool,
    /// Other bits of the word of which each, broken alone, gives the same samples.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub alike: Vec<u32>,
}

/// From where the addresses of the line memory are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Counting {
    /// From the run's first sample.
    Run,
    /// From each frame's.
    Frame,
    /// From each row's.
    Row,
    /// From before the run.
    Before,
}

/// Where outputs are not clamped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ClampEnd {
    /// Below 0.
    Low,
    /// Above the largest sample.
    High,
    /// Beyond either end.
    Both,
}

/// What stands in the place of a setting that the board does not take.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Instead {
    /// The middle of the row, or 12 bits.
    Usual,
    /// That of the run's first frame.
    FirstFrame,
    /// That of the frame before.
    FrameBefore,
}

/// Which memory holds a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Memory {
    /// The row factors'.
    Rows,
    /// The kernel's.
    Kernel,
}

/// A frame that was made with other tables than it should.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct StaleFrames {
    /// Its number.
    pub frame: u16,
    /// The generation that was committed for it.
    pub committed: u8,
    /// What its rows were made with.
    pub made_with: Vec<MadeWith>,
}

/// Generations that a row was made with, or none for what a board holds when it was just switched on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct MadeWith {
    /// That of the row factors.
    pub factors: Option<u8>,
    /// That of the kernel.
    pub kernel: Option<u8>,
}

/// Where a row's samples come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum RowSource {
    /// The corrected row so many rows below, in the frame so many later.
    Output {
        /// Frames later.
        frames: isize,
        /// Rows below.
        rows: isize,
    },
    /// The row that went in so many rows below, made with this row's factor.
    Input {
        /// Rows below.
        rows: isize,
    },
}

/// A bit of a sample that is another one than was sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FlippedBit {
    /// The sample's column.
    pub column: usize,
    /// The bit, 0 the least.
    pub bit: u32,
}
