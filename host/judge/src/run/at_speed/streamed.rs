//! A frame that was wrong at speed, streamed row by row: whether it is a matter of speed.

use std::ops::ControlFlow;
use std::sync::Arc;

use halfrow_model::Content;

use crate::board::{NumberedFrame, ReturnedRow, RowTraffic};
use crate::run::plan::Generation;
use crate::run::steps::Run;

/// A frame that is kept as it comes back, up to where it is known to be right, or else to its end.
struct UntilRight<'a> {
    frame: Option<NumberedFrame>,
    samples: Vec<u16>,
    /// What the first rows must be.
    right: &'a [u16],
    /// Samples that have come.
    came: usize,
}

impl RowTraffic for UntilRight<'_> {
    fn next_frame(&mut self) -> Option<NumberedFrame> {
        self.frame.take()
    }

    fn returned(&mut self, row: &ReturnedRow<'_>) -> ControlFlow<()> {
        let start = row.row * row.samples.len();
        if let Some(place) = self.samples.get_mut(start..start + row.samples.len()) {
            place.copy_from_slice(row.samples);
            self.came += row.samples.len();
        }
        let is_right = self.came == self.right.len() && self.samples.starts_with(self.right);
        if is_right { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

impl Run<'_> {
    /// What comes back of the frame of `content`, by the tables of `generation` and the settings that the board has: no more than the
    /// first rows if these are `right`; none if they do not come.
    pub(super) fn streamed(
        &mut self,
        generation: &Generation,
        content: Content,
        right: &[u16],
    ) -> Option<Vec<u16>> {
        let frame = content.frame(generation.tables.geometry(), self.plan.phase);
        let samples = vec![0; frame.samples().len()];
        let frame = Some(NumberedFrame { number: content.frame, frame: Arc::new(frame) });
        let mut rows = UntilRight { frame, samples, right, came: 0 };
        // Others of the frame may be under way behind the last that matters.
        let streamed = self.board.stream(&mut rows).and_then(|()| self.board.drop_rows());
        let streamed = streamed.inspect_err(|error| tracing::warn!("the frame was not streamed: {error}"));
        streamed.ok().map(|()| rows.samples)
    }
}
