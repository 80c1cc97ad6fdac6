//! What a PASS does not cover, as codes with parameters.

use serde::{Deserialize, Serialize};

use super::{ClockSeen, Parameters, wording};

/// A part of the board, or a setting, that no frame of the run exercised: a fault there would have gone unseen.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "code", content = "parameters", rename_all = "kebab-case")]
pub enum NotExercised {
    /// Bits of samples that were never both 0 and 1 on their way into the board.
    InputBits {
        /// The bits, from 0.
        bits: Vec<usize>,
    },
    /// Bits of corrected samples that were never both 0 and 1.
    OutputBits {
        /// The bits, from 0.
        bits: Vec<usize>,
    },
    /// Address lines of the columns of a row that are 0 at every column.
    ColumnAddress {
        /// The lines, from 0.
        lines: Vec<usize>,
    },
    /// Address lines of the ring of one row: no sample is still needed when the one that differs from it in this line
    /// alone has been stored.
    LineMemoryAddress {
        /// The lines, from 0.
        lines: Vec<usize>,
    },
    /// Address lines of the row table that no two rows of different factors tell apart.
    RowTableAddress {
        /// The lines, from 0.
        lines: Vec<usize>,
    },
    /// Bits of row factors that are the same in every row.
    RowFactorBits {
        /// The bits, from 0.
        bits: Vec<usize>,
    },
    /// Nodes of the kernel that no output is made with.
    KernelNodes {
        /// The nodes, 0 to 64.
        nodes: Vec<usize>,
    },
    /// Taps of the board that have no weight in any output.
    Taps {
        /// Their names, `G0` to `G6`.
        taps: Vec<String>,
    },
    /// The optical centre was at one column alone.
    OneCentre {
        /// C, twice that column.
        centre2: u32,
    },
    /// Bits of C, twice the column of the optical centre, that were the same in every frame.
    CentreBits {
        /// The bits, from 0.
        bits: Vec<usize>,
    },
    /// Frames that follow each other at the full pixel clock.
    FullSpeed {},
    /// A change of tables between two frames at the full pixel clock.
    TableChangeAtSpeed {},
    /// The pixel clock that the board names: another was seen, which is given from outside, or was not seen again.
    NamedClock {
        /// The one that it names, in hertz.
        clock_hz: u32,
        /// What was seen of it.
        seen: ClockSeen,
    },
    /// The pixel clock that the board names, which only frames at speed tell, and none were made.
    UnseenClock {
        /// The one that it names, in hertz.
        clock_hz: u32,
    },
    /// What the board must refuse, keep and end.
    Rules {},
    /// Rows that a grid corrects, on a board that takes grids.
    Grids {},
    /// Records of bursts beyond those that a burst fills, of a board that keeps more.
    FurtherRecords {
        /// As many are filled.
        filled: u32,
    },
    /// Counters that are compared over a sound link alone, of a board that counts damaged packets, or others than were sent, where
    /// the host saw nothing go wrong.
    CountersOfPoorLinks {},
    /// Whether one board did all of it: the one that came back has no serial number, as the one that went away has none.
    SameBoard {},
    /// The joints of a physical board's camera connector, and of the pins to the image processor: frames of a run enter and leave
    /// inside the FPGA.
    CameraPins {},
    /// Depths of the board that no frame had.
    Depths {
        /// Bits of a sample, each.
        bits: Vec<u32>,
    },
}

impl NotExercised {
    /// The part in words, without a full stop, to complete the sentence "not exercised: …".
    #[must_use]
    pub fn words(&self) -> String {
        wording::not_exercised(self)
    }

    /// The code and its parameters.
    #[must_use]
    pub fn tagged(&self) -> (String, Parameters) {
        super::problem::tagged(self)
    }
}

/// A part in JSON, with its words.
#[derive(Serialize)]
pub(super) struct InWords<'a> {
    #[serde(flatten)]
    part: &'a NotExercised,
    words: String,
}

impl<'a> From<&'a NotExercised> for InWords<'a> {
    fn from(part: &'a NotExercised) -> Self {
        Self { part, words: part.words() }
    }
}
