//! Streams a frame that was wrong at speed row by row, to see whether speed matters.

use std::ops::ControlFlow;
use std::sync::Arc;

use halfrow_model::Content;

use crate::board::{BoardError, NumberedFrame, ReturnedRow, RowTraffic};
use crate::progress::Progress;
use crate::result::{Problem, Streamed};
use crate::run::steps::Run;
use crate::tables::Generation;

/// Rows after a wrong one, which tell a fault of this row from one of all rows. More rows say little more, and take
/// minutes on a slow link.
const FURTHER: usize = 64;

/// A frame whose first rows are kept as they come back.
struct FirstRows<'a> {
    frame: Option<NumberedFrame>,
    /// What the first rows must be. If they are, no further ones are wanted.
    right: &'a [u16],
    /// The samples of all rows that are wanted if they are not.
    samples: Vec<u16>,
    /// How many samples have come.
    came: usize,
    progress: &'a dyn Progress,
}

impl RowTraffic for FirstRows<'_> {
    fn next_frame(&mut self) -> Option<NumberedFrame> {
        self.frame.take()
    }

    fn returned(&mut self, row: &ReturnedRow<'_>) -> ControlFlow<()> {
        let start = row.row * row.samples.len();
        if let Some(place) = self.samples.get_mut(start..start + row.samples.len()) {
            place.copy_from_slice(row.samples);
            self.came += row.samples.len();
        }
        self.progress.row();
        if self.came == self.right.len() {
            if self.samples.starts_with(self.right) {
                return ControlFlow::Break(());
            }
            let further = self.samples.len() - self.came;
            self.progress.rows_expected((further / row.samples.len()) as u64);
        }
        if self.came < self.samples.len() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }
}

impl Run<'_> {
    /// What comes back of the frame of `content` with the tables of `generation` and the board's present settings: the
    /// first rows and, unless these are `right`, [`FURTHER`] more; why not, if they do not come.
    pub(super) fn first_rows_streamed(
        &mut self,
        generation: &Generation,
        content: Content,
        right: &[u16],
    ) -> Result<Vec<u16>, Streamed> {
        let geometry = generation.tables.geometry();
        let frame = content.frame(geometry, self.plan.phase);
        let wanted = (right.len() + FURTHER * geometry.width()).min(frame.samples().len());
        self.progress.frame("the frame that was wrong at speed, streamed");
        self.progress.rows_expected((right.len() / geometry.width()) as u64);
        let frame = Some(NumberedFrame { number: content.frame, frame: Arc::new(frame) });
        let mut rows = FirstRows { frame, right, samples: vec![0; wanted], came: 0, progress: self.progress };
        // More rows of the frame may be under way after the last wanted one.
        let streamed = self.board.stream(&mut rows).and_then(|()| self.board.drop_rows());
        streamed.map(|()| rows.samples).map_err(|error| {
            // What an error asks for is asked by somebody who does not judge the board yet.
            tracing::warn!("the frame was not streamed: {}", Problem::of(&error).unasked());
            match error {
                BoardError::RowMissing { place, .. } => Streamed::RowLost { row: place.row },
                _ => Streamed::NotTried,
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;
    use crate::progress::Event;

    const WIDTH: usize = 4;

    /// How many of nine rows of `sample` are taken if two rows of 1 are right and three more are wanted otherwise, and
    /// what progress reports besides the rows.
    fn taken(sample: u16) -> (usize, Vec<Event>) {
        let told = Mutex::new(Vec::new());
        let progress = |event| told.lock().unwrap().push(event);
        let right = [1; 2 * WIDTH];
        let samples = vec![0; 5 * WIDTH];
        let mut rows = FirstRows { frame: None, right: &right, samples, came: 0, progress: &progress };
        let taken = (0..9).position(|row| {
            let samples = &[sample; WIDTH];
            let (first_latency, last_latency) = (14, 14);
            let returned = ReturnedRow {
                frame: 0,
                row,
                generation: 0,
                first_latency,
                last_latency,
                pauses: 0,
                repeats: 0,
                entered: None,
                samples,
            };
            rows.returned(&returned).is_break()
        });
        let told = told.into_inner().unwrap();
        (taken.unwrap() + 1, told.into_iter().filter(|event| *event != Event::Rows(1)).collect())
    }

    #[test]
    fn no_more_of_a_frame_is_taken_than_tells_something() {
        assert_eq!(taken(1), (2, Vec::new()));
        assert_eq!(taken(9), (5, vec![Event::RowsExpected(3)]));
    }
}
