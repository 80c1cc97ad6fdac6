//! Records of a burst as they come, each compared with what the model predicts.

use std::sync::mpsc::Receiver;
use std::thread;
use std::time::Duration;

use halfrow_protocol::message::{Burst, BurstState, FrameRecord};

use super::burst::BurstPlan;
use super::predicted;
use crate::board::{Board, BoardError};
use crate::progress::{Progress, Step};
use crate::result::{BurstCount, CheckName, Finding};
use crate::run::findings::End;
use crate::run::plan::Generation;
use crate::run::steps::Run;
use crate::verdict::Cause;

/// Frames with another signature that are kept.
const KEPT: usize = 64;

/// A frame with another signature than it must have.
#[derive(Clone, Copy, Debug)]
pub(super) struct WrongFrame {
    /// Its place in the burst.
    pub(super) n: u32,
    /// The signature that it has.
    pub(super) found: u32,
}

/// What a burst came to.
#[derive(Clone, Debug, Default)]
pub(super) struct Watched {
    /// Frames judged.
    pub(super) frames: u32,
    /// Those with another signature.
    pub(super) wrong: u32,
    /// The first of those, at most [`KEPT`].
    pub(super) wrong_frames: Vec<WrongFrame>,
    /// The first count that is not what it should be, in a frame whose signature is right.
    pub(super) miscounted: Option<Finding>,
    /// Frames in which the enable was off.
    pub(super) paused: u32,
    /// Frames that waited for a free record.
    pub(super) held_back: u32,
}

impl Watched {
    /// Takes the record of the next frame, which must have the signature `expected`.
    fn take(&mut self, plan: &BurstPlan, generation: u8, expected: u32, record: &FrameRecord) {
        let n = self.frames;
        self.frames += 1;
        self.paused += u32::from(record.pauses > 0);
        self.held_back += u32::from(record.held_back);
        if record.signature != expected {
            self.wrong += 1;
            if self.wrong_frames.len() < KEPT {
                self.wrong_frames.push(WrongFrame { n, found: record.signature });
            }
            return;
        }
        let generation = if plan.is_of_shadow(n) { 0 } else { generation };
        let counts = [
            (BurstCount::Samples, record.samples, plan.samples),
            (BurstCount::Rows, record.rows.into(), plan.rows.into()),
            (BurstCount::LeastLatency, record.least_latency.into(), plan.latency.into()),
            (BurstCount::MostLatency, record.most_latency.into(), plan.latency.into()),
            (BurstCount::Generation, record.generation.into(), generation.into()),
        ];
        let wrong = counts.into_iter().find(|(_, counted, right)| counted != right);
        if let Some((count, counted, right)) = wrong {
            let frame = n;
            self.miscounted.get_or_insert(Finding::MiscountedAtSpeed { frame, count, counted, right });
        }
    }
}

/// A burst that is under way.
struct Watch<'a> {
    board: &'a mut Board,
    plan: &'a BurstPlan,
    burst: Burst,
    /// Of the active tables.
    generation: u8,
    /// Whether the burst ends behind the first frame that is wrong.
    ends_early: bool,
    predicted: Receiver<u32>,
    progress: &'a dyn Progress,
    watched: Watched,
    /// How long no record has come.
    idle: Duration,
}

impl Watch<'_> {
    /// Takes the records that are there, and says whether they were the last.
    fn look(&mut self) -> Result<bool, BoardError> {
        let fetched = self.board.records(self.burst.burst, self.watched.frames)?;
        for record in &fetched.records {
            let Ok(expected) = self.predicted.recv() else { break };
            self.watched.take(self.plan, self.generation, expected, record);
            self.idle = Duration::ZERO;
        }
        if !fetched.records.is_empty() {
            let Watched { frames, .. } = self.watched;
            self.progress.frame(&format!("{}, {frames} of {}", Step::AtSpeed, self.plan.frames));
        }
        if self.ends_early && self.watched.wrong > 0 && self.burst.frames > 0 {
            self.burst.frames = 0;
            self.board.burst(&self.burst)?;
        }
        let is_over = fetched.records.is_empty() && fetched.state != BurstState::UnderWay;
        Ok(is_over || self.watched.frames >= self.plan.frames)
    }

    fn finish(mut self) -> Result<Watched, End> {
        let of_board = |error: BoardError| End::board(CheckName::AtSpeed, &error);
        let unclear = |finding| End::error(CheckName::AtSpeed, Cause::Station, finding);
        let frames = self.plan.frames;
        while !self.look().map_err(of_board)? {
            if self.idle >= self.plan.patience() {
                let (frame, seconds) = (self.watched.frames, self.idle.as_secs_f64());
                return Err(unclear(Finding::BurstStalled { frame, frames, seconds }));
            }
            // By what was meant to pass, since a recording has no clock between its exchanges.
            let wait = self.plan.look_again_in(frames - self.watched.frames);
            self.board.idle(wait).map_err(of_board)?;
            self.idle += wait;
        }
        let came = self.watched.frames;
        if came < frames && self.burst.frames > 0 {
            return Err(unclear(Finding::BurstEndedEarly { came, frames }));
        }
        Ok(self.watched)
    }
}

impl Run<'_> {
    /// Has the board make the burst `plan` with `tables`, and compares every frame, or those up to the first that is wrong.
    pub(super) fn watch(
        &mut self,
        plan: &BurstPlan,
        tables: &[Generation],
        ends_early: bool,
    ) -> Result<Watched, End> {
        // No other burst of the run has this name.
        self.findings.bursts += 1;
        let burst = plan.request(self.findings.bursts);
        self.board.burst(&burst).map_err(|error| End::board(CheckName::AtSpeed, &error))?;
        thread::scope(|scope| {
            let watch = Watch {
                board: self.board,
                plan,
                burst,
                generation: tables.first().map_or(0, |active| active.number),
                ends_early,
                predicted: predicted::ahead(scope, *plan, tables),
                progress: self.progress,
                watched: Watched::default(),
                idle: Duration::ZERO,
            };
            watch.finish()
        })
    }
}
