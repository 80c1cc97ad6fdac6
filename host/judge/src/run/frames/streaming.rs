//! Frames through the board, segment by segment.

use std::sync::mpsc::Receiver;

use halfrow_model::TableSet;
use halfrow_protocol::Kind;
use halfrow_protocol::message::RowPlace;

use super::observations::Observations;
use super::pauses::pauses;
use super::prepared::{PrepareError, Prepared};
use super::row_judge::{JudgeOptions, RowJudge};
use crate::board::{BoardError, MAX_LATENCY, Misconduct, row_blanking};
use crate::result::{Answer, CheckName, Finding, FrameTiming, NumberedRow, PlacedRow, RepeatedRow, Rule};
use crate::run::findings::{During, End};
use crate::run::plan::{SENSOR_BLANKING, Segment, Timing};
use crate::run::rules::answer;
use crate::run::steps::Run;
use crate::tables::datapath_of;

impl Run<'_> {
    /// Streams a segment, whose frames are the next ones of `source`, and judges what comes back.
    pub(crate) fn stream(
        &mut self,
        segment: &Segment,
        source: &Receiver<Result<Prepared, PrepareError>>,
        seen: &mut Observations,
    ) -> Result<(), End> {
        let frames = source.iter().take(segment.frames.len());
        let mut judge = RowJudge::new(frames, seen, self.judge_options(segment), self.progress);
        let streamed = self.stream_to_the_end(segment, &mut judge);
        let prepared = judge.finish();
        streamed?;
        prepared.map_err(|error| End::station(CheckName::Frames, &error))?;
        if self.plan.fail_fast && seen.differences() > 0 {
            self.board.drop_rows().during(CheckName::Frames)?;
        }
        Ok(())
    }

    fn stream_to_the_end(&mut self, segment: &Segment, judge: &mut RowJudge<'_>) -> Result<(), End> {
        while let Err(error) = self.board.stream(judge) {
            self.findings.attempt.seen_wrong |= judge.has_found();
            let end = self.interrupted(segment, judge, error);
            self.end_of_frames(judge);
            self.return_to(segment, judge.frames_done(), end)?;
            judge.begin_again();
        }
        self.end_of_frames(judge);
        self.unless_misconduct(CheckName::Frames, Ok(()))?;
        let attempt = &mut self.findings.attempt;
        attempt.rows_counted += judge.rows;
        attempt.repeats_counted = attempt.repeats_counted.saturating_add(judge.repeats);
        Ok(())
    }

    /// From now on the time is that of checks again.
    fn end_of_frames(&mut self, judge: &mut RowJudge<'_>) {
        judge.pause();
        self.findings.checks.begin_lap();
    }

    fn judge_options(&self, segment: &Segment) -> JudgeOptions {
        let Segment { geometry, timing, .. } = segment;
        let half = geometry.width() as u32 / 2;
        let gap_seed = if let Timing::Gaps(seed) = *timing { seed } else { 0 };
        JudgeOptions {
            claimed_latency: half + u32::from(self.board.capabilities.latency),
            latency_limit: half + u32::from(MAX_LATENCY),
            fail_fast: self.plan.fail_fast,
            keep_equal: self.options.keep_equal,
            evidence_bytes: self.options.evidence_bytes,
            names_entered: self.board.capabilities.entered,
            timing: self.timing(*timing),
            variation: self.plan.variation(geometry),
            first_rows: Some(geometry.height()).filter(|&rows| rows < self.plan.tables.geometry().height()),
            pauses: pauses(gap_seed, geometry.width(), geometry.height()),
        }
    }

    /// The timing of rows of `tables` that follow each other as closely as the board allows.
    pub(in crate::run) fn least_blanking(&self, tables: &TableSet) -> FrameTiming {
        let (width, datapath) = (tables.geometry().width(), datapath_of(tables));
        FrameTiming::LeastBlanking { clocks: row_blanking(&self.board.capabilities, width, datapath) }
    }

    fn timing(&self, timing: Timing) -> FrameTiming {
        match timing {
            Timing::Least => self.least_blanking(&self.plan.tables),
            Timing::Sensor => FrameTiming::Blanking { clocks: SENSOR_BLANKING },
            Timing::Gaps(seed) => FrameTiming::Gaps { seed },
        }
    }

    /// A row did not come back, or the link broke.
    fn interrupted(&mut self, segment: &Segment, judge: &RowJudge<'_>, error: BoardError) -> End {
        if let Some(misconduct) = self.misconduct(CheckName::Frames) {
            return misconduct;
        }
        match error {
            BoardError::RowMissing { place, .. } => {
                let frame = segment.frames.iter().find(|frame| frame.number == place.frame);
                let of_board = || End::board(CheckName::Frames, &error);
                let late = judge.all_late().filter(|_| place.last);
                frame.map_or_else(of_board, |frame| self.row_lost(frame, &segment.geometry, place, late))
            }
            other => End::board(CheckName::Frames, &other),
        }
    }

    /// What `tried` came to, unless the board did what no link can cause: that counts although the link broke after it.
    pub(crate) fn unless_misconduct<T>(&self, check: CheckName, tried: Result<T, End>) -> Result<T, End> {
        self.misconduct(check).map_or(tried, Err)
    }

    /// What the board did that no link can cause, if anything.
    fn misconduct(&self, check: CheckName) -> Option<End> {
        let misconduct = self.board.misconduct()?;
        let rules = check == CheckName::Rules;
        let finding = match *misconduct {
            Misconduct::CopyDiffers { place } => {
                Finding::RowCopyDiffers(PlacedRow { row: place.row, frame: place.frame, rules })
            }
            Misconduct::NeverSent { place } => {
                let RowPlace { row, frame, row_sequence: sequence, .. } = place;
                Finding::RowNeverSent { row, frame, sequence, rules }
            }
            Misconduct::NumberedTwice { place, number } => {
                Finding::RowNumberedTwice(NumberedRow { row: place.row, frame: place.frame, number, rules })
            }
            Misconduct::RepeatsStand { place, repeats } => {
                Finding::RowRepeatsStand(RepeatedRow { row: place.row, frame: place.frame, repeats, rules })
            }
            Misconduct::AckAnswered { ref said } => Finding::RuleBroken {
                rule: Rule::Unanswered,
                request: Kind::RowAck.to_string(),
                right: Answer::Nothing {},
                found: answer(said),
                asked: None,
            },
            Misconduct::OutOfOrder { place } => {
                Finding::RowOutOfOrder(PlacedRow { row: place.row, frame: place.frame, rules })
            }
        };
        Some(End::failed(check, finding))
    }
}
