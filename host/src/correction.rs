//! Frames corrected by a board, unjudged: upload, stream, collect.

use std::ops::{ControlFlow, RangeInclusive};
use std::sync::Arc;

use halfrow_model::{Frame, Kernel, TableSet};

use crate::board::{Board, BoardError, NumberedFrame, ReturnedRow, RowTiming, RowTraffic};
use crate::progress::Progress;

/// What a board is to correct with.
#[derive(Clone, Copy)]
pub struct Correction<'a> {
    /// The row factors.
    pub tables: &'a TableSet,
    /// The kernel.
    pub kernel: &'a Kernel,
    /// Their generation, 1 to 255.
    pub generation: u8,
    /// The number of the first frame on the wire; higher than that of any frame that the session streamed before.
    pub first_frame: u16,
}

/// What came back.
#[derive(Clone, Debug)]
pub struct Corrected {
    /// The samples of each frame, row after row, in the order of the inputs. A broken board can exceed the depth.
    pub samples: Vec<Vec<u16>>,
    /// The least and the most pixel clocks that a row's first and last sample took.
    pub latency: RangeInclusive<u16>,
}

impl Correction<'_> {
    /// Uploads tables and kernel, streams `inputs` with the least blanking that the board can do, and collects what comes
    /// back.
    ///
    /// # Errors
    /// [`BoardError`] when the board refuses, does not answer, or keeps a row.
    pub fn run(
        &self,
        board: &mut Board,
        inputs: &[Arc<Frame>],
        progress: &dyn Progress,
    ) -> Result<Corrected, BoardError> {
        board.start_afresh()?;
        board.configure(self.tables.geometry(), RowTiming::default())?;
        board.upload(self.tables, self.kernel)?;
        board.commit(self.tables, self.kernel, self.first_frame, self.generation)?;
        let mut collect = Collect {
            first: self.first_frame,
            waiting: inputs.iter().enumerate(),
            samples: inputs.iter().map(|frame| vec![0; frame.samples().len()]).collect(),
            latency: None,
            progress,
        };
        board.stream(&mut collect)?;
        let Collect { samples, latency, .. } = collect;
        Ok(Corrected { samples, latency: latency.unwrap_or(0..=0) })
    }
}

/// Keeps what comes back.
struct Collect<'a> {
    first: u16,
    waiting: std::iter::Enumerate<std::slice::Iter<'a, Arc<Frame>>>,
    samples: Vec<Vec<u16>>,
    latency: Option<RangeInclusive<u16>>,
    progress: &'a dyn Progress,
}

impl RowTraffic for Collect<'_> {
    fn next_frame(&mut self) -> Option<NumberedFrame> {
        let (index, frame) = self.waiting.next()?;
        Some(NumberedFrame { number: self.first + index as u16, frame: Arc::clone(frame) })
    }

    fn returned(&mut self, row: &ReturnedRow<'_>) -> ControlFlow<()> {
        let start = row.row * row.samples.len();
        let index = usize::from(row.frame.wrapping_sub(self.first));
        if let Some(place) =
            self.samples.get_mut(index).and_then(|samples| samples.get_mut(start..start + row.samples.len()))
        {
            place.copy_from_slice(row.samples);
        }
        let (least, most) =
            (row.first_latency.min(row.last_latency), row.first_latency.max(row.last_latency));
        self.latency = Some(match self.latency.take() {
            Some(seen) => least.min(*seen.start())..=most.max(*seen.end()),
            None => least..=most,
        });
        self.progress.row();
        ControlFlow::Continue(())
    }
}
