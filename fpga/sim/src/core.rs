//! The core alone, clock by clock.

use crate::ffi::{self, CoreInputs, CoreOutputs, Design};

/// A build of the core.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoreBuild {
    /// Seven taps, a ring of 2048 samples, two banks of tables.
    SevenTaps,
    /// The same with five taps.
    FiveTaps,
    /// Seven taps and a ring of 128 samples, so that it wraps in every row.
    ShortRing,
    /// The same with five taps.
    ShortRingFiveTaps,
}

impl CoreBuild {
    /// All builds.
    pub const ALL: [Self; 4] = [Self::SevenTaps, Self::FiveTaps, Self::ShortRing, Self::ShortRingFiveTaps];

    /// Whether the build has the outer taps.
    #[must_use]
    pub fn has_outer_taps(self) -> bool {
        matches!(self, Self::SevenTaps | Self::ShortRing)
    }

    /// L: pixel clocks beyond half a row until an output leaves.
    #[must_use]
    pub fn latency(self) -> u8 {
        if self.has_outer_taps() { 12 } else { 11 }
    }

    /// M: samples in the ring.
    #[must_use]
    pub fn ring(self) -> u16 {
        if matches!(self, Self::ShortRing | Self::ShortRingFiveTaps) { 128 } else { 2048 }
    }
}

/// `halfrow_core` under simulation.
pub struct Core(Design<CoreInputs, CoreOutputs>);

impl Core {
    /// A core that has not been reset. `seed` draws the contents of its registers and memories.
    #[must_use]
    pub fn new(build: CoreBuild, seed: u32) -> Self {
        let functions = match build {
            CoreBuild::SevenTaps => &ffi::halfrow_core7,
            CoreBuild::FiveTaps => &ffi::halfrow_core5,
            CoreBuild::ShortRing => &ffi::halfrow_core_short,
            CoreBuild::ShortRingFiveTaps => &ffi::halfrow_core_short5,
        };
        Self(Design::new(functions, seed))
    }

    /// One clock. Returns what registers at the core's outputs sample at its edge.
    pub fn clock(&mut self, inputs: &CoreInputs) -> CoreOutputs {
        self.0.clock(inputs)
    }
}
