//! What defects hold besides plain figures.

use serde::{Deserialize, Serialize};

/// How a word with a broken bit is read.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Reading {
    /// The word uploaded in the tables of `generation`.
    pub uploaded: i64,
    /// The word read instead.
    pub read: i64,
    /// The generation of the tables.
    pub generation: u8,
    /// Whether the word is read right in the other tables.
    pub only: bool,
    /// Other bits of the word, any of which would give the same samples if it alone were broken.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub alike: Vec<u32>,
}

/// Where the addresses of the line memory are counted from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Counting {
    /// From the run's first sample.
    Run,
    /// From each frame's first sample.
    Frame,
    /// From each row's first sample.
    Row,
    /// From some time before the run.
    Before,
}

/// The end at which outputs are not clamped.
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

/// A kind of content that a board makes (AT-SPEED.md, "Content").
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ContentKind {
    /// A random level in each column.
    Noise,
    /// The least or the greatest level in each column, at random.
    Swing,
    /// Groups of columns that are alternately high and low.
    Toggle,
    /// Levels that are held for some columns.
    Steps,
}

/// What a board makes a row of content as that must be made otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "of", rename_all = "kebab-case")]
pub enum MadeAs {
    /// Another kind with the same draws.
    Kind {
        /// Which.
        kind: ContentKind,
    },
    /// A toggle in groups of 2^p columns.
    Toggle {
        /// p.
        p: u32,
        /// Whether the first group is high.
        high: bool,
    },
    /// Steps whose edges are at one in so many draws.
    Steps {
        /// One in so many.
        one_in: u32,
    },
    /// The content of the seed's low bits alone.
    SeedOf {
        /// How many.
        bits: u32,
    },
    /// The content of another frame.
    OtherFrame {
        /// How many frames later.
        frames: i16,
    },
    /// The content of another row.
    OtherRow {
        /// How many rows below.
        rows: isize,
    },
}

/// What the board uses instead of a setting that it ignores.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Instead {
    /// The usual: the middle of the row as the centre, 12 bits as the depth.
    Usual,
    /// The setting of the run's first frame.
    FirstFrame,
    /// The setting of the frame before.
    FrameBefore,
}

/// The memory that holds a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Memory {
    /// The row factors'.
    Rows,
    /// The kernel's.
    Kernel,
}

/// A frame that was made with tables other than those committed for it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct StaleFrames {
    /// The frame's number.
    pub frame: u16,
    /// The generation that was committed for it.
    pub committed: u8,
    /// The possible generations that its rows were made with.
    pub made_with: Vec<MadeWith>,
}

/// The generations that a row was made with; none for the contents at power-up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct MadeWith {
    /// The generation of the row factors.
    pub factors: Option<u8>,
    /// The generation of the kernel.
    pub kernel: Option<u8>,
}

/// Where a row's samples come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum RowSource {
    /// The corrected row `rows` below, of the frame `frames` later.
    Output {
        /// Frames later; negative for earlier.
        frames: isize,
        /// Rows below; negative for above.
        rows: isize,
    },
    /// The row that went in `rows` below, made with the factor of the row whose place it takes.
    Input {
        /// Rows below; negative for above.
        rows: isize,
    },
}

/// A bit of a sample that is not as it was sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FlippedBit {
    /// The sample's column.
    pub column: usize,
    /// The bit; 0 is the least significant.
    pub bit: u32,
}

/// A bus that carries samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SampleBus {
    /// The data of the line memory.
    LineMemory,
    /// From the datapath's output on, a sample at a time.
    Output,
    /// The bytes of packed rows on their way in.
    BytesIn,
    /// The bytes of packed rows on their way out.
    BytesOut,
}

/// What is wrong with lines of a bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LineFault {
    /// The line is stuck at 0.
    StuckLow,
    /// The line is stuck at 1.
    StuckHigh,
    /// The line is inverted.
    Inverted,
    /// Two lines carry each other's bits.
    Exchanged,
    /// Two lines are connected, and both are 0 where one of them is.
    JoinedLow,
    /// Two lines are connected, and both are 1 where one of them is.
    JoinedHigh,
}

/// Every other column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ColumnParity {
    /// Columns 0, 2 and so on.
    Even,
    /// Columns 1, 3 and so on.
    Odd,
}

/// Broken data lines of samples.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SampleLines {
    /// Of which bus.
    pub bus: SampleBus,
    /// What is wrong with them.
    pub fault: LineFault,
    /// The lines: one, or the two of a pair.
    pub bits: Vec<u32>,
    /// The columns that are affected, if these are not all.
    pub columns: Option<ColumnParity>,
}

/// A row that changed its kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct KernelSwitch {
    /// The row.
    pub row: usize,
    /// Its frame.
    pub frame: u16,
    /// The first column that shows the later kernel.
    pub column: usize,
    /// The generation of the kernel before it.
    pub before: u8,
    /// The generation of the kernel from there on.
    pub after: u8,
}

/// The blanking that a board names, and one with which its rows are right.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct NamedBlanking {
    /// The least blanking that it names, in pixel clocks.
    pub named: u16,
    /// Pixel clocks with which the same tables gave right rows.
    pub right: u16,
}

/// A word of a table that reads back as another.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TableWord {
    /// The table.
    pub table: Memory,
    /// The row or the node.
    pub entry: usize,
    /// The tap that the word weighs, in a kernel.
    pub weight: Option<String>,
    /// The bits that differ.
    pub bits: Vec<u32>,
    /// What was uploaded.
    pub uploaded: i64,
    /// What was read.
    pub read: i64,
    /// Words that are wrong in all.
    pub wrong: usize,
}

/// Many words of a table that read back as others.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TableWords {
    /// The table.
    pub table: Memory,
    /// The first entry of them: the row, the node, or the number of the grid's entry.
    pub entry: usize,
    /// The tap that its wrong word weighs, in a kernel.
    pub weight: Option<String>,
    /// What was uploaded there.
    pub uploaded: i64,
    /// What was read.
    pub read: i64,
    /// Words that are wrong in all.
    pub wrong: usize,
    /// Words of the table.
    pub words: usize,
}
