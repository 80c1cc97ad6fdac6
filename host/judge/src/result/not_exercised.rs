//! What a PASS does not cover, as codes with parameters.

use serde::{Deserialize, Serialize};

use super::{ClockSeen, Parameters, wording};

/// A part of the board, or a setting, that no frame of the run exercised: a fault there would have gone unseen.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "code", content = "parameters", rename_all = "kebab-case")]
pub enum NotExercised {
    /// Some bits of the samples that went into the board were never both 0 and 1.
    InputBits {
        /// The bits, from 0.
        bits: Vec<usize>,
    },
    /// Some bits of the corrected samples were never both 0 and 1.
    OutputBits {
        /// The bits, from 0.
        bits: Vec<usize>,
    },
    /// Some address lines of a row's columns were 0 at every column.
    ColumnAddress {
        /// The lines, from 0.
        lines: Vec<usize>,
    },
    /// Some address lines of the ring of one row were not put to the test: no sample was still needed when the one whose
    /// address differs from it in this line alone had been stored.
    LineMemoryAddress {
        /// The lines, from 0.
        lines: Vec<usize>,
    },
    /// Some address lines of the row table were not put to the test: no two rows of different factors differ in this line
    /// alone.
    RowTableAddress {
        /// The lines, from 0.
        lines: Vec<usize>,
    },
    /// Some bits of the row factors were the same in every row.
    RowFactorBits {
        /// The bits, from 0.
        bits: Vec<usize>,
    },
    /// Some nodes of the kernel were used for no output.
    KernelNodes {
        /// The nodes, 0 to 64.
        nodes: Vec<usize>,
    },
    /// Some taps of the board had no weight in any output.
    Taps {
        /// Their names, `G0` to `G6`.
        taps: Vec<String>,
    },
    /// The optical centre was at the same column in all frames.
    OneCentre {
        /// C, twice that column.
        centre2: u32,
    },
    /// Some bits of C, twice the column of the optical centre, were the same in every frame, or changed no sample of any.
    CentreBits {
        /// The bits, from 0.
        bits: Vec<usize>,
    },
    /// No frames followed each other at the full pixel clock.
    FullSpeed {},
    /// The tables never changed between two frames at the full pixel clock.
    TableChangeAtSpeed {},
    /// The pixel clock that the board names was not confirmed: another one was seen, which is given from outside, or the
    /// clock was not seen again.
    NamedClock {
        /// The one that it names, in hertz.
        clock_hz: u32,
        /// What was seen of it.
        seen: ClockSeen,
    },
    /// The pixel clock that the board names was not checked: no frames at speed were made, which alone show it; or they were those
    /// of a soak, which measures no clock; or it is hardware that names the clock of a mock.
    UnseenClock {
        /// The one that it names, in hertz.
        clock_hz: u32,
    },
    /// What the board must refuse, keep and end by the rules of the wire protocol was not tested.
    Rules {},
    /// No row was corrected by a grid, on a board that takes grids.
    Grids {},
    /// Only as many records of a burst were used as one burst fills; the board keeps more.
    FurtherRecords {
        /// As many are filled.
        filled: u32,
    },
    /// Counters that are compared only over a sound link were not compared: the board counts damaged packets, or another
    /// number of packets than were sent, although the host saw nothing go wrong.
    CountersOfPoorLinks {},
    /// Whether the board that came back is the one that went away is not known, because it has no serial number.
    SameBoard {},
    /// In a part of the soak's time no frames were made, so that the board was not tried for as long as the soak took: tables were
    /// changed, the board was away, or this computer stood still.
    IdleTime {
        /// How long, in whole seconds of the link's clock.
        seconds: u64,
    },
    /// The joints of a physical board's camera connector, and of its pins to the image processor, are not tested by any run:
    /// its frames enter and leave inside the FPGA.
    CameraPins {},
    /// The board takes sample depths that no frame had.
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
