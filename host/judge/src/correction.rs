//! Frames corrected by a board, unjudged: upload, stream, collect.

use std::collections::VecDeque;
use std::num::NonZeroU8;
use std::ops::{ControlFlow, RangeInclusive};
use std::sync::Arc;

use halfrow_model::{CorrectError, Frame, Kernel, TableSet};

use crate::board::{Board, BoardError, NumberedFrame, ReturnedRow, RowTiming, RowTraffic};
use crate::progress::Progress;
use crate::run::{Misfit, check_fit};
use crate::tables::datapath_of;

/// Why a board did not correct all frames.
#[derive(Debug, thiserror::Error)]
pub enum CorrectionError {
    /// The board cannot take the tables or the kernel.
    #[error(transparent)]
    Misfit(#[from] Misfit),
    /// A frame has another size or depth than the tables are for.
    #[error(transparent)]
    Frame(#[from] CorrectError),
    /// The board refuses, does not answer, or does not return a row.
    #[error(transparent)]
    Board(#[from] BoardError),
}

/// What a board corrects frames with.
#[derive(Clone, Copy, Debug)]
pub struct Correction<'a> {
    /// Row factors or a grid.
    pub tables: &'a TableSet,
    /// The kernel.
    pub kernel: &'a Kernel,
    /// Their generation.
    pub generation: NonZeroU8,
    /// The number of the first frame on the wire, higher than that of any frame streamed in this session before.
    pub first_frame: u16,
}

impl Correction<'_> {
    /// Uploads tables and kernel, then streams `inputs` with the least blanking that the board needs for them. Hands the samples
    /// of each corrected frame, row after row, to `take`, in the order of the inputs, until `take` breaks. The samples of a
    /// broken board can exceed the depth. Returns the least and the most pixel clocks that a row's first and last samples took.
    ///
    /// # Errors
    /// [`CorrectionError::Misfit`] before anything is sent, as [`check_fit`] finds it; [`CorrectionError::Frame`] for the first
    /// input that the tables are not for, once those before it were taken; [`CorrectionError::Board`].
    pub fn run(
        &self,
        board: &mut Board,
        inputs: impl Iterator<Item = Arc<Frame>>,
        take: impl FnMut(Vec<u16>) -> ControlFlow<()>,
        progress: &dyn Progress,
    ) -> Result<RangeInclusive<u16>, CorrectionError> {
        check_fit(self.tables, self.kernel, board.capabilities())?;
        board.start_afresh()?;
        board.configure(self.tables.geometry(), RowTiming::default(), datapath_of(self.tables))?;
        board.upload(self.tables, self.kernel)?;
        board.commit(self.tables, self.kernel, self.first_frame, self.generation.get())?;
        let mut collect = Collect {
            tables: self.tables,
            unfit: None,
            next: self.first_frame,
            inputs,
            under_way: VecDeque::new(),
            take,
            latency: None,
            progress,
        };
        board.stream(&mut collect)?;
        match collect.unfit {
            Some(unfit) if collect.under_way.is_empty() => Err(unfit.into()),
            _ => Ok(collect.latency.unwrap_or(0..=0)),
        }
    }
}

/// A frame that has not come back completely.
struct UnderWay {
    number: u16,
    samples: Vec<u16>,
    rows_left: usize,
}

/// Collects returned rows until a frame is complete.
struct Collect<'a, I, T> {
    tables: &'a TableSet,
    /// Why the last frame of `inputs` was not streamed.
    unfit: Option<CorrectError>,
    /// The number of the next frame.
    next: u16,
    inputs: I,
    under_way: VecDeque<UnderWay>,
    take: T,
    latency: Option<RangeInclusive<u16>>,
    progress: &'a dyn Progress,
}

impl<I, T> RowTraffic for Collect<'_, I, T>
where
    I: Iterator<Item = Arc<Frame>>,
    T: FnMut(Vec<u16>) -> ControlFlow<()>,
{
    fn next_frame(&mut self) -> Option<NumberedFrame> {
        let (number, frame) = (self.next, self.inputs.next()?);
        if let Err(unfit) = self.tables.check_frame(&frame) {
            self.unfit = Some(unfit);
            return None;
        }
        self.next = number.wrapping_add(1);
        let samples = vec![0; frame.samples().len()];
        self.under_way.push_back(UnderWay { number, samples, rows_left: frame.height() });
        Some(NumberedFrame { number, frame })
    }

    fn returned(&mut self, row: &ReturnedRow<'_>) -> ControlFlow<()> {
        let start = row.row * row.samples.len();
        if let Some(frame) = self.under_way.iter_mut().find(|frame| frame.number == row.frame)
            && let Some(place) = frame.samples.get_mut(start..start + row.samples.len())
        {
            place.copy_from_slice(row.samples);
            frame.rows_left -= 1;
        }
        let (least, most) =
            (row.first_latency.min(row.last_latency), row.first_latency.max(row.last_latency));
        self.latency = Some(match self.latency.take() {
            Some(seen) => least.min(*seen.start())..=most.max(*seen.end()),
            None => least..=most,
        });
        self.progress.row();
        while let Some(whole) = self.under_way.pop_front_if(|frame| frame.rows_left == 0) {
            (self.take)(whole.samples)?;
        }
        ControlFlow::Continue(())
    }
}
