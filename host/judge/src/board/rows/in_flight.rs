//! The frames of a stream that still have rows under way, and where a row of the stream belongs.

use std::collections::VecDeque;

use halfrow_model::Frame;
use halfrow_protocol::message::RowPlace;

use super::NumberedFrame;

pub(super) struct InFlight {
    /// The row sequence number of the stream's first row.
    first_row: u32,
    /// Rows of a frame; 0 before the first frame.
    height: u32,
    frames: VecDeque<NumberedFrame>,
    /// Frames of the stream that are no longer kept.
    frames_done: u32,
}

/// A row of a frame.
pub(super) struct Row<'a> {
    pub(super) frame: &'a Frame,
    pub(super) index: usize,
    pub(super) place: RowPlace,
}

impl InFlight {
    pub(super) fn new(first_row: u32) -> Self {
        Self { first_row, height: 0, frames: VecDeque::new(), frames_done: 0 }
    }

    pub(super) fn add(&mut self, frame: NumberedFrame) {
        self.height = frame.frame.height() as u32;
        self.frames.push_back(frame);
    }

    /// The row sequence number after the last row of the frames that were added.
    pub(super) fn end(&self) -> u32 {
        self.first_row + (self.frames_done + self.frames.len() as u32) * self.height
    }

    /// Samples of a row.
    pub(super) fn width(&self) -> usize {
        self.frames.front().map_or(0, |frame| frame.frame.width())
    }

    /// The row with this number, unless its frame is no longer kept.
    pub(super) fn row(&self, row_sequence: u32) -> Option<Row<'_>> {
        let row = row_sequence.checked_sub(self.first_row)?;
        let frame = row.checked_div(self.height)?.checked_sub(self.frames_done)?;
        let NumberedFrame { number, frame } = self.frames.get(frame as usize)?;
        let index = (row % self.height) as usize;
        let place = RowPlace {
            row_sequence,
            frame: *number,
            row: index as u16,
            width: frame.width() as u16,
            last: index + 1 == frame.height(),
        };
        Some(Row { frame, index, place })
    }

    /// Drops the frames whose rows all lie before `missing`. The last frame stays, since it gives the width of the next rows.
    pub(super) fn forget_before(&mut self, missing: u32) {
        while self.frames.len() > 1 && missing - self.first_row >= (self.frames_done + 1) * self.height {
            self.frames.pop_front();
            self.frames_done += 1;
        }
    }
}
