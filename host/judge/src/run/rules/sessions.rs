//! What opens a session and what ends one, what is gone then and what stays.

use std::time::Duration;

use halfrow_protocol::message::{
    Burst, BurstMode, Commit, Entries, Records, Refusal, RefusalCode, Request, Span, Table,
};
use halfrow_protocol::{Kind, VERSION};

use super::bursts::Awaited;
use super::counts::equal;
use super::greetings::another_session;
use super::rows::{FRAME, GENERATION};
use super::trap::NOTHING_KEPT;
use super::{FIRST_FACTOR, Refusals, Rules, broken, doubted};
use crate::board::{Board, BoardError, Given, Response, Status, Tally};
use crate::result::{Answer, CheckName, Counter, Doubt, Rule};
use crate::run::at_speed::known_bursts;
use crate::run::findings::{During, End};
use crate::run::frames::counters::rows_numbered;
use crate::tables::Generation;

/// How often a board must do what it must not, where a link or the board's supply could cause it too, though not every
/// time: a late copy of an old HELLO also opens a session.
pub(super) const TIMES: usize = 3;
/// The tenths of a second for which a board is held after its holder's last packet; and half of that time.
const HELD: u16 = 100;
const SURELY_HELD: Duration = Duration::from_secs(5);
/// Versions that a host may speak and no board does: version 0 is none, and a board would have to know all up to the last.
const NOT_SPOKEN: [[u8; 2]; 2] = [[0, 0], [u8::MAX, u8::MAX]];
/// The greatest version that a refusal may name as the board's newest.
const MOST_VERSION: u16 = u8::MAX as u16 - 1;
/// The frame for which a commit is pending when its session ends, and the generation that it would make.
const PENDING: (u16, u8) = (0x4321, 0x3c);
/// Frames of a burst that have been made when its session ends: every board has records for two.
const FEW: u32 = 2;
/// The answers to the RESET that closes a session, to a request in that session, and to the next greeting.
const ANSWERS_TO_CLOSE: u64 = 3;
/// The first row that is trapped in it. A board that forgot what it expects would trap the row before.
const SECOND_ROW: usize = 1;

impl Rules<'_, '_> {
    pub(super) fn sessions(&mut self) -> Result<(), End> {
        // A station that was frozen together with its clock does not know how long the board heard nothing of it.
        self.powered(|rules| rules.thrice(Self::held))?;
        self.other_versions()?;
        self.powered(|rules| rules.always(Self::greeted_again))?;
        // The session that follows drops what the link still holds of this one, with greater numbers of rows.
        self.thrice(Self::last_numbers)?;
        self.thrice(Self::window_goes_down)?;
        self.taken_over()?;
        self.numbers_of_sessions()?;
        self.powered(Self::session_after_rows)?;
        if known_bursts(&self.capabilities).is_ok() {
            self.powered(Self::session_after_a_burst)?;
        }
        self.rows_again()
    }

    /// Tries `scenario` again if the board fails in it and says that it has lost its power: that does not happen every time.
    fn powered(&mut self, scenario: fn(&mut Self) -> Result<(), End>) -> Result<(), End> {
        for _ in 1..TIMES {
            let tried = scenario(self);
            let has_failed = tried.as_ref().is_err_and(End::is_failed);
            if !has_failed || !self.has_lost_power() {
                return tried;
            }
            self.has_lost_session = true;
        }
        scenario(self)
    }

    /// Whether the board answers that it has neither session nor tables any more. One that does not answer may have both: its
    /// link may be broken, which must not hide what was found before.
    fn has_lost_power(&mut self) -> bool {
        match self.run.board.status() {
            Ok(status) => status.generation == 0,
            Err(error) => matches!(error, BoardError::SessionLost { .. }),
        }
    }

    /// Tries `scenario` again if the board fails in it: what a link caused does not happen every time.
    pub(super) fn thrice(&mut self, scenario: fn(&mut Self) -> Result<(), End>) -> Result<(), End> {
        let mut tried = scenario(self);
        for _ in 1..TIMES {
            let Err(found) = &tried else { return tried };
            if !found.is_failed() {
                return tried;
            }
            tracing::info!("{}; trying it again", found.finding().sentence());
            match scenario(self) {
                // A FAIL says more than an answer that no sound board gives.
                Err(again) if again.is_answer() => return tried,
                again => tried = again,
            }
        }
        tried
    }

    /// Another host must be told that the board is held, and for how long at most.
    fn held(&mut self) -> Result<(), End> {
        let begun = self.run.board.now();
        self.status()?;
        let said = self.run.board.greet_as_another_host();
        if matches!(said, Ok(Response::Replied(_))) {
            let took = self.run.board.now().saturating_sub(begun);
            self.next_session()?;
            if took > SURELY_HELD {
                return Ok(());
            }
        }
        let right = Refusal { code: RefusalCode::Held, kind: Kind::Hello.code(), detail: HELD };
        let said = said.map(|said| match said {
            // How much of the time is left depends on when the other host asks.
            Response::Refused(held @ Refusal { detail: 1..HELD, .. }) => {
                Response::Refused(Refusal { detail: HELD, ..held })
            }
            said => said,
        });
        self.greeting_refused(Rule::Held, said, right)
    }

    /// Another host that takes the board over must get it, whoever holds it.
    fn taken_over(&mut self) -> Result<(), End> {
        self.status()?;
        self.ends_right()?;
        let said = self.run.board.take_over_as_another_host().map(|said| match said {
            Response::Replied(_) => Response::Replied(Vec::new()),
            refused => refused,
        });
        self.judge(Rule::Held, Kind::Hello.into(), said, &Response::Replied(Vec::new()))?;
        // Until this host has the board back, it is held by a host that is none: nothing may come in between.
        let held = Answer::Refused { code: RefusalCode::Held as u8, detail: 0 };
        self.greet_by(Board::take_back).map_err(|error| match error {
            BoardError::NotGivenUp { .. } => {
                broken(Rule::Held, Kind::Hello, Answer::Replied { payload: String::new() }, held)
            }
            error => End::board(CheckName::Rules, &error),
        })?;
        self.same_board_greets()
    }

    /// A host that speaks no version that the board speaks must be refused. Which is the board's newest is not known.
    fn other_versions(&mut self) -> Result<(), End> {
        for versions in NOT_SPOKEN {
            let said = self.run.board.greet_in_versions(versions).map(|said| match said {
                Response::Refused(refusal @ Refusal { detail: 1..=MOST_VERSION, .. }) => {
                    Response::Refused(Refusal { detail: VERSION.into(), ..refusal })
                }
                said => said,
            });
            if matches!(said, Ok(Response::Replied(_))) {
                self.next_session()?;
            }
            let (code, kind) = (RefusalCode::Version, Kind::Hello.code());
            let right = Refusal { code, kind, detail: VERSION.into() };
            self.greeting_refused(Rule::NewSession, said, right)?;
        }
        Ok(())
    }

    /// The HELLO that opened the session, repeated, must open no other one.
    fn greeted_again(&mut self) -> Result<(), End> {
        self.rows_again()?;
        self.counts_on(Some(Rule::NewSession), |rules| {
            let own = rules.run.board.session();
            let again = rules.run.board.greet_again().during(CheckName::Rules)?;
            if again.session != own {
                rules.has_lost_session = true;
                // The window is not known until the board has answered in the new session.
                rules.status()?;
                return Err(another_session(Rule::NewSession, own, again.session));
            }
            let named = rules.run.board.answered().session;
            if named != own {
                return Err(another_session(Rule::NewSession, own, named));
            }
            rules.same_board(&again)?;
            rules.right += 1;
            Ok(())
        })
    }

    /// The number of each session must follow that of the one before.
    fn numbers_of_sessions(&mut self) -> Result<(), End> {
        let mut wrong = None;
        for _ in 0..TIMES {
            let right = next(self.run.board.session());
            self.next_session()?;
            let found = self.run.board.session();
            if found == right {
                self.right += 1;
                return Ok(());
            }
            wrong = Some(another_session(Rule::NewSession, right, found));
        }
        wrong.map_or(Ok(()), Err)
    }

    /// A session that ends with rows inside and a commit pending.
    fn session_after_rows(&mut self) -> Result<(), End> {
        self.drop_rows()?;
        self.rows_again()?;
        let two_banks = self.capabilities.table_banks > 1;
        let (frame, generation) = PENDING;
        if two_banks {
            let Generation { tables, kernel, .. } = self.small.made(1, self.height, generation);
            self.upload(1)?;
            self.run.board.commit(&tables, &kernel, frame, generation).during(CheckName::Rules)?;
        }
        if self.height > 2 {
            self.enter()?;
        }
        let before = self.status()?;
        self.given = Given::default();
        self.next_session()?;
        self.begun_anew(Rule::NewSession, &before)?;
        if two_banks {
            let span = Span { count: 0, ..FIRST_FACTOR };
            let write = Request::TableWrite(Entries { span, bytes: &[] });
            self.replied(Rule::NewSession, &write, Vec::new())?;
            self.sums(Rule::NewSession, 1)?;
        }
        self.right_frames(&[frame, FRAME])?;
        let status = self.status()?;
        rows_numbered(&status, self.run.board.packets_numbered())
    }

    /// A session that ends while a burst is under way, with records and a row that was trapped.
    fn session_after_a_burst(&mut self) -> Result<(), End> {
        self.drop_rows()?;
        self.rows_again()?;
        let Some(burst) = self.small_burst(Burst::ENDLESS) else { return Ok(()) };
        let mode = if self.has_trap() { BurstMode::Trapped } else { BurstMode::Fresh };
        let frame = self.expect_others_from(SECOND_ROW)?;
        let burst = self.start(Burst { mode, ..burst })?;
        self.look(&burst, 0, FEW, Awaited::under_way(FEW))?;
        let before = self.status()?;
        self.next_session()?;
        self.begun_anew(Rule::NewSession, &before)?;
        self.right_frames(&[FRAME])?;
        self.right_burst(Rule::NewSession, BurstMode::Fresh)?;
        // What is expected of rows stays when a session ends.
        let Some(frame) = frame.filter(|frame| frame.height() > SECOND_ROW) else { return Ok(()) };
        self.trapping()?;
        self.kept(SECOND_ROW, frame.row(SECOND_ROW))
    }

    /// Last of all: a RESET that closes the session. After it another host may have the board.
    pub(super) fn closed(&mut self) -> Result<(), End> {
        let (mut wrong, mut requests) = (Ok(()), 0);
        for _ in 0..TIMES {
            self.drop_rows()?;
            self.rows_again()?;
            let before = self.status()?;
            let (own, heard) = (self.run.board.session(), self.heard());
            self.close(own)?;
            match self.greet() {
                Err(BoardError::Held { .. }) => return Ok(()),
                Err(error) => return Err(End::board(CheckName::Rules, &error)),
                Ok(()) => self.same_board_greets()?,
            }
            let (right, found) = (next(own), self.run.board.session());
            if found == right {
                self.begun_anew(Rule::Closed, &before)?;
                return self.forget();
            }
            // Another host had the board meanwhile, its supply failed, or an old greeting came again, which the board answers.
            requests += (self.heard() - heard).saturating_sub(ANSWERS_TO_CLOSE);
            wrong = Err(another_session(Rule::NewSession, right, found));
        }
        wrong.map_err(|end| match requests {
            0 => end,
            _ => doubted(end.finding().clone(), Doubt::RequestsTwice { requests }),
        })
    }

    /// How many packets came, whosever they were.
    fn heard(&self) -> u64 {
        let Tally { packets_in, strays, .. } = self.run.board.tally();
        packets_in + strays
    }

    fn close(&mut self, session: u8) -> Result<(), End> {
        self.ends_right()?;
        self.run.board.close_session().during(CheckName::Rules)?;
        let said = self.run.board.ask_in_session(session, Kind::Status, &[0]);
        let refusal = Refusal { code: RefusalCode::Session, kind: Kind::Status.code(), detail: 0 };
        self.judge(Rule::Closed, self.posed(), said, &Response::Refused(refusal))
    }

    /// Drops configuration and tables, which must leave the session open.
    pub(super) fn forget(&mut self) -> Result<(), End> {
        for _ in 0..TIMES {
            self.run.board.forget().during(CheckName::Rules)?;
            match self.run.board.status() {
                Err(BoardError::SessionLost { .. }) => self.next_session()?,
                status => return status.map(drop).during(CheckName::Rules),
            }
        }
        let (right, code) = (Answer::Replied { payload: String::new() }, RefusalCode::Session as u8);
        Err(broken(Rule::Closed, Kind::Status, right, Answer::Refused { code, detail: 0 }))
    }

    /// Opens the next session. A doubt about the link in the session before stays.
    pub(super) fn next_session(&mut self) -> Result<(), End> {
        self.ends_right()?;
        self.greet().during(CheckName::Rules)?;
        self.same_board_greets()
    }

    fn greet(&mut self) -> Result<(), BoardError> {
        let right = next(self.run.board.session());
        self.greet_by(Board::open_another_session)?;
        // Or the board numbers its sessions wrong, which fails.
        self.has_lost_session |= self.run.board.session() != right;
        Ok(())
    }

    fn greet_by(&mut self, open: fn(&mut Board, u32) -> Result<(), BoardError>) -> Result<(), BoardError> {
        let doubt = Doubt::of_session(self.run.board);
        let earlier = &mut self.run.findings.attempt.doubt;
        *earlier = earlier.take().or(doubt);
        let nonce = self.run.sessions.next_nonce();
        open(self.run.board, nonce)?;
        (self.refusals, self.before) = (Refusals::default(), Status::default());
        Ok(())
    }

    /// Ends with what the board did in the session that no link can cause.
    pub(super) fn ends_right(&mut self) -> Result<(), End> {
        self.run.unless_misconduct(CheckName::Rules, Ok(()))
    }

    /// After HELLO no row, burst, commit or count may be left of the session before. Tables and configuration must be as they
    /// were at the status `before`.
    fn begun_anew(&mut self, rule: Rule, before: &Status) -> Result<(), End> {
        let status = self.status()?;
        self.not_counted(Some(rule), &status)?;
        equal(
            Some(rule),
            &status,
            &[
                (Counter::NextRowIn, 0),
                (Counter::NextRowOut, 0),
                (Counter::CoreBusy, 0),
                (Counter::Generation, before.generation),
            ],
        )?;
        // Without a configuration it is not ready, which comes first.
        let other =
            Commit { steps_crc: !0, kernel_crc: 0, first_frame: 0, generation: !GENERATION, shape: None };
        self.refused(rule, &Request::Commit(other), RefusalCode::TableCrc, Table::RowFactors as u16)?;
        if known_bursts(&self.capabilities).is_err() {
            return Ok(());
        }
        self.no_records(rule)?;
        if self.has_trap() {
            self.replied(rule, &Request::Trap, NOTHING_KEPT.to_vec())?;
        }
        Ok(())
    }

    fn no_records(&mut self, rule: Rule) -> Result<(), End> {
        let said = self.run.board.ask(Kind::Records, &[0; 4]).map(|said| match said {
            Response::Replied(mut payload) => {
                // The wire does not say which burst was the last one.
                payload.iter_mut().take(size_of::<u32>()).for_each(|byte| *byte = 0);
                Response::Replied(payload)
            }
            refused => refused,
        });
        self.judge(rule, self.posed(), said, &Response::Replied(vec![0; Records::HEAD]))
    }
}

/// The number that follows `session`: 1 after 255.
fn next(session: u8) -> u8 {
    session % u8::MAX + 1
}
