//! The sessions of a run: how they are opened, the first and later ones, and what went over their links.

mod reconnect;
pub(super) mod second_look;
mod window;

use std::error::Error;
use std::time::{Duration, Instant};

use crate::board::{Board, BoardError, OpenFailed, OpenOptions, RetryLimit, SessionIds, Tally, WhenHeld};
use crate::link::{Link, OpenError, Reopener};
use crate::result::{CheckName, Finding, LinkReport, Problem, Reconnection};
use crate::run::RunOptions;
use crate::run::findings::{During, End};
use second_look::LOOKS;

/// The most times that a board may come back. More often than this it is a loose contact, and waiting does not help.
const MOST: usize = 16;
/// The time between two tries. A system takes some tenths of a second to announce a device.
const TICK: Duration = Duration::from_millis(100);
/// The sequence numbers kept for a try to open the board, which sends fewer packets.
const NUMBERS: u16 = 16;
/// Keeps the nonces of sessions that make copies of old requests harmless apart from those of boards that came back.
const NONCE: u32 = 1 << 16;

/// What went over links that are closed.
#[derive(Default)]
struct Traffic {
    tally: Tally,
    /// By their clocks, and between them.
    seconds: Duration,
    links: u64,
}

impl Traffic {
    /// Adds a link that carried `tally` in `seconds`. One that carried nothing is one that was hung up before.
    fn add(&mut self, tally: Tally, seconds: Duration) {
        self.tally += tally;
        self.seconds += seconds;
        self.links += u64::from(tally.packets_out > 0);
    }
}

/// The sessions of a run.
pub(crate) struct Sessions {
    /// Opens the link again; none if it cannot be.
    reopen: Option<Reopener>,
    /// How long a board may stay away; none if the run ends when it goes away.
    patience: Option<Duration>,
    options: OpenOptions,
    /// Those opened within a look to make copies of old requests harmless.
    opened: u32,
    /// The links opened again, whether or not a board answered there.
    reopened: u32,
    /// What went over earlier links, which broke; over all of them once the run has ended.
    earlier: Traffic,
    report: LinkReport,
}

impl Sessions {
    /// Of a run over the link of this `name`.
    pub(crate) fn new(options: &RunOptions, name: String, reopen: Option<Reopener>) -> Self {
        Self {
            reopen,
            patience: options.reconnect,
            options: OpenOptions {
                ids: options.provenance.session_ids,
                when_held: WhenHeld::wanted(options.take_over),
                counts: options.counts,
                retry_limit: options.retry_limit,
                stop: options.stop.clone().link_limit(options.timeout),
            },
            opened: 0,
            reopened: 0,
            earlier: Traffic::default(),
            report: LinkReport { name, ..LinkReport::default() },
        }
    }

    /// Opens the board at `link`, or at a reopened link if that one breaks. The board is taken over only now: a host that
    /// has it later came later, and is not thrown out.
    pub(crate) fn open(&mut self, link: Box<dyn Link>) -> Result<Board, End> {
        let opened = self.open_first(link);
        self.options.when_held = WhenHeld::Leave;
        opened
    }

    fn open_first(&mut self, link: Box<dyn Link>) -> Result<Board, End> {
        let OpenFailed { error, tally, at } = match Board::open_any(link, &self.options) {
            Ok(board) => return Ok(board),
            Err(failed) => failed,
        };
        self.earlier.add(*tally, at);
        let end = End::board(CheckName::Identity, &error);
        match (&error, self.patience_after(&end)) {
            (BoardError::Link { .. }, Some(patience)) => self.open_again(patience, &end),
            _ => Err(end),
        }
    }

    /// How long to wait for a board that went away with `end`; none if that is no reason to wait, or waiting does not help.
    pub(crate) fn patience_after(&self, end: &End) -> Option<Duration> {
        let again = end.is_outage() && self.reopen.is_some() && self.report.reconnections.len() < MOST;
        self.patience.filter(|_| again)
    }

    /// Waits for the board, which went away with `end`, and opens it in place of `board`. Returns whether it is the same one.
    pub(crate) fn come_back(
        &mut self,
        board: &mut Board,
        patience: Duration,
        end: &End,
    ) -> Result<bool, End> {
        self.earlier.add(board.tally(), board.now());
        self.options.ids.sequence = board.sequence();
        // The old link, if still open, would keep the new one from being opened.
        board.hang_up();
        let back = self.open_again(patience, end)?;
        let is_same = back.welcome.serial == board.welcome.serial
            && back.welcome.build == board.welcome.build
            && back.capabilities == board.capabilities;
        *board = back;
        Ok(is_same)
    }

    /// Waits for the board, which went away with `end`, and opens it.
    fn open_again(&mut self, patience: Duration, end: &End) -> Result<Board, End> {
        let left = Instant::now();
        let opened = self.open_within(patience, end, left);
        // The clock of the new link began when it was opened.
        let on_its_clock = opened.as_ref().map_or(Duration::ZERO, Board::now);
        self.earlier.seconds += left.elapsed().saturating_sub(on_its_clock);
        opened
    }

    /// Tries to open the board, which `left` with `end`, until it is there or `patience` is over.
    fn open_within(&mut self, patience: Duration, end: &End, left: Instant) -> Result<Board, End> {
        let End::Error { check, cause, finding, .. } = end else { return Err(end.clone()) };
        let reason = finding.as_problem();
        tracing::warn!(
            "{}; waiting {} s for the board to come back",
            reason.sentence(),
            patience.as_secs_f64()
        );
        loop {
            let spent = self.earlier.seconds + left.elapsed();
            self.options.stop.check(spent, left.elapsed()).during(*check)?;
            let kept_from_us = match self.try_open(spent) {
                Ok(board) => {
                    let seconds_away = left.elapsed().as_secs_f64();
                    let back = Reconnection { reason, seconds_away, kept_tables: None };
                    self.report.reconnections.push(back);
                    return Ok(board);
                }
                Err(why) => why,
            };
            if left.elapsed() > patience {
                let seconds = patience.as_secs_f64();
                let away = Finding::BoardStayedAway { reason: Box::new(reason), seconds };
                return Err(kept_from_us.map_or_else(|| End::error(*check, *cause, away), |end| *end));
            }
            std::thread::sleep(TICK);
        }
    }

    /// Opens the board. The error says what keeps a board that exists from this run; it is none if there is no board.
    fn try_open(&mut self, spent: Duration) -> Result<Board, Option<Box<End>>> {
        let reopen = self.reopen.as_mut().ok_or(None)?;
        let link = reopen().map_err(|error| {
            tracing::debug!("not there yet: {error}");
            not_opened(&*error).map(Box::new)
        })?;
        // A board that never lost power must not take this HELLO for one that it has already answered, nor this host a late
        // refusal for the answer to it.
        self.reopened += 1;
        let SessionIds { nonce, host, sequence } = self.options.ids;
        let nonce = nonce.wrapping_add(self.reopened);
        let sequence = sequence.wrapping_add((self.reopened as u16).wrapping_mul(NUMBERS));
        let ids = SessionIds { nonce, host, sequence };
        let options = OpenOptions { ids, stop: self.options.stop.after(spent), ..self.options.clone() };
        Board::open_any(link, &options).map_err(|OpenFailed { error, .. }| {
            tracing::debug!("not there yet: {error}");
            error.shows_device().then(|| Box::new(End::board(CheckName::Identity, &error)))
        })
    }

    /// Notes that the board lost its session though its link stayed, and was greeted again at once.
    pub(crate) fn note_lost(&mut self) {
        let reason = Problem::of(&BoardError::SessionLost { silent: Duration::ZERO });
        self.report.reconnections.push(Reconnection { reason, seconds_away: 0.0, kept_tables: None });
    }

    /// Drops what the board has of an earlier session, and notes whether a board that came back still had its tables.
    pub(crate) fn start_afresh(&mut self, board: &mut Board) -> Result<(), BoardError> {
        let had_tables = board.start_afresh()?;
        if let Some(last) = self.report.reconnections.last_mut() {
            last.kept_tables.get_or_insert(had_tables);
        }
        Ok(())
    }

    /// The nonce of the session in which everything is done again, for the `look`th time from 1. In it, copies of earlier
    /// sessions' requests have no effect.
    pub(crate) fn nonce_of(&self, look: u32) -> u32 {
        self.options.ids.nonce.wrapping_add(NONCE + look)
    }

    /// The nonce of a further such session within the same look.
    pub(crate) fn next_nonce(&mut self) -> u32 {
        self.opened += 1;
        self.nonce_of(LOOKS + self.opened)
    }

    /// The time on the clocks of earlier links, and between them.
    pub(crate) fn earlier(&self) -> Duration {
        self.earlier.seconds
    }

    pub(crate) fn note_round_trip(&mut self, time: Duration) {
        self.report.round_trip_us = Some(time.as_micros() as u64);
    }

    /// Notes how many packets reached the board damaged, by its own count.
    pub(crate) fn note_damaged(&mut self, damaged: u32) {
        self.report.damaged_out = damaged.into();
    }

    /// Notes the link's counts at the end of the run.
    pub(crate) fn note_end(&mut self, board: &Board) {
        self.earlier.add(board.tally(), board.now());
    }

    /// What is reported of the link.
    pub(crate) fn report(self) -> LinkReport {
        let Traffic { tally, seconds, links } = self.earlier;
        let limit = self.options.retry_limit;
        LinkReport {
            bytes_out: tally.bytes_out,
            bytes_in: tally.bytes_in,
            packets_out: tally.packets_out,
            packets_in: tally.packets_in,
            damaged_in: tally.damaged_in,
            retries: tally.retries,
            late: tally.late,
            strays: tally.strays,
            line_errors: tally.line_errors,
            // Each link has its own.
            retry_limit: RetryLimit { fixed: limit.fixed.saturating_mul(links.max(1)), ..limit }
                .of(tally.packets_out),
            seconds: seconds.as_secs_f64(),
            ..self.report
        }
    }
}

/// The end of a run from which an existing device is kept, if `error` says so.
fn not_opened(error: &(dyn Error + Send + Sync + 'static)) -> Option<End> {
    let error = error.downcast_ref::<OpenError>().filter(|error| error.is_kept_from_us())?;
    Some(End::error(CheckName::Identity, error.class().into(), Problem::of(error)))
}
