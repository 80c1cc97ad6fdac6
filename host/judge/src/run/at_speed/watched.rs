//! Compares the records of a burst, as they come, with what the model predicts.

use std::sync::mpsc::Receiver;
use std::thread;
use std::time::Duration;

use halfrow_protocol::message::{Burst, BurstState, FrameRecord};

use super::burst::BurstPlan;
use super::clock::Stopwatch;
use super::predicted::{self, AHEAD};
use crate::board::{Board, BoardError};
use crate::result::{BurstCount, CheckName, ClockSeen, Finding};
use crate::run::findings::{During, End};
use crate::run::steps::Run;
use crate::tables::Generation;
use crate::verdict::Cause;

/// What may end a burst before its last frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct EndsEarly {
    /// It ends with the first wrong frame.
    pub(super) when_wrong: bool,
    /// It ends at this time on the link's clock.
    pub(super) at: Option<Duration>,
}

/// The most wrong frames that are kept.
const KEPT: usize = 64;

/// A frame with a wrong signature.
#[derive(Clone, Copy, Debug)]
pub(super) struct WrongFrame {
    /// Its place in the burst.
    pub(super) n: u32,
    /// The signature that it has.
    pub(super) found: u32,
    /// When its record came, on the link's clock.
    pub(super) at: Duration,
}

/// Something that the board counts wrong.
#[derive(Clone, Debug)]
pub(super) struct MiscountSeen {
    /// What it is.
    pub(super) finding: Finding,
    /// When the record that shows it came, on the link's clock.
    pub(super) at: Duration,
}

/// What was seen of a burst.
#[derive(Clone, Debug, Default)]
pub(super) struct BurstSeen {
    /// Frames judged.
    pub(super) frames: u32,
    /// Frames with a wrong signature.
    pub(super) wrong: u32,
    /// The first of these, at most [`KEPT`].
    pub(super) wrong_frames: Vec<WrongFrame>,
    /// Frames whose signature is right and of which something is counted wrong.
    pub(super) miscounted: u32,
    /// The first wrong count.
    pub(super) miscount: Option<MiscountSeen>,
    /// Frames in which the enable was off at times.
    pub(super) paused: u32,
    /// Frames that waited for a free record.
    pub(super) held_back: u32,
    /// What they say about the pixel clock.
    pub(super) clock: ClockSeen,
}

impl BurstSeen {
    /// Judges the record of the next frame, which must have the signature `expected`.
    fn take(&mut self, watch: &Watch<'_>, expected: u32, record: &FrameRecord) {
        let plan = watch.plan;
        let n = self.frames;
        self.frames += 1;
        self.paused += u32::from(record.pauses > 0);
        self.held_back += u32::from(record.held_back);
        if record.signature != expected {
            self.wrong += 1;
            if self.wrong_frames.len() < KEPT {
                let at = watch.board.now();
                self.wrong_frames.push(WrongFrame { n, found: record.signature, at });
            }
            return;
        }
        let generation = if plan.is_of_shadow(n) { 0 } else { watch.generation };
        let counts = [
            (BurstCount::Samples, record.samples, plan.samples),
            (BurstCount::Rows, record.rows.into(), plan.rows.into()),
            (BurstCount::LeastLatency, record.least_latency.into(), plan.latency.into()),
            (BurstCount::MostLatency, record.most_latency.into(), plan.latency.into()),
            (BurstCount::Generation, record.generation.into(), generation.into()),
        ];
        let wrong = counts.into_iter().find(|(_, counted, right)| counted != right);
        if let Some((count, counted, right)) = wrong {
            self.miscounted += 1;
            let finding = Finding::MiscountedAtSpeed { frame: n.into(), count, counted, right };
            self.miscount.get_or_insert(MiscountSeen { finding, at: watch.board.now() });
        }
    }

    /// Checks that there are no more `records` of the burst `plan` than it has frames.
    fn compare_count(&mut self, plan: &BurstPlan, records: u32, at: Duration) {
        let (frame, count) = (plan.frames, BurstCount::Records);
        if records > frame {
            let finding =
                Finding::MiscountedAtSpeed { frame: frame.into(), count, counted: records, right: frame };
            self.miscount.get_or_insert(MiscountSeen { finding, at });
        }
    }
}

/// A burst that is under way.
struct Watch<'a> {
    board: &'a mut Board,
    plan: &'a BurstPlan,
    burst: Burst,
    /// The generation of the active tables.
    generation: u8,
    ends_early: EndsEarly,
    predicted: Receiver<u32>,
    stopwatch: Stopwatch,
    /// Called when records have come, with the time on the link's clock.
    told: &'a mut dyn FnMut(&BurstSeen, Duration),
    /// For how long no record has come.
    idle: Duration,
    /// Whether the last look left records that had come.
    left: bool,
}

impl Watch<'_> {
    /// Fetches the records that there are, and judges the first [`AHEAD`] of them. Returns whether they were the last.
    fn look(&mut self, watched: &mut BurstSeen) -> Result<bool, BoardError> {
        let (before, from) = (self.board.heard_at(), watched.frames);
        let fetched = self.board.records(self.burst.burst, from);
        let fetched = fetched.map_err(|error| self.board.of_last_burst(error))?;
        // While a frame is predicted the board hears nothing, and it closes a session in which it hears nothing for long.
        for record in fetched.records.iter().take(AHEAD) {
            let Ok(expected) = self.predicted.recv() else { break };
            watched.take(self, expected, record);
            self.idle = Duration::ZERO;
        }
        let judged = (watched.frames - from) as usize;
        self.left = judged == AHEAD && judged < fetched.records.len();
        let records = from.saturating_add(fetched.records.len() as u32);
        watched.compare_count(self.plan, records, self.board.now());
        self.stopwatch.note(self.plan, watched, &fetched, from, (before, self.board.heard_at()));
        if !fetched.records.is_empty() {
            (self.told)(watched, self.board.now());
        }
        if self.is_enough(watched) {
            self.burst.frames = 0;
            self.board.burst(&self.burst)?;
        }
        let is_over = fetched.records.is_empty() && fetched.state != BurstState::UnderWay;
        Ok(is_over || watched.frames >= self.plan.frames)
    }

    /// Whether a burst that is still going on should be ended.
    fn is_enough(&self, watched: &BurstSeen) -> bool {
        let EndsEarly { when_wrong, at } = self.ends_early;
        let is_late = at.is_some_and(|at| self.board.now() >= at);
        self.burst.frames > 0 && (when_wrong && watched.wrong > 0 || is_late)
    }

    fn finish(mut self, watched: &mut BurstSeen) -> Result<(), End> {
        let unclear = |finding| End::error(CheckName::AtSpeed, Cause::Station, finding);
        let frames = self.plan.frames;
        while !self.look(watched).during(CheckName::AtSpeed)? {
            if self.left {
                continue;
            }
            if self.idle >= self.plan.patience() {
                let (frame, seconds) = (watched.frames, self.idle.as_secs_f64());
                return Err(unclear(Finding::BurstStalled { frame, frames, seconds }));
            }
            // Counted by the time that should pass, since a recording has no clock between its exchanges.
            let wait = self.plan.look_again_in(frames - watched.frames);
            self.board.idle(wait).during(CheckName::AtSpeed)?;
            self.idle += wait;
        }
        let came = watched.frames;
        if came < frames && self.burst.frames > 0 {
            return Err(unclear(Finding::BurstEndedEarly { came, frames }));
        }
        Ok(())
    }
}

impl Run<'_> {
    /// Has the board make the burst `plan` with `tables`, and compares every frame up to its end. Whenever records have
    /// come, `told` is called with what was seen so far and the time on the link's clock.
    pub(super) fn watch(
        &mut self,
        plan: &BurstPlan,
        tables: &[Generation],
        ends_early: EndsEarly,
        told: &mut dyn FnMut(&BurstSeen, Duration),
    ) -> (BurstSeen, Result<(), End>) {
        self.bursts += 1;
        let burst = plan.request(self.bursts);
        let mut watched = BurstSeen::default();
        let ended = thread::scope(|scope| {
            let predicted = predicted::ahead(scope, *plan, tables).during(CheckName::AtSpeed)?;
            let asked = self.board.heard_at();
            self.board.burst(&burst).during(CheckName::AtSpeed)?;
            let stopwatch = Stopwatch::new(asked, self.board.heard_at());
            let watch = Watch {
                board: self.board,
                plan,
                burst,
                generation: tables.first().map_or(0, |active| active.number),
                ends_early,
                predicted,
                stopwatch,
                told,
                idle: Duration::ZERO,
                left: false,
            };
            watch.finish(&mut watched)
        });
        (watched, ended)
    }
}
