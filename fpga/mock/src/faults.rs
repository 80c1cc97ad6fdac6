//! Faults by name: one part of the board out of order, on purpose.

mod catalogue;
mod effect;

use std::collections::BTreeMap;

use crate::kernel::{NODES, Weight};
use crate::value::{Limits, ValueError, parse_word};

pub use catalogue::{FaultInfo, Place, catalogue};
pub use effect::Streamed;

/// The row that faults of single rows pick by default. Small frames have it too.
const DEFAULT_ROW: u16 = 3;

const ROW: Limits = Limits::new("row", 0, 2047);
const SAMPLE_BIT: Limits = Limits::new("bit", 0, 11);
const ADDRESS_BIT: Limits = Limits::new("bit", 0, 13);
const FACTOR_BIT: Limits = Limits::new("bit", 0, 24);
const WEIGHT_BIT: Limits = Limits::new("bit", 0, 15);
const NODE: Limits = Limits::new("node", 0, NODES as i64 - 1);
const COLUMNS: Limits = Limits::new("columns", -3, 3);
const TAP: Limits = Limits::new("tap", 0, 6);
const READS: Limits = Limits::new("reads", 0, 6);
const AFTER: Limits = Limits::new("after", 0, u32::MAX as i64);

const WEIGHTS: [(&str, Weight); 5] =
    [("g0", Weight::G0), ("r1", Weight::R1), ("g4", Weight::G4), ("r5", Weight::R5), ("g6", Weight::G6)];
const LEVELS: [(&str, bool); 2] = [("0", false), ("1", true)];
const TRUTHS: [(&str, bool); 2] = [("false", false), ("true", true)];

/// A fault that cannot be made.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FaultError {
    /// No board fault has this name.
    #[error("no board fault is called {name}; choose a name from the list of faults")]
    Unknown {
        /// The name that was given.
        name: String,
    },
    /// A parameter of the fault is wrong.
    #[error("a parameter of fault={fault} cannot be used; correct it or leave it out")]
    Parameter {
        /// The fault's name.
        fault: String,
        /// What is wrong.
        #[source]
        source: ValueError,
    },
}

/// A fault inside the board, with the part that it is in.
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
    /// A bit of a row's table entry is flipped, in both banks.
    RowFactor {
        /// The entry's row.
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
    /// All taps come from beside their columns.
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
    /// A row goes in and never comes out, however often it is sent.
    LostRow {
        /// The row of every frame that is lost.
        row: u16,
    },
    /// A commit is confirmed, and rows are still made with the tables of the one before.
    StaleTable {
        /// Whether the rows are named after the new generation all the same.
        hidden: bool,
    },
    /// A bit of a table entry flips while the board runs, under every generation.
    DriftingTable {
        /// Rows of the generation that are played before.
        after: u32,
        /// The entry's row.
        row: u16,
        /// The bit, 0 to 24.
        bit: u8,
    },
    /// The board claims another datapath id.
    WrongDatapath,
}

impl BoardFault {
    /// The board fault called `name`. Takes its own parameters out of `parameters` and leaves the others there.
    ///
    /// # Errors
    /// If no board fault has this name or one of its parameters is out of range.
    pub fn from_name(name: &str, parameters: &mut Parameters) -> Result<Self, FaultError> {
        Self::read(name, parameters)
            .map_err(|source| FaultError::Parameter { fault: name.to_owned(), source })?
            .ok_or_else(|| FaultError::Unknown { name: name.to_owned() })
    }

    fn read(name: &str, from: &mut Parameters) -> Result<Option<Self>, ValueError> {
        Ok(Some(match name {
            "stuck-data" => Self::StuckData {
                bit: number(from, &SAMPLE_BIT, 5)?,
                value: word(from, "value", &LEVELS, true)?,
            },
            "stuck-address" => Self::StuckAddress {
                bit: number(from, &ADDRESS_BIT, 3)?,
                value: word(from, "value", &LEVELS, false)?,
            },
            "row-factor" => Self::RowFactor {
                row: number(from, &ROW, DEFAULT_ROW)?,
                bit: number(from, &FACTOR_BIT, 18)?,
                hidden: word(from, "hidden", &TRUTHS, false)?,
            },
            "kernel-word" => Self::KernelWord {
                node: number(from, &NODE, 16)?,
                weight: word(from, "weight", &WEIGHTS, Weight::G4)?,
                bit: number(from, &WEIGHT_BIT, 12)?,
                hidden: word(from, "hidden", &TRUTHS, false)?,
            },
            "tap-offset" => Self::TapOffset { columns: number(from, &COLUMNS, 1)? },
            "no-rounding" => Self::NoRounding,
            "dead-tap" => Self::DeadTap {
                tap: number(from, &TAP, 4)?,
                reads: from.remove(READS.key()).map(|text| READS.parse(&text)).transpose()?,
            },
            "late" => Self::Late,
            "wrong-latency-claim" => Self::WrongLatencyClaim,
            "lost-row" => Self::LostRow { row: number(from, &ROW, DEFAULT_ROW)? },
            "stale-table" => Self::StaleTable { hidden: false },
            "stale-table-hidden" => Self::StaleTable { hidden: true },
            "drifting-table" => Self::DriftingTable {
                after: number(from, &AFTER, 8)?,
                row: number(from, &ROW, DEFAULT_ROW)?,
                bit: number(from, &FACTOR_BIT, 18)?,
            },
            "wrong-datapath" => Self::WrongDatapath,
            _ => return Ok(None),
        }))
    }
}

/// Parameters by key, as in `bit=5,value=1`.
pub type Parameters = BTreeMap<String, String>;

/// Takes a number out of the parameters.
fn number<T: TryFrom<i64>>(from: &mut Parameters, limits: &Limits, default: T) -> Result<T, ValueError> {
    from.remove(limits.key()).map_or(Ok(default), |text| limits.parse(&text))
}

/// Takes one of the `known` words out of the parameters.
fn word<T: Copy>(
    from: &mut Parameters,
    key: &'static str,
    known: &[(&'static str, T)],
    default: T,
) -> Result<T, ValueError> {
    from.remove(key).map_or(Ok(default), |text| parse_word(key, &text, known))
}
