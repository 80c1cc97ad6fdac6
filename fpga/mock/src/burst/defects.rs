//! What a fault does to a board that runs at full speed, and only then.

use super::signer::RowInside;
use crate::gaps::draw;

/// A path that is too slow for samples that follow each other without a pause.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SlowPath {
    /// The output bit that flips.
    pub(crate) bit: u8,
    /// One in this many outputs flips, on average.
    pub(crate) one_in: u32,
    /// The seed of the draws.
    pub(crate) seed: u32,
}

/// An output bit that flips once the board is warm.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WarmBit {
    /// Frames since power-up that warm it.
    pub(crate) after: u32,
    /// The row whose first output has the flipped bit.
    pub(crate) row: u16,
    /// The bit.
    pub(crate) bit: u8,
}

/// What is wrong at full speed; nothing by default.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct BurstDefects {
    /// A bit flips at a given rate, in rows that follow another without a pause.
    pub(crate) slow_path: Option<SlowPath>,
    /// A bit flips once the board is warm.
    pub(crate) warm_bit: Option<WarmBit>,
    /// When frames follow each other as closely as they may, row 0 is made with the tables of the frame before.
    pub(crate) late_swap: bool,
    /// The row of every frame in which the output stands still for a clock that is not counted as a pause.
    pub(crate) hidden_pause: Option<u16>,
}

/// The state of the defects that spoil outputs.
#[derive(Debug)]
pub(super) struct Wear {
    defects: BurstDefects,
    spoils: bool,
    random: u32,
    /// Frames since the board was switched on.
    frames: u32,
}

impl Wear {
    pub(super) fn new(defects: BurstDefects) -> Self {
        // 0 is the one state that the generator never leaves.
        let random = defects.slow_path.map_or(0, |path| path.seed).max(1);
        let spoils = defects.slow_path.is_some() || defects.warm_bit.is_some();
        Self { defects, spoils, random, frames: 0 }
    }

    /// Counts a frame that has left.
    pub(super) fn count_frame(&mut self) {
        self.frames = self.frames.saturating_add(1);
    }

    /// Whether any output may be spoilt.
    #[inline]
    pub(super) fn spoils(&self) -> bool {
        self.spoils
    }

    /// An output of `row` as it leaves the board. `is_first` says whether it is the row's first.
    pub(super) fn spoil(&mut self, row: &RowInside, is_first: bool, sample: u16) -> u16 {
        let mut flips = 0;
        if let Some(SlowPath { bit, one_in, .. }) = self.defects.slow_path {
            self.random = draw(self.random);
            flips |= u16::from(row.follows && self.random.is_multiple_of(one_in)) << bit;
        }
        if let Some(WarmBit { after, row: number, bit }) = self.defects.warm_bit {
            flips |= u16::from(is_first && row.row == number && self.frames >= after) << bit;
        }
        sample ^ flips
    }

    /// Clocks by which the end of a row is late.
    pub(super) fn late_by(&self, row: u16) -> u64 {
        (self.defects.hidden_pause == Some(row)).into()
    }
}
