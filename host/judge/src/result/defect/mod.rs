//! The single defects that a diagnosis knows, as codes with parameters.

mod parameters;

use serde::{Deserialize, Serialize};

use super::Extent;
pub use parameters::{
    ClampEnd, ColumnParity, ContentKind, Counting, FlippedBit, Instead, KernelSwitch, LineFault, MadeAs,
    MadeWith, Memory, NamedBlanking, Reading, RowSource, SampleBus, SampleLines, StaleFrames, TableWord,
    TableWords,
};

/// A single defect of a board.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "code", content = "parameters", rename_all = "kebab-case")]
pub enum Defect {
    /// One bit of one row's factor is wrong.
    RowFactorBitWrong {
        /// The row.
        row: usize,
        /// The bit.
        bit: u32,
        /// What is read.
        reading: Reading,
        /// Whether a factor above 1 is read, which no simulation follows to the row's end.
        above_one: bool,
    },
    /// One row's factor is wrong.
    RowFactorWrong {
        /// The row.
        row: usize,
        /// The tables in which it is wrong, the newest of several.
        generation: u8,
        /// The least factor that gives what was seen.
        least: u32,
        /// The greatest.
        most: u32,
        /// What was uploaded.
        uploaded: u32,
        /// Whether the other tables are read right.
        only: bool,
    },
    /// One bit of one entry of a grid is wrong.
    GridEntryBitWrong {
        /// The grid's column: 0 for offsets, 1 + s for node s.
        column: usize,
        /// The grid's row.
        row: usize,
        /// The bit.
        bit: u32,
        /// What is read.
        reading: Reading,
        /// Whether the grid that is read leads out of the row or the ring, where only part of a row can be foretold.
        illegal: bool,
    },
    /// One bit of one word of the kernel is wrong.
    KernelWordBitWrong {
        /// The node, 0 to 64.
        node: usize,
        /// The tap that the word weighs.
        weight: String,
        /// The bit.
        bit: u32,
        /// What is read.
        reading: Reading,
    },
    /// One word of the kernel is wrong.
    KernelWordWrong {
        /// The node, 0 to 64.
        node: usize,
        /// The tap that the word weighs.
        weight: String,
        /// The tables in which it is wrong, the newest of several.
        generation: u8,
        /// The least value that gives what was seen, in units of 2^-14.
        least: i64,
        /// The greatest.
        most: i64,
        /// What was uploaded.
        uploaded: i16,
        /// Whether the other tables are read right.
        only: bool,
    },
    /// A data line of the line memory is stuck at 0 or at 1.
    LineMemoryDataStuck {
        /// The line.
        bit: u32,
        /// Its level.
        value: u8,
    },
    /// A data line after the datapath is stuck at 0 or at 1.
    OutputDataStuck {
        /// The line.
        bit: u32,
        /// Its level.
        value: u8,
    },
    /// Data lines of samples are inverted, exchanged or connected, or stuck in every other column alone.
    SampleLinesWrong(SampleLines),
    /// An address line of the line memory is stuck at 0 or at 1.
    LineMemoryAddressStuck {
        /// The line.
        bit: u32,
        /// How addresses must be counted for it.
        counting: Counting,
    },
    /// The window reads the columns beside those that it should read.
    TapOffset {
        /// How far to the right.
        columns: i64,
    },
    /// One tap does not carry its own sample.
    TapDead {
        /// Which.
        tap: String,
        /// The tap whose sample it carries; none for zero.
        reads: Option<String>,
    },
    /// The base column has the row's other colour.
    BaseColourWrong {},
    /// The weighted sum is not rounded.
    OutputRoundingMissing {},
    /// The weights between two nodes are not rounded.
    WeightRoundingMissing {},
    /// Neither the weights between two nodes nor the weighted sum are rounded.
    RoundingMissing {},
    /// The weights of the kernel are read as numbers without a sign.
    WeightsUnsigned {},
    /// The product between two nodes is rounded toward zero instead of down.
    WeightsTowardZero {},
    /// The source column is not rounded.
    SourceRoundingMissing {},
    /// Where the source's column has the row's other colour, the base column is the one right of it instead of left.
    BaseColumnRight {},
    /// Beyond the row's ends stands the nearest sample, instead of the nearest one of the same colour.
    EdgeColourWrong {},
    /// Results out of range wrap around instead of being clamped.
    ClampMissing {
        /// Where.
        end: ClampEnd,
    },
    /// The board uses another optical centre than the one that was set.
    CentreIgnored {
        /// What stands in its place.
        instead: Instead,
    },
    /// The board uses an optical centre that is beside the one that was set.
    CentreOff {
        /// How far to the right, in half columns.
        halves: i32,
    },
    /// One bit of the register that holds the optical centre is stuck.
    CentreBitStuck {
        /// The bit of twice the column.
        bit: u32,
        /// Its level.
        value: u8,
    },
    /// The board uses another sample depth than the one that was set.
    DepthIgnored {
        /// What stands in their place.
        instead: Instead,
    },
    /// A data line of the row table is stuck when the datapath reads it.
    RowTableDataStuck {
        /// The line.
        bit: u32,
        /// Its level.
        value: u8,
    },
    /// An address line of the row table is stuck.
    RowTableAddressStuck {
        /// The line.
        bit: u32,
        /// Its level.
        value: u8,
    },
    /// The datapath reads the entry of the row table that is next to the row's own.
    RowTableAddressOff {
        /// How many entries ahead.
        entries: isize,
    },
    /// An address line of the kernel's memory is stuck.
    KernelAddressStuck {
        /// The line.
        bit: u32,
        /// Its level.
        value: u8,
    },
    /// The datapath interpolates between nodes of the kernel that are next to its own.
    KernelAddressOff {
        /// How many nodes ahead.
        nodes: isize,
    },
    /// A data line of the memory that holds one weight of the kernel is stuck.
    KernelDataStuck {
        /// The tap that it weighs.
        weight: String,
        /// The line.
        bit: u32,
        /// Its level.
        value: u8,
    },
    /// Rows are made with other tables than were committed for them.
    StaleTables {
        /// The rows, when they are few; none for all.
        rows: Vec<usize>,
        /// The frames.
        frames: Vec<StaleFrames>,
    },
    /// A row is made with one kernel at its beginning and with another one at its end.
    KernelSwitchedInRow(KernelSwitch),
    /// Rows are wrong only if they follow each other as closely as the board says that it allows.
    LeastBlankingTooSmall(NamedBlanking),
    /// Some rows hold the samples of other rows.
    RowsExchanged {
        /// Which others.
        source: RowSource,
        /// Whether some hold still others.
        mostly: bool,
    },
    /// Every row is shifted to the left or right.
    RowShifted {
        /// How far to the right.
        columns: isize,
    },
    /// The two outputs of every pair of columns are exchanged.
    ColumnPairsExchanged {},
    /// The bytes of every pair of outputs are packed most significant first.
    PairBytesReversed {
        /// Whether the pair's first sample is in front, as in one long number; otherwise only the three bytes are reversed.
        first_in_front: bool,
    },
    /// The samples of whole rows were lost inside the board, so that these rows are black.
    RowsLost {
        /// How many.
        rows: usize,
        /// The first.
        first: usize,
    },
    /// Samples are changed on their way from the packet into the core.
    RowsChangedOnEntry {
        /// How many.
        rows: usize,
        /// The first of them.
        first: usize,
        /// Its frame.
        frame: u16,
        /// The one bit that is flipped in the first of them, if the CRC tells one.
        flipped: Option<FlippedBit>,
    },
    /// Frames begin with the tables of the frame before them.
    TablesChangeLate {
        /// So many rows.
        rows: usize,
    },
    /// Records of frames hold the signature of the frame before.
    RecordsLate {},
    /// At the full pixel clock, rows are corrected rightly, but made of another content than AT-SPEED.md gives them.
    ContentWrong {
        /// A row in which it was seen.
        row: usize,
        /// The kind of content that it must have.
        kind: ContentKind,
        /// What it was made as.
        made: MadeAs,
    },
    /// The samples of a row at the full pixel clock are right, and its signature is not the CRC of them.
    SignatureWrong {
        /// The row.
        row: usize,
    },
    /// Frames are right when they are sent row by row, and the same frames with the same tables are wrong at the full pixel
    /// clock.
    OnlyAtSpeed {
        /// A row in which it was seen.
        row: Option<usize>,
        /// Samples of that row that differ.
        samples: usize,
        /// Bits of them that do.
        bits: Vec<u32>,
    },
    /// Frames at the full pixel clock are wrong, and no such frame came back row by row, so the fault may show at any clock.
    SeenAtSpeed {
        /// A row in which it was seen.
        row: Option<usize>,
        /// Samples of that row that differ.
        samples: usize,
        /// Bits of them that do.
        bits: Vec<u32>,
        /// The row that did not come back when such a frame was sent row by row; none if none was sent, or in a report of a
        /// version that did not tell.
        #[serde(default)]
        lost: Option<usize>,
    },
    /// No known defect explains most of the differences; the suspect says where they lie.
    NoneKnown {
        /// Their rows.
        rows: Option<Extent>,
        /// Their columns.
        columns: Option<Extent>,
        /// The most negative difference, found − expected.
        least: Option<i32>,
        /// The most positive.
        most: Option<i32>,
        /// Whether only samples of half the range and above differ, or only those below; none for both.
        bright: Option<bool>,
        /// Bits in which any of them differs; empty where a report is of a version that did not tell.
        #[serde(default)]
        bits: Vec<u32>,
        /// Whether they are in rows alone that are no part of the frames that were streamed, so that no map shows them.
        #[serde(default)]
        unstreamed: bool,
        /// In so many frames.
        frames: usize,
        /// Of so many.
        of_frames: usize,
    },
    /// The number of entries that read back is not the number that was uploaded.
    TableLengthWrong {
        /// The table.
        table: Memory,
        /// Entries uploaded.
        uploaded: usize,
        /// Entries read.
        read: usize,
    },
    /// A word of a table reads back as another.
    TableWordWrong(TableWord),
    /// Many words of a table read back as others, and nothing known makes them so.
    TableWordsWrong(TableWords),
    /// Every word of a table reads back with its bytes in reverse order.
    TableBytesReversed {
        /// The table.
        table: Memory,
    },
    /// An entry of a grid reads back as another.
    GridEntryReadsWrong {
        /// The grid's column: 0 for offsets, 1 + s for node s.
        column: usize,
        /// The grid's row.
        row: usize,
        /// The bits that differ.
        bits: Vec<u32>,
        /// What was uploaded.
        uploaded: i64,
        /// What was read.
        read: i64,
        /// Entries that are wrong in all.
        wrong: usize,
    },
    /// A data line of a table is stuck, as seen when the table is read back.
    TableDataStuck {
        /// The table.
        table: Memory,
        /// The tap whose weights alone it carries, if it is the line of one.
        weight: Option<String>,
        /// The line.
        bit: u32,
        /// Its level.
        value: u8,
    },
    /// An address line of a table is stuck, as seen when the table is read back.
    TableAddressStuck {
        /// The table.
        table: Memory,
        /// The line.
        bit: u32,
        /// Its level.
        value: u8,
    },
    /// An address line of a table is stuck at 0 for writing, but right for reading.
    TableWriteAddressStuck {
        /// The table.
        table: Memory,
        /// The line.
        bit: u32,
    },
    /// Every entry of a table reads back as its neighbour.
    TableAddressOff {
        /// The table.
        table: Memory,
        /// How many entries ahead.
        entries: isize,
    },
    /// A table reads back as all zeros or all ones.
    TableLevelStuck {
        /// The table.
        table: Memory,
        /// The level.
        value: u8,
    },
}
