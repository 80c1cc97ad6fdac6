//! The parts that can be broken.

use super::{Conduct, Misread};
use crate::core::Weight;

/// A fault inside the board, and the part that it breaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoardFault {
    /// A data line of the line memory is stuck.
    StuckData {
        /// The line, 0 to 11.
        bit: u8,
        /// The level that it is stuck at.
        value: bool,
    },
    /// An address line of the line memory is stuck, for writing and for reading.
    StuckAddress {
        /// The line, 0 to 13; lines at or above log2 M do not exist.
        bit: u8,
        /// The level that it is stuck at.
        value: bool,
    },
    /// A bit of a table entry is flipped in both banks: of a row factor, or of the grid's entry in its place.
    RowFactor {
        /// The row, or the number of the grid's entry.
        row: u16,
        /// The bit, 0 to 24.
        bit: u8,
        /// Whether only the datapath sees it and reading back shows the right value.
        hidden: bool,
    },
    /// A bit of a kernel word is flipped, in both banks.
    KernelWord {
        /// The word's node, 0 to 64.
        node: u8,
        /// The word's weight.
        weight: Weight,
        /// The bit, 0 to 15.
        bit: u8,
        /// Whether only the datapath sees it and reading back shows the right value.
        hidden: bool,
    },
    /// All taps come from columns next to their own.
    TapOffset {
        /// Columns to the right, −3 to 3.
        columns: i8,
    },
    /// The weighted sum is truncated, not rounded.
    NoRounding,
    /// One tap carries zero or another tap's sample.
    DeadTap {
        /// The tap, 0 for G0 to 6 for G6.
        tap: u8,
        /// The tap whose sample it carries; none for zero.
        reads: Option<u8>,
    },
    /// Every sample leaves one pixel clock later than the board claims.
    Late,
    /// The board claims a latency one pixel clock longer than it has.
    WrongLatencyClaim,
    /// The optical centre is the middle of the row, whatever is set.
    CentreIgnored,
    /// A bit of the register that holds the optical centre is stuck.
    StuckCentre {
        /// The bit of C, 0 to 12.
        bit: u8,
        /// The level that it is stuck at.
        value: bool,
    },
    /// A row goes in and never comes out, however often it is sent.
    LostRow {
        /// The row of every frame that is lost.
        row: u16,
    },
    /// A commit is confirmed, but rows are still made with the tables of the commit before.
    StaleTable {
        /// Whether the rows nevertheless name the new generation.
        hidden: bool,
    },
    /// A commit is accepted whatever the tables read back as.
    UncheckedCommit,
    /// A bit of a table entry flips while the board runs, in every generation.
    DriftingTable {
        /// Rows of the generation that are played before that.
        after: u32,
        /// The row, or the number of the grid's entry.
        row: u16,
        /// The bit, 0 to 24.
        bit: u8,
    },
    /// Packets are treated against the wire's rules.
    Conduct(Conduct),
    /// The board claims another datapath id.
    WrongDatapath,
    /// The board claims that a PLL clocks it, far slower than it really runs.
    WrongClockClaim,
    /// A bit of a row flips between its packet and the core.
    SpoiltRow {
        /// The row of every frame.
        row: u16,
        /// The column; none for the middle one.
        column: Option<u16>,
        /// The bit, 0 to 11.
        bit: u8,
    },
    /// A bit of the output flips at a given rate, in rows that follow another without a pause.
    SlowPath {
        /// The bit, 0 to 11.
        bit: u8,
        /// One in this many outputs flips, on average.
        one_in: u32,
        /// The seed of the draws.
        seed: u32,
    },
    /// A bit of the output flips once the board has made this many frames on its own.
    WarmBit {
        /// Frames that it has made before that.
        after: u32,
        /// The row whose first output flips.
        row: u16,
        /// The bit, 0 to 11.
        bit: u8,
    },
    /// When frames follow each other as closely as they may, the table bank changes a row late.
    LateSwap,
    /// In one row of every frame that the board makes, the output stands still for a clock that is not counted.
    HiddenPause {
        /// The row.
        row: u16,
    },
    /// The board does what a misread sentence says.
    Misread(Misread),
}
