//! The link of a simulated board, of whatever kind.

use std::path::Path;

use crate::board::Failure;

/// The result of a step.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Step {
    /// Whether the byte that was offered has been taken.
    pub(crate) taken: bool,
    /// A byte from the board.
    pub(crate) sent: Option<u8>,
    /// Whether nothing is under way, as far as can be seen from outside.
    pub(crate) quiet: bool,
}

/// A design and the far end of its link.
pub(crate) trait Port: Send {
    /// After this many quiet steps in a row the design says nothing more on its own.
    const REST: u32;

    /// Lets one or both clocks rise. `offered` is the next byte for the board; `millisecond` says that one has passed.
    fn step(&mut self, offered: Option<u8>, millisecond: bool) -> Result<Step, Failure>;

    /// Resets the design.
    fn reset(&mut self);

    /// From now on writes a waveform to `path`. Returns whether the file could be opened.
    fn trace(&mut self, path: &Path) -> bool;

    /// Whether all of the waveform until now is in its file; true if there is none.
    fn is_traced(&mut self) -> bool;
}

/// Two unrelated clocks.
#[derive(Debug)]
pub(crate) struct Clocks {
    link: Clock,
    core: Clock,
}

#[derive(Debug)]
struct Clock {
    /// In picoseconds.
    period: u64,
    next: u64,
}

/// Which clocks rise, and when.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    pub(crate) link: bool,
    pub(crate) core: bool,
    /// In picoseconds.
    pub(crate) at: u64,
}

impl Clocks {
    /// 96 MHz for the link, and 74.25 MHz for the core, as a sensor might give it.
    pub(crate) fn new() -> Self {
        Self { link: Clock { period: 10_417, next: 0 }, core: Clock { period: 13_468, next: 0 } }
    }

    pub(crate) fn next(&mut self) -> Edge {
        let at = self.link.next.min(self.core.next);
        Edge { link: self.link.rises(at), core: self.core.rises(at), at }
    }
}

impl Clock {
    fn rises(&mut self, at: u64) -> bool {
        let rises = self.next == at;
        self.next += if rises { self.period } else { 0 };
        rises
    }
}
