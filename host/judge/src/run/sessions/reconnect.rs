//! A board that goes away during a run and comes back: bringing it back to where the run was.

use std::iter;

use crate::board::{NumberedFrame, Unjudged};
use crate::progress::Step;
use crate::result::{CheckName, Finding, Identity};
use crate::run::findings::{During, End};
use crate::run::plan::Segment;
use crate::run::steps::Run;
use crate::verdict::Cause;

impl Run<'_> {
    /// Does `step`, and repeats it whenever the board went away during it and has come back.
    pub(crate) fn over_outages<T>(&mut self, step: impl Fn(&mut Self) -> Result<T, End>) -> Result<T, End> {
        loop {
            match step(self) {
                Err(end) => self.come_back(end)?,
                done => return done,
            }
        }
    }

    /// Does `step`. Whenever the board went away during it, brings it back to where it was after `last`, and does it again.
    pub(crate) fn persist<T>(
        &mut self,
        last: Option<&Segment>,
        mut step: impl FnMut(&mut Self) -> Result<T, End>,
    ) -> Result<T, End> {
        loop {
            match (step(self), last) {
                (Err(end), Some(last)) if end.is_outage() => self.return_to(last, last.frames.len(), end)?,
                (done, _) => return done,
            }
        }
    }

    /// Waits for a board that went away with `end`, and brings it to where frame `at` of `segment` is the next to be
    /// sent. Returns any other end as it is.
    pub(crate) fn return_to(&mut self, segment: &Segment, at: usize, end: End) -> Result<(), End> {
        let mut end = end;
        loop {
            self.come_back(end)?;
            match self.restore(segment, at) {
                Ok(()) => return Ok(()),
                Err(again) => end = again,
            }
        }
    }

    /// Waits for a board that went away with `end`. Returns any other end as it is, and what the board did with rows that no
    /// link can cause, which would be forgotten with its session.
    pub(crate) fn come_back(&mut self, end: End) -> Result<(), End> {
        self.unless_misconduct(end.check(), Ok(()))?;
        let Some(patience) = self.sessions.patience_after(&end) else { return Err(end) };
        self.progress.step(Step::WaitForTheBoard);
        self.findings.attempt.link_broke(self.board);
        let is_as_before = self.sessions.come_back(self.board, patience, &end)?;
        // A board may have been exchanged without a sign and greeted since.
        let now = Identity::of(&self.board.welcome, &self.board.capabilities);
        let is_as_first = self.findings.board.identity.as_ref().is_none_or(|first| *first == now);
        // Two boards of the same build without serial numbers look the same.
        self.findings.attempt.came_back_unnumbered |= self.board.welcome.serial == 0;
        if is_as_before && is_as_first {
            return Ok(());
        }
        Err(End::error(CheckName::Identity, Cause::Refused, Finding::BoardExchanged {}))
    }

    /// Sets up a board that may have forgotten everything. Frames begin with their row 0, because a board takes no other
    /// row after HELLO.
    fn restore(&mut self, segment: &Segment, at: usize) -> Result<(), End> {
        self.sessions.start_afresh(self.board).during(CheckName::Link)?;
        self.configure(segment)?;
        let next = segment.frames.get(at);
        let Some(frame) = next.or(segment.frames.last()) else { return Ok(()) };
        let rows = segment.geometry.height();
        self.commit(frame.generation, frame.number, rows)?;
        let later = segment.commit.filter(|(number, _)| *number != frame.generation);
        if next.is_none() || later.is_some() {
            // Tables become active only when a frame enters.
            let rendered = self.plan.render(frame, &segment.geometry);
            let rendered = rendered.map_err(|error| End::station(CheckName::Frames, &error))?;
            self.findings.attempt.rows_counted += rendered.height();
            let played = NumberedFrame { number: frame.number, frame: rendered };
            self.board.stream(&mut Unjudged(iter::once(played))).during(CheckName::Frames)?;
        }
        later.map_or(Ok(()), |(number, first_frame)| self.commit(number, first_frame, rows))
    }
}
