//! Which host talks to the board.

use std::time::Duration;

use halfrow_protocol::VERSION;
use halfrow_protocol::message::{Hello, RefusalCode, Reset, ResetLevel, Status, Welcome};

use super::rows::RowBanks;
use super::{Board, Refused};
use crate::faults::Conduct;
use crate::player::Player;
use crate::tables::Tables;

/// After this time of silence another host may take the board.
const SILENCE: Duration = Duration::from_secs(10);

/// The unit in which a host is told how long the board is still held.
const TENTH: Duration = Duration::from_millis(100);

/// The open session, if there is one.
#[derive(Debug, Default)]
pub(super) struct Session {
    holder: Option<Holder>,
    last_number: u8,
}

#[derive(Debug)]
struct Holder {
    nonce: u32,
    host: u32,
    heard: Duration,
}

impl Session {
    /// The number of the open session, 0 for none.
    pub(super) fn number(&self) -> u8 {
        if self.holder.is_some() { self.last_number } else { 0 }
    }

    pub(super) fn is_open(&self, number: u8) -> bool {
        number != 0 && number == self.number()
    }

    /// Notes that the holder was heard.
    pub(super) fn heard(&mut self, now: Duration) {
        if let Some(holder) = &mut self.holder {
            holder.heard = now;
        }
    }

    /// Notes that a host was heard, which may be the holder.
    fn heard_from(&mut self, host: u32, now: Duration) {
        if self.holder.as_ref().is_some_and(|holder| holder.host == host) {
            self.heard(now);
        }
    }

    /// Whether the holder of an open session has been silent for too long.
    pub(super) fn is_silent(&self, now: Duration) -> bool {
        self.holder.as_ref().is_some_and(|holder| now.saturating_sub(holder.heard) >= SILENCE)
    }

    pub(super) fn close(&mut self) {
        self.holder = None;
    }

    /// Takes the next number, after 255 the number 1.
    fn count(&mut self) {
        self.last_number = self.last_number.checked_add(1).unwrap_or(1);
    }

    /// How much of the silence a host other than the holder still has to wait for.
    fn held_for(&self, host: u32, now: Duration) -> Duration {
        match &self.holder {
            Some(holder) if holder.host != host => SILENCE.saturating_sub(now.saturating_sub(holder.heard)),
            _ => Duration::ZERO,
        }
    }

    fn open(&mut self, hello: &Hello, now: Duration) {
        self.count();
        self.holder = Some(Holder { nonce: hello.nonce, host: hello.host, heard: now });
    }

    fn was_opened_by(&self, hello: &Hello) -> bool {
        self.holder.as_ref().is_some_and(|holder| (holder.nonce, holder.host) == (hello.nonce, hello.host))
    }
}

impl Board {
    /// Opens a session, or repeats the answer to the greeting that opened it.
    pub(super) fn greet(&mut self, hello: &Hello, now: Duration) -> Result<Welcome, Refused> {
        self.session.heard_from(hello.host, now);
        if !(hello.version_min..=hello.version_max).contains(&VERSION) {
            return Err((RefusalCode::Version, VERSION.into()));
        }
        let left = self.session.held_for(hello.host, now);
        if !left.is_zero() && !hello.take_over && !self.has(Conduct::NeverHeld) {
            // Rounded up, so that the board is free once the host has waited that long.
            let tenths = left.as_nanos().div_ceil(TENTH.as_nanos());
            return Err((RefusalCode::Held, u16::try_from(tenths).unwrap_or(u16::MAX)));
        }
        if !self.session.was_opened_by(hello) {
            self.session.open(hello, now);
            self.bursts.forget();
            self.drop_rows(RowBanks::new(self.options.row_banks_in));
            if !self.has(Conduct::CountersKept) {
                self.status = Status::default();
            }
        }
        Ok(Welcome {
            nonce: hello.nonce,
            version: VERSION,
            session: self.session.number(),
            build: 0,
            serial: self.options.serial,
        })
    }

    /// Closes the session after the answer to the RESET that asks for it.
    pub(super) fn close_session(&mut self) {
        self.session.close();
        if self.has(Conduct::CountedClose) {
            self.session.count();
        }
    }

    /// Drops what `reset` names. The session itself is closed after the reply.
    pub(super) fn reset(&mut self, reset: &Reset) {
        self.bursts.abort();
        let packets = if self.has(Conduct::PacketsAnew) { 0 } else { self.rows.packets() };
        let restarted = self.rows.restarted(reset.next_row, packets);
        self.drop_rows(restarted);
        if reset.level == ResetLevel::Tables {
            self.tables = Tables::new(&self.options, self.fault);
            self.configured = false;
        }
    }

    /// Drops the rows in the banks and in the core, and a pending commit. `rows` are the banks from then on.
    fn drop_rows(&mut self, rows: RowBanks) {
        self.rows = rows;
        self.tables.forget_commit();
        self.empty_core();
    }

    /// Returns the core to its state before any row entered.
    pub(super) fn empty_core(&mut self) {
        let settings = self.player.settings().clone();
        // A player of this build has already run with these settings, so this cannot fail.
        if let Ok(mut player) = Player::new(&self.options, self.fault)
            && player.configure(settings).is_ok()
        {
            self.player = player;
        }
    }
}
