//! A simulated board's link, whatever it is made of.

use std::path::Path;

use crate::board::Failure;

/// What came of a step.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Step {
    /// The byte that was offered is on its way.
    pub(crate) taken: bool,
    /// A byte from the board.
    pub(crate) sent: Option<u8>,
    /// Nothing is under way, as far as can be seen from outside.
    pub(crate) quiet: bool,
}

/// A design with the far end of its link.
pub(crate) trait Port: Send {
    /// Steps without anything under way after which nothing more will come of itself.
    const REST: u32;

    /// Lets some clock rise. `offered` is the next byte for the board; `millisecond` says that one has passed.
    fn step(&mut self, offered: Option<u8>, millisecond: bool) -> Result<Step, Failure>;

    /// Resets the design.
    fn reset(&mut self);

    /// Writes a waveform from now on. Returns whether the file could be opened.
    fn trace(&mut self, path: &Path) -> bool;
}

/// Two clocks that know nothing of each other.
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
    /// 96 MHz for the link, and the core's as a sensor would give it: 74.25 MHz.
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
