//! Where rows come from and where they go to.

use std::ops::ControlFlow;
use std::sync::Arc;

use halfrow_model::Frame;

/// A frame on its way to the board.
#[derive(Clone, Debug)]
pub struct NumberedFrame {
    /// Its number on the wire.
    pub number: u16,
    /// Its samples.
    pub frame: Arc<Frame>,
}

/// A row that came back.
#[derive(Clone, Copy, Debug)]
pub struct ReturnedRow<'a> {
    /// The number of its frame.
    pub frame: u16,
    /// The row of the frame.
    pub row: usize,
    /// The generation of the tables that made it.
    pub generation: u8,
    /// Pixel clocks from the first sample in to the first output.
    pub first_latency: u16,
    /// Pixel clocks from the last sample in to the last output.
    pub last_latency: u16,
    /// Board clocks for which gaps kept the enable off, from before its first sample to its last.
    pub pauses: u16,
    /// How often it was sent before.
    pub repeats: u16,
    /// The CRC-32 of its samples as they entered the core; meaningless if the board does not advertise it.
    pub entered: Option<u32>,
    /// Its samples.
    pub samples: &'a [u16],
}

/// Where rows come from and where they go to.
pub trait RowTraffic {
    /// The next frame to send, all of one size; none at the end.
    fn next_frame(&mut self) -> Option<NumberedFrame>;

    /// Takes a row that came back, each row once. Rows of a frame come in order unless the link lost one. Breaking ends the
    /// stream.
    fn returned(&mut self, row: &ReturnedRow<'_>) -> ControlFlow<()>;
}

/// Frames that only have to come back; their rows are not looked at.
#[derive(Clone, Debug)]
pub(crate) struct Unjudged<I>(pub(crate) I);

impl<I: Iterator<Item = NumberedFrame>> RowTraffic for Unjudged<I> {
    fn next_frame(&mut self) -> Option<NumberedFrame> {
        self.0.next()
    }

    fn returned(&mut self, _row: &ReturnedRow<'_>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}
