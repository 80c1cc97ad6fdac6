//! A board that goes away during a run and comes back: waiting for it, and bringing it back to where the run was.

use std::error::Error;
use std::iter;
use std::time::{Duration, Instant};

use super::end::{During, End};
use super::findings::Findings;
use super::plan::Segment;
use super::steps::Run;
use crate::board::{Board, BoardError, NumberedFrame, OpenFailed, OpenOptions, Unjudged};
use crate::link::{Link, OpenError, Reopener};
use crate::progress::Step;
use crate::result::{CheckName, Finding, Problem};
use crate::verdict::Cause;

/// The most times that a board may come back. More often than this it is a loose contact, and waiting does not help.
const MOST: usize = 16;
/// The time between two tries. A system takes some tenths of a second to announce a device.
const TICK: Duration = Duration::from_millis(100);

/// How a board is opened, the first time and later.
pub(super) struct Opener {
    /// Opens the link again; none if it cannot be.
    pub(super) reopen: Option<Reopener>,
    /// How long a board may stay away; none if the run ends when it goes away.
    pub(super) patience: Option<Duration>,
    pub(super) options: OpenOptions,
}

impl Opener {
    /// Opens the board at `link`, or at a reopened link if that one breaks. The board is taken over only now: a host that
    /// takes it during the run came later, and is not thrown out.
    pub(super) fn open(&mut self, link: Box<dyn Link>, findings: &mut Findings) -> Result<Board, End> {
        let opened = self.open_first(link, findings);
        self.options.take_over = false;
        opened
    }

    fn open_first(&mut self, link: Box<dyn Link>, findings: &mut Findings) -> Result<Board, End> {
        let OpenFailed { error, tally } = match Board::open_any(link, &self.options) {
            Ok(board) => return Ok(board),
            Err(failed) => failed,
        };
        findings.tally = *tally;
        let end = End::board(CheckName::Identity, &error);
        match (&error, self.patience()) {
            (BoardError::Link { .. }, Some(patience)) if end.is_outage() => {
                self.open_again(patience, &end, findings)
            }
            _ => Err(end),
        }
    }

    /// Waits for the board, which went away with `end`, and opens it.
    fn open_again(&mut self, patience: Duration, end: &End, findings: &mut Findings) -> Result<Board, End> {
        let End::Error { check, cause, finding, .. } = end else { return Err(end.clone()) };
        let reason = finding.as_problem();
        tracing::warn!(
            "{}; waiting {} s for the board to come back",
            reason.sentence(),
            patience.as_secs_f64()
        );
        let left = Instant::now();
        loop {
            let spent = findings.earlier.seconds + left.elapsed();
            self.options.stop.check(spent, left.elapsed()).during(*check)?;
            let kept_from_us = match self.try_open(spent, findings.link.reconnections.len()) {
                Ok(board) => {
                    findings.note_return(reason, left.elapsed());
                    return Ok(board);
                }
                Err(why) => why,
            };
            if left.elapsed() > patience {
                let seconds = patience.as_secs_f64();
                let away = Finding::BoardStayedAway { reason: Box::new(reason), seconds };
                return Err(kept_from_us.unwrap_or_else(|| End::error(*check, *cause, away)));
            }
            std::thread::sleep(TICK);
        }
    }

    /// How long the board may stay away; none if it cannot be reopened.
    fn patience(&self) -> Option<Duration> {
        self.patience.filter(|_| self.reopen.is_some())
    }

    /// Opens the board. The error says what keeps a board that exists from this run; it is none if there is no board.
    fn try_open(&mut self, spent: Duration, times: usize) -> Result<Board, Option<End>> {
        let reopen = self.reopen.as_mut().ok_or(None)?;
        let link = reopen().map_err(|error| {
            tracing::debug!("not there yet: {error}");
            not_opened(&*error)
        })?;
        // A board that never lost power must not take this HELLO for the one that it has already answered.
        let nonce = self.options.nonce.wrapping_add(1 + times as u32);
        let options = OpenOptions { nonce, stop: self.options.stop.after(spent), ..self.options.clone() };
        Board::open_any(link, &options).map_err(|OpenFailed { error, .. }| {
            tracing::debug!("not there yet: {error}");
            error.shows_device().then(|| End::board(CheckName::Identity, &error))
        })
    }
}

/// The end of a run from which an existing device is kept, if `error` says so.
fn not_opened(error: &(dyn Error + Send + Sync + 'static)) -> Option<End> {
    let error = error.downcast_ref::<OpenError>().filter(|error| error.is_kept_from_us())?;
    Some(End::error(CheckName::Identity, error.class().into(), Problem::of(error)))
}

impl Run<'_> {
    /// Does `step`, and repeats it whenever the board went away during it and has come back.
    pub(super) fn over_outages(&mut self, step: impl Fn(&mut Self) -> Result<(), End>) -> Result<(), End> {
        while let Err(end) = step(self) {
            self.come_back(end)?;
        }
        Ok(())
    }

    /// Does `step`. Whenever the board went away during it, brings it back to where it was after `last`, and does it again.
    pub(super) fn persist<T>(
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
    pub(super) fn return_to(&mut self, segment: &Segment, at: usize, end: End) -> Result<(), End> {
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
    pub(super) fn come_back(&mut self, end: End) -> Result<(), End> {
        self.unless_misconduct(end.name(), Ok(()))?;
        let again = self.findings.link.reconnections.len() < MOST;
        let Some(patience) = self.opener.patience().filter(|_| end.is_outage() && again) else {
            return Err(end);
        };
        self.progress.step(Step::WaitForTheBoard);
        self.findings.keep_counts(self.board);
        // The old link, if still open, would keep the new one from being opened.
        self.board.hang_up();
        let board = self.opener.open_again(patience, &end, self.findings)?;
        let is_same = board.welcome.serial == self.board.welcome.serial
            && board.welcome.build == self.board.welcome.build
            && board.capabilities == self.board.capabilities;
        *self.board = board;
        // Two boards of the same build without serial numbers look the same.
        self.findings.attempt.came_back_unnumbered |= self.board.welcome.serial == 0;
        if is_same {
            return Ok(());
        }
        Err(End::error(CheckName::Identity, Cause::Refused, Finding::BoardExchanged {}))
    }

    /// Drops what the board has of an earlier session, and notes whether a board that came back still had its tables.
    pub(super) fn start_afresh(&mut self) -> Result<(), BoardError> {
        let had_tables = self.board.start_afresh()?;
        if let Some(last) = self.findings.link.reconnections.last_mut() {
            last.kept_tables.get_or_insert(had_tables);
        }
        Ok(())
    }

    /// Sets up a board that may have forgotten everything. Frames begin with their row 0, because a board takes no other
    /// row after HELLO.
    fn restore(&mut self, segment: &Segment, at: usize) -> Result<(), End> {
        self.start_afresh().during(CheckName::Link)?;
        self.configure(segment)?;
        let next = segment.frames.get(at);
        let Some(frame) = next.or(segment.frames.last()) else { return Ok(()) };
        let rows = segment.geometry.height();
        self.commit(frame.generation, frame.number, rows)?;
        let later = segment.commit.filter(|(number, _)| *number != frame.generation);
        if next.is_none() || later.is_some() {
            // Tables become active only when a frame enters.
            let rendered = self.plan.render(frame, &segment.geometry);
            let rendered = rendered
                .map_err(|error| End::error(CheckName::Frames, Cause::Station, Problem::of(&error)))?;
            self.findings.attempt.rows_counted += rendered.height();
            let played = NumberedFrame { number: frame.number, frame: rendered };
            self.board.stream(&mut Unjudged(iter::once(played))).during(CheckName::Frames)?;
        }
        later.map_or(Ok(()), |(number, first_frame)| self.commit(number, first_frame, rows))
    }
}
