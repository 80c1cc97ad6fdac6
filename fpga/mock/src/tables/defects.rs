//! What a fault does to the tables.

use super::Port;
use crate::core::Weight;

/// What is wrong with tables; nothing by default.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TableDefects {
    /// A bit of an entry, whether row factor or grid entry, is flipped at some ports, in both banks.
    pub(crate) entry: Option<FlippedBit<u16>>,
    /// A bit of a kernel word is flipped at some ports, in both banks.
    pub(crate) word: Option<FlippedBit<(u8, Weight)>>,
    /// Rows are made with the tables before the last commit.
    pub(crate) stale: Option<Stale>,
    /// A bit of an entry flips while the board runs.
    pub(crate) drift: Option<Drift>,
    /// A commit is accepted whatever the tables read back as.
    pub(crate) unchecked: bool,
}

/// A bit of an entry that does not read as it was written.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FlippedBit<Entry> {
    /// Which entry.
    pub(crate) entry: Entry,
    /// The bit.
    pub(crate) bit: u8,
    /// Whether only the datapath sees it and reading back shows the right value.
    pub(crate) hidden: bool,
}

/// The generation that rows name when they are made with the tables before the last commit.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Stale {
    /// The old one, with which they are really made.
    Admitted,
    /// The new one.
    Hidden,
}

/// A bit of an entry that flips while the board runs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drift {
    /// Rows of the generation that are played before that.
    pub(crate) after: u32,
    /// The row of the factor, or the number of the grid's entry.
    pub(crate) entry: u16,
    /// The bit.
    pub(crate) bit: u8,
}

impl<Entry> FlippedBit<Entry> {
    /// Whether the bit is flipped at a port: at every port, or at the datapath's only.
    pub(super) fn shows(&self, port: Port) -> bool {
        !self.hidden || port == Port::Datapath
    }
}

/// A word with one bit flipped. A bit outside the word changes nothing.
pub(super) fn flipped(word: u32, bit: u8) -> u32 {
    word ^ 1_u32.checked_shl(bit.into()).unwrap_or(0)
}
