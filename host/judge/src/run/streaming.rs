//! Frames through the board, segment by segment.

use std::iter;
use std::sync::mpsc::Receiver;

use super::findings::{End, chain};
use super::judge::{Judge, Manner};
use super::plan::{SENSOR_BLANKING, ScheduledFrame, Segment, Timing};
use super::prepared::{PrepareError, Prepared};
use super::steps::{MAX_LATENCY, Run};
use crate::board::{BoardError, NumberedFrame, Unjudged};
use crate::verdict::Cause;

/// A frame and the row in which it happened twice that a row did not come back.
struct LostTwice {
    row: u16,
}

impl Run<'_> {
    /// Streams a segment, whose frames are the next ones of `source`, and judges what comes back.
    pub(super) fn stream(
        &mut self,
        segment: &Segment,
        source: &Receiver<Result<Prepared, PrepareError>>,
    ) -> Result<(), End> {
        let (manner, timing) = (self.manner(), self.timing(segment.timing));
        // The judge has what is seen while the run has the board, and what it has to say of its link.
        let mut seen = std::mem::take(&mut self.findings.seen);
        let frames = source.iter().take(segment.frames.len());
        let mut judge = Judge::new(frames, &mut seen, manner, timing, self.progress);
        let streamed = self.stream_to_the_end(segment, &mut judge);
        let prepared = judge.finish();
        self.findings.seen = seen;
        streamed?;
        prepared.map_err(|error| End::error("frames", Cause::Station, chain(&error)))?;
        if self.plan.fail_fast && self.findings.seen.differences() > 0 {
            self.board.drop_rows().map_err(|error| End::board("frames", &error))?;
        }
        Ok(())
    }

    fn stream_to_the_end(&mut self, segment: &Segment, judge: &mut Judge<'_>) -> Result<(), End> {
        while let Err(error) = self.board.stream(judge) {
            let end = self.interrupted(segment, error);
            self.return_to(segment, judge.frames_done(), end)?;
            judge.begin_again();
        }
        self.findings.rows_counted += judge.rows;
        Ok(())
    }

    fn manner(&self) -> Manner {
        let half = self.plan.tables.geometry().width() as u32 / 2;
        Manner {
            claimed_latency: half + u32::from(self.board.capabilities.latency),
            latency_limit: half + u32::from(MAX_LATENCY),
            fail_fast: self.plan.fail_fast,
            keep_equal: self.options.keep_equal,
            evidence_bytes: self.options.evidence_bytes,
        }
    }

    fn timing(&self, timing: Timing) -> String {
        match timing {
            Timing::Least => format!("least blanking ({} clocks)", self.board.capabilities.least_blanking),
            Timing::Sensor => format!("{SENSOR_BLANKING} clocks of blanking"),
            Timing::Gaps(seed) => format!("gaps, seed {seed}"),
        }
    }

    /// A row did not come back, or the link broke. A row that a board swallows is the board's fault only when the link is
    /// proven clean and it happens again.
    fn interrupted(&mut self, segment: &Segment, error: BoardError) -> End {
        let place = match error {
            BoardError::RowMissing { place, .. } => place,
            BoardError::WrongPlace { .. } => {
                let remedy = "Check how the board keeps a row's place with its samples.";
                return End::failed("frames", error.to_string(), remedy);
            }
            other => return End::board("frames", &other),
        };
        let frame = segment.frames.iter().find(|frame| frame.number == place.frame);
        match frame.map(|frame| self.lost_again(frame)) {
            Some(Ok(Some(LostTwice { row }))) => End::failed(
                "frames",
                format!(
                    "row {} of frame {} went into the board and never came out; played again, row {row} was lost, \
                     and the link is clean",
                    place.row, place.frame
                ),
                "Check the row banks and the row player: the board took the row and lost it inside.",
            ),
            Some(Err(other)) => End::board("frames", &other),
            Some(Ok(None)) | None => End::board("frames", &error),
        }
    }

    /// Plays a frame again. Returns nothing if the link may have lost the row, or if all rows come back this time.
    fn lost_again(&mut self, frame: &ScheduledFrame) -> Result<Option<LostTwice>, BoardError> {
        self.board.drop_rows()?;
        self.board.status(true)?;
        let damaged = self.board.tally().damaged_in;
        let Ok(frame) =
            self.plan.render(frame).map(|input| NumberedFrame { number: frame.number, frame: input })
        else {
            return Ok(None);
        };
        let place = match self.board.stream(&mut Unjudged(iter::once(frame))) {
            Err(BoardError::RowMissing { place, .. }) => place,
            Err(error) => return Err(error),
            Ok(()) => return Ok(None),
        };
        let status = self.board.status(false)?;
        let link_is_clean =
            status.crc_errors + status.framing_errors == 0 && self.board.tally().damaged_in == damaged;
        let went_in = status.next_row_in > place.row_sequence;
        Ok((link_is_clean && went_in).then_some(LostTwice { row: place.row }))
    }
}
