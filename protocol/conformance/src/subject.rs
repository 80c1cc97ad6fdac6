//! Boards as the suite sees them.

use std::time::Duration;

use halfrow_pipe::Endpoint;

/// A board, whatever it is made of.
pub trait Subject {
    /// What it sends when it gets these bytes at once, at the time `now` since it was switched on.
    fn answer(&mut self, bytes: &[u8], now: Duration) -> Vec<u8>;
}

impl<B: Endpoint> Subject for B {
    fn answer(&mut self, bytes: &[u8], now: Duration) -> Vec<u8> {
        self.receive(bytes, now).unwrap();
        std::mem::take(self.outgoing())
    }
}

/// What is fixed when a board is built, as CAPABILITIES reports it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Build {
    /// Pixel clocks L.
    pub latency: u8,
    /// 5 or 7.
    pub taps: u8,
    /// 1 or 2.
    pub table_banks: u8,
    /// How many rows can wait to be played, at least 2.
    pub row_banks_in: u8,
    /// How many played rows can wait to be acknowledged, at least 2.
    pub row_banks_out: u8,
    /// The fewest pixel clocks between two rows.
    pub least_blanking: u16,
    /// The widest row, in samples.
    pub max_width: u16,
    /// The most rows of a frame.
    pub max_height: u16,
    /// The depths that can be configured, in bits per sample.
    pub depths: &'static [u8],
}

impl Default for Build {
    /// The build that most tests ask for: L = 12, seven taps, two table banks, four row banks each way, frames of up to
    /// 2048 x 2048 samples, all depths.
    fn default() -> Self {
        Self {
            latency: 12,
            taps: 7,
            table_banks: 2,
            row_banks_in: 4,
            row_banks_out: 4,
            least_blanking: 0,
            max_width: 2048,
            max_height: 2048,
            depths: &[8, 10, 12],
        }
    }
}

/// Boards of one make.
pub trait Boards {
    /// Whether this build exists. The default build must exist.
    fn offers(&self, build: &Build) -> bool;

    /// A board of this build, just switched on. The build must be offered.
    fn switched_on(&self, build: &Build) -> Box<dyn Subject>;

    /// How many cases properties are tried with; the long ones use only a share of them.
    fn cases(&self) -> u32;
}
