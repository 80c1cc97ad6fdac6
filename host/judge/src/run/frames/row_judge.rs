//! Judges rows as they come back: place, generation, latency, every sample.

use std::collections::VecDeque;
use std::iter::Take;
use std::mem;
use std::ops::ControlFlow;
use std::sync::{Arc, mpsc};

use halfrow_model::{Frame, row_signature};

use super::entry::{WrongEntry, flipped_bit};
use super::frame_clock::FrameClock;
use super::in_flight::InFlight;
use super::kept::{Offered, as_found};
use super::observations::Observations;
use super::prepared::{PrepareError, Prepared};
use crate::board::{NumberedFrame, ReturnedRow, RowTraffic};
use crate::progress::Progress;
use crate::result::{Evidence, Finding, FrameReport, FrameTiming, MissingRows, Variation};

/// How rows are judged, and what is kept.
pub(crate) struct JudgeOptions {
    pub(crate) claimed_latency: u32,
    pub(crate) latency_limit: u32,
    pub(crate) fail_fast: bool,
    /// Keep equal frames for pictures too, not only for the diagnosis.
    pub(crate) keep_equal: bool,
    /// The most bytes of frames that are kept.
    pub(crate) evidence_bytes: usize,
    /// Whether the board signs what entered its core.
    pub(crate) names_entered: bool,
    pub(crate) timing: FrameTiming,
    /// The setting that the segment's frames try, if any.
    pub(crate) variation: Option<Variation>,
    /// The number of rows of its frames, if these are not whole.
    pub(crate) first_rows: Option<usize>,
    /// The board clocks for which gaps keep the enable off, for each row of a frame.
    pub(crate) pauses: Vec<u16>,
}

/// The frames of a segment.
type Source<'a> = Take<mpsc::Iter<'a, Result<Prepared, PrepareError>>>;

/// The judge of one segment.
pub(crate) struct RowJudge<'a> {
    source: Source<'a>,
    seen: &'a mut Observations,
    options: JudgeOptions,
    progress: &'a dyn Progress,
    unprepared: Option<PrepareError>,
    clock: FrameClock,
    in_flight: VecDeque<InFlight>,
    /// Frames in flight that must be sent again.
    again: VecDeque<NumberedFrame>,
    /// How many frames have come back whole.
    frames_done: usize,
    /// Rows that have come back since the stream last began.
    pub(crate) rows: usize,
    /// How often these rows had been sent before, as they say themselves.
    pub(crate) repeats: u32,
}

impl<'a> RowJudge<'a> {
    pub(crate) fn new(
        source: Source<'a>,
        seen: &'a mut Observations,
        options: JudgeOptions,
        progress: &'a dyn Progress,
    ) -> Self {
        Self {
            source,
            seen,
            options,
            progress,
            unprepared: None,
            clock: FrameClock::new(),
            in_flight: VecDeque::new(),
            again: VecDeque::new(),
            frames_done: 0,
            rows: 0,
            repeats: 0,
        }
    }

    /// How many frames of the segment have come back whole: the index of the first that has not.
    pub(crate) fn frames_done(&self) -> usize {
        self.frames_done
    }

    /// The finding that every row that came was late by as much, if so.
    pub(crate) fn all_late(&self) -> Option<Finding> {
        self.seen.all_late()
    }

    /// Whether something that came back is wrong.
    pub(crate) fn has_found(&self) -> bool {
        !self.seen.is_right() || self.in_flight.iter().any(InFlight::is_wrong)
    }

    /// Leaves what follows out of the frames' time until the stream begins again.
    pub(crate) fn pause(&mut self) {
        self.clock.pause();
    }

    /// Makes the stream begin again with the frames that have not come back whole. Rows that did come back are not judged
    /// twice.
    pub(crate) fn begin_again(&mut self) {
        self.clock.go_on();
        self.again = self.in_flight.iter().map(|frame| frame.prepared.numbered()).collect();
        (self.rows, self.repeats) = (0, 0);
    }

    /// Judges what came back of frames that did not come back whole.
    ///
    /// # Errors
    /// [`PrepareError`] when a frame could not be prepared, so that none after it was sent.
    pub(crate) fn finish(mut self) -> Result<(), PrepareError> {
        while let Some(frame) = self.in_flight.pop_front() {
            if frame.rows > 0 {
                self.frame_done(frame);
            }
        }
        self.unprepared.map_or(Ok(()), Err)
    }

    fn check_entry(&mut self, row: &ReturnedRow<'_>, input: &Frame) {
        if !self.options.names_entered {
            return;
        }
        self.seen.rows_with_entry += 1;
        let (sent, bits) = (input.row(row.row), input.depth().bits());
        if row.entered != Some(row_signature(sent)) {
            let first = || WrongEntry {
                rows: 0,
                row: row.row,
                frame: row.frame,
                flipped: row.entered.and_then(|entered| flipped_bit(sent, bits, entered)),
            };
            self.seen.wrong_entry.get_or_insert_with(first).rows += 1;
        }
    }

    fn check_pauses(&mut self, row: &ReturnedRow<'_>) {
        let expected = self.options.pauses.get(row.row).copied().unwrap_or_default();
        if row.pauses != expected {
            let (row, frame, counted) = (row.row, row.frame, row.pauses);
            self.seen.wrong_pauses.get_or_insert(Finding::GapsMiscounted { row, frame, counted, expected });
        }
    }

    /// A frame, wrong or not, as one that may be kept.
    fn offered<'n>(&self, frame: &'n InFlight) -> Offered<'n> {
        let Prepared { name, is_street, expected, .. } = &frame.prepared;
        Offered {
            name,
            // Rows that did not come back are black.
            differs: frame.is_wrong() || !frame.is_whole(),
            is_wanted: frame.is_wrong() || self.options.keep_equal || *is_street,
            is_pinned: *is_street && self.options.first_rows.is_none(),
            bytes: 3 * size_of_val(expected.samples()),
        }
    }

    fn frame_done(&mut self, mut frame: InFlight) {
        let (found, missing) = (mem::take(&mut frame.found), MissingRows::of(&frame.returned));
        let Prepared { input, expected, centre, .. } = &frame.prepared;
        self.seen.shown.note(input, expected, *centre);
        let (is_whole, budget) = (frame.is_whole(), self.options.evidence_bytes);
        let offered = self.offered(&frame);
        if is_whole || offered.is_wanted {
            let index = self.seen.frames.len();
            self.seen.evidence.offer(&offered, budget, || {
                let found = as_found(expected, found)?;
                let (input, expected) = (Frame::clone(input), Frame::clone(expected));
                Some(Evidence { index, input, found, expected, missing: missing.clone() })
            });
        }
        let InFlight { prepared, rows, comparison, .. } = frame;
        let Prepared { name, number, generation, sha256, input, .. } = prepared;
        let comparison = self.seen.evidence.shorten(comparison, is_whole, budget);
        self.seen.frames.push(FrameReport {
            name,
            number,
            sha256,
            phase: input.phase(),
            generation,
            timing: self.options.timing,
            variation: self.options.variation,
            first_rows: self.options.first_rows,
            comparison,
            rows,
            missing,
            seconds: self.clock.lap(),
        });
    }
}

impl RowTraffic for RowJudge<'_> {
    fn next_frame(&mut self) -> Option<NumberedFrame> {
        if let Some(frame) = self.again.pop_front() {
            return Some(frame);
        }
        let prepared = match self.source.next()? {
            Ok(prepared) => prepared,
            Err(error) => {
                self.unprepared = Some(error);
                return None;
            }
        };
        let numbered = prepared.numbered();
        self.progress.frame(&prepared.name);
        self.in_flight.push_back(InFlight::new(prepared));
        Some(numbered)
    }

    fn returned(&mut self, row: &ReturnedRow<'_>) -> ControlFlow<()> {
        self.rows += 1;
        self.repeats = self.repeats.saturating_add(row.repeats.into());
        let is_new = |frame: &InFlight| frame.prepared.number == row.frame && !frame.returned[row.row];
        let Some(place) = self.in_flight.iter().position(is_new) else {
            return ControlFlow::Continue(());
        };
        let JudgeOptions { claimed_latency, latency_limit, .. } = self.options;
        self.seen.note_latency(row, claimed_latency, latency_limit);
        self.check_pauses(row);
        let input = Arc::clone(&self.in_flight[place].prepared.input);
        self.check_entry(row, &input);
        self.progress.row();
        let frame = &mut self.in_flight[place];
        frame.returned[row.row] = true;
        if row.generation != frame.prepared.generation {
            let committed = frame.prepared.generation;
            self.seen.wrong_generation.get_or_insert(Finding::GenerationWrong {
                row: row.row,
                frame: row.frame,
                named: row.generation,
                committed,
            });
        }
        frame.comparison.row(row.row, frame.prepared.expected.row(row.row), row.samples);
        let width = row.samples.len();
        frame.found[row.row * width..][..width].copy_from_slice(row.samples);
        frame.rows += 1;
        let mut flow = ControlFlow::Continue(());
        while let Some(front) = self.in_flight.pop_front_if(|front| front.is_whole()) {
            if front.is_wrong() && self.options.fail_fast {
                flow = ControlFlow::Break(());
            }
            self.frame_done(front);
            self.frames_done += 1;
        }
        flow
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::{Receiver, channel};

    use halfrow_model::{BitDepth, Frame, Phase};

    use super::*;
    use crate::progress::Silent;
    use crate::run::findings::levels::Levels;

    const HEIGHT: usize = 4;

    fn frame(number: u16) -> Prepared {
        let frame = Frame::new(64, BitDepth::Twelve, Phase::Grbg, vec![number; 64 * HEIGHT]).unwrap();
        let frame = Arc::new(frame);
        let (name, sha256) = (String::new(), String::new());
        Prepared {
            name,
            is_street: false,
            number,
            generation: 2,
            sha256,
            input: Arc::clone(&frame),
            expected: frame,
            centre: Levels::default(),
        }
    }

    fn options() -> JudgeOptions {
        JudgeOptions {
            claimed_latency: 44,
            latency_limit: 64,
            fail_fast: false,
            keep_equal: false,
            evidence_bytes: 0,
            names_entered: false,
            timing: FrameTiming::Gaps { seed: 0 },
            variation: None,
            first_rows: None,
            pauses: vec![0; HEIGHT],
        }
    }

    /// A source of these frames and no others.
    fn source_of<const N: usize>(
        frames: [Result<Prepared, PrepareError>; N],
    ) -> Receiver<Result<Prepared, PrepareError>> {
        let (sender, source) = channel();
        frames.into_iter().for_each(|frame| sender.send(frame).unwrap());
        source
    }

    fn judge<'a>(
        source: &'a Receiver<Result<Prepared, PrepareError>>,
        seen: &'a mut Observations,
        options: JudgeOptions,
    ) -> RowJudge<'a> {
        RowJudge::new(source.iter().take(usize::MAX), seen, options, &Silent)
    }

    fn give(judge: &mut RowJudge<'_>, frame: u16, row: usize, sample: u16) {
        let samples = &[sample; 64];
        let (first_latency, last_latency, pauses, generation) = (44, 44, 0, 2);
        let row = ReturnedRow {
            frame,
            row,
            generation,
            first_latency,
            last_latency,
            pauses,
            repeats: 0,
            entered: None,
            samples,
        };
        assert!(judge.returned(&row).is_continue());
    }

    #[test]
    fn a_frame_that_is_sent_again_has_every_row_judged_once() {
        let source = source_of([Ok(frame(7)), Ok(frame(8))]);
        let mut seen = Observations::default();
        let mut judge = judge(&source, &mut seen, options());
        let sent = |judge: &mut RowJudge<'_>| judge.next_frame().map(|frame| frame.number);
        assert_eq!((sent(&mut judge), sent(&mut judge)), (Some(7), Some(8)));
        [0, 1].into_iter().for_each(|row| give(&mut judge, 7, row, 7));
        judge.begin_again();
        assert_eq!((sent(&mut judge), sent(&mut judge), sent(&mut judge)), (Some(7), Some(8), None));
        // Only the first copy of a row counts: the second row 0 is wrong, which is ignored, and so are the last two rows.
        for (row, sample) in [(0, 0), (1, 7), (2, 0), (3, 0)] {
            give(&mut judge, 7, row, sample);
        }
        (0..HEIGHT).for_each(|row| give(&mut judge, 8, row, 8));
        assert_eq!((judge.rows, judge.frames_done()), (8, 2));
        judge.finish().unwrap();
        let found: Vec<_> =
            seen.frames.iter().map(|frame| (frame.rows, frame.comparison.differences)).collect();
        assert_eq!(found, [(4, 128), (4, 0)]);
        assert_eq!(seen.latency.unwrap().rows, 8);
    }

    #[test]
    fn a_frame_that_did_not_come_back_whole_is_kept_with_the_rows_that_are_missing() {
        let source = source_of([Ok(frame(7))]);
        let mut seen = Observations::default();
        let mut judge = judge(&source, &mut seen, JudgeOptions { evidence_bytes: 1 << 20, ..options() });
        judge.next_frame().unwrap();
        [(0, 7), (2, 6)].into_iter().for_each(|(row, sample)| give(&mut judge, 7, row, sample));
        judge.finish().unwrap();
        let missing = MissingRows::of(&[true, false, true, false]);
        assert_eq!([&seen.frames[0].missing, &seen.evidence.all()[0].missing], [&missing; 2]);
    }

    /// No frame behind it is sent, so that all that comes back is right.
    #[test]
    fn a_frame_that_cannot_be_made_is_told_when_all_before_have_come_back() {
        let cannot = Frame::new(64, BitDepth::Twelve, Phase::Grbg, vec![0; 1]).unwrap_err();
        let cannot = PrepareError::Render { name: "street".to_owned(), source: cannot };
        let source = source_of([Ok(frame(7)), Err(cannot)]);
        let mut seen = Observations::default();
        let mut judge = judge(&source, &mut seen, options());
        assert_eq!(judge.next_frame().map(|frame| frame.number), Some(7));
        assert!(judge.next_frame().is_none());
        (0..HEIGHT).for_each(|row| give(&mut judge, 7, row, 7));
        let told = judge.finish().unwrap_err();
        assert!(matches!(told, PrepareError::Render { name, .. } if name == "street"));
    }
}
