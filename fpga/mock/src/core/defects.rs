//! What a fault does to the core's wires.

use super::source::DROPPED_HALF;
use super::weights::{ROUNDING, Weighing};
use super::window::TAPS;
use crate::faults::Misread;

/// Lines of a bus that are stuck at 0 or at 1; none by default.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StuckBits {
    free: u16,
    high: u16,
}

impl Default for StuckBits {
    fn default() -> Self {
        Self { free: u16::MAX, high: 0 }
    }
}

impl StuckBits {
    /// A bus with one line stuck. A line that the bus does not have changes nothing.
    pub(crate) fn one(bit: u8, value: bool) -> Self {
        let line = 1_u16.checked_shl(bit.into()).unwrap_or(0);
        Self { free: !line, high: if value { line } else { 0 } }
    }

    /// What arrives at the far end of the bus.
    pub(crate) fn apply(self, value: u16) -> u16 {
        (value & self.free) | self.high
    }
}

/// A tap that does not carry its own sample.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DeadTap {
    /// The tap, 0 for G0 to 6 for G6.
    pub(crate) tap: u8,
    /// The tap whose sample it carries instead; none for zero.
    pub(crate) reads: Option<u8>,
}

impl DeadTap {
    /// The taps with the dead one replaced by another tap's sample, or by zero.
    fn apply(self, mut taps: [i32; TAPS]) -> [i32; TAPS] {
        let sample = self.reads.and_then(|other| taps.get(usize::from(other)).copied()).unwrap_or(0);
        if let Some(tap) = taps.get_mut(usize::from(self.tap)) {
            *tap = sample;
        }
        taps
    }
}

/// The core's wiring: as specified by default; a fault breaks one part of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CoreDefects {
    /// Address lines of the line memory, for reading and for writing.
    pub(crate) address_lines: StuckBits,
    /// Data lines of the line memory.
    pub(crate) data_lines: StuckBits,
    /// Columns by which the window's read address is off.
    pub(crate) tap_offset: i32,
    /// Added to the weighted sum before its fraction is dropped.
    pub(crate) rounding: i32,
    /// A tap that does not carry its own sample.
    pub(crate) dead_tap: Option<DeadTap>,
    /// Added to a source coordinate before its last bits are dropped.
    pub(crate) source_rounding: u64,
    /// How weights come from the kernel.
    pub(crate) weighing: Weighing,
    /// Whether the nearest sample stands in beyond a row's ends, whatever its colour.
    pub(crate) nearest_edge: bool,
    /// Pixel clocks by which the pipeline is longer than it claims to be.
    pub(crate) extra_delay: u32,
}

impl CoreDefects {
    /// What the taps carry.
    #[inline]
    pub(crate) fn taps(&self, taps: [i32; TAPS]) -> [i32; TAPS] {
        self.dead_tap.map_or(taps, |dead| dead.apply(taps))
    }

    /// Does what a misread sentence says, as far as it is about the core.
    pub(crate) fn misread(&mut self, misread: Misread) {
        match misread {
            Misread::UnsignedWeights => self.weighing = Weighing::Unsigned,
            Misread::WeightsTowardZero => self.weighing = Weighing::TowardZero,
            Misread::NextNode => self.weighing = Weighing::NextNode,
            Misread::UnroundedSource => self.source_rounding = 0,
            Misread::NearestEdge => self.nearest_edge = true,
            Misread::ReversedPairs | Misread::ReversedEntries | Misread::LongRuns => {}
        }
    }

    /// The output for a weighted sum.
    pub(crate) fn output(&self, sum: i32, largest: i32) -> u16 {
        sum.clamp(0, largest) as u16
    }
}

impl Default for CoreDefects {
    fn default() -> Self {
        Self {
            address_lines: StuckBits::default(),
            data_lines: StuckBits::default(),
            tap_offset: 0,
            rounding: ROUNDING,
            dead_tap: None,
            source_rounding: DROPPED_HALF,
            weighing: Weighing::default(),
            nearest_edge: false,
            extra_delay: 0,
        }
    }
}
