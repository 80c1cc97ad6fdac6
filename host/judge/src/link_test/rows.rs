//! Both directions together: rows, which nobody judges.

use std::sync::Arc;
use std::time::Duration;

use halfrow_model::{BitDepth, Frame, Geometry, Interpolant, Kernel, Phase, RowFactor, TableSet};
use rand_core::Rng;

use super::{LinkTestError, Test, Throughput};
use crate::board::{Board, BoardError, NumberedFrame, RowTiming, Unjudged};
use crate::tables::datapath_of;

/// Rows of a frame. After the last one the core runs empty, which costs half a row.
const HEIGHT: u16 = 64;
/// The most frames that are streamed without checking the clock.
const MOST_FRAMES: f64 = 1000.0;

impl Test<'_> {
    pub(super) fn together(&mut self) -> Result<Throughput, LinkTestError> {
        let frame = Arc::new(self.frame().map_err(LinkTestError::NoFrame)?);
        let tables = straight_tables(&frame).map_err(LinkTestError::NoFrame)?;
        self.set(&tables)?;
        let mut number = 0;
        // The first frame also fills the pipe, so its time shows how many frames there is time for.
        let first = self.stream(&frame, &mut number, 1)?;
        let frames = self.seconds.as_secs_f64() / first.as_secs_f64().max(1e-6);
        let begun = self.begin_part();
        self.stream(&frame, &mut number, frames.clamp(1.0, MOST_FRAMES) as u16)?;
        Ok(self.throughput(&begun))
    }

    /// Random samples, as wide and deep as the board takes them.
    fn frame(&mut self) -> Result<Frame, Box<dyn std::error::Error + Send + Sync>> {
        let (width, height) = size(self.board);
        let depths = self.board.capabilities.sample_depths();
        let depth = BitDepth::ALL.into_iter().rev().find(|depth| depths.has(depth.bits() as u8));
        let depth = depth.ok_or("it has no sample depth")?;
        let samples = (0..width * height).map(|_| self.random.next_u32() as u16 & depth.max()).collect();
        Ok(Frame::new(width, depth, Phase::Grbg, samples)?)
    }

    fn set(&mut self, tables: &TableSet) -> Result<(), BoardError> {
        self.board.configure(tables.geometry(), RowTiming::default(), datapath_of(tables))?;
        let kernel = Kernel::from(Interpolant::Hermite);
        self.board.upload(tables, &kernel)?;
        self.board.commit(tables, &kernel, 0, 1)
    }

    /// Streams `frame` as often as `times` says. Returns the time by the slower of the two clocks.
    fn stream(&mut self, frame: &Arc<Frame>, number: &mut u16, times: u16) -> Result<Duration, BoardError> {
        let begun = self.begin();
        let numbers = (0..times).map(|index| number.wrapping_add(index));
        let frames = numbers.map(|number| NumberedFrame { number, frame: Arc::clone(frame) });
        self.board.stream(&mut Unjudged(frames))?;
        *number = number.wrapping_add(times);
        Ok(begun.on_wall.elapsed().max(self.since(&begun)))
    }
}

fn size(board: &Board) -> (usize, usize) {
    let capabilities = &board.capabilities;
    (usize::from(capabilities.max_width & !1), usize::from(capabilities.max_height.min(HEIGHT)))
}

/// Tables that leave every row as it is.
fn straight_tables(frame: &Frame) -> Result<TableSet, Box<dyn std::error::Error + Send + Sync>> {
    let geometry = Geometry::centred(frame.width(), frame.height(), frame.depth())?;
    Ok(TableSet::new(geometry, vec![RowFactor::ONE; frame.height()])?)
}
