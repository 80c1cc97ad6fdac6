//! Packets that must have no effect: damaged ones, and those of another session.

use halfrow_protocol::Kind;
use halfrow_protocol::message::{Entries, Refusal, RefusalCode, Request};

use super::sessions::TIMES;
use super::{FIRST_FACTOR, Rules, answer, broken, miscounted, payload};
use crate::board::{BoardError, Response};
use crate::result::{Answer, CheckName, Counter, Rule};
use crate::run::findings::{During, End};

/// The row factor that must stay in its place.
const KEPT: [u8; 4] = 1_u32.to_le_bytes();

/// A row factor that nothing else writes.
const OTHER: [u8; 4] = 0x1a5_u32.to_le_bytes();

const READ: Request<'static> = Request::TableRead(FIRST_FACTOR);

/// The least number of rows that must have come, each once, before doubled answers count as the board's fault.
const ROWS: u32 = 64;

/// Numbers of this many coming sessions are left alone: a packet that the link holds back could belong to one of them later.
const TO_COME: u16 = 16;

impl Rules<'_, '_> {
    /// A row factor must stay as it was written, although packets that would write another one come with a flipped bit,
    /// in another version, or with another length than they name.
    pub(super) fn damage(&mut self) -> Result<(), End> {
        self.thrice(Self::damage_counted)?;
        let mut said = self.after_damage()?.0;
        for _ in 1..TIMES {
            // A link that happens to flip the same bit back makes one of them whole, but not every time.
            if is_other(&said) || self.run.board.answer_to_damaged().is_some() {
                said = self.after_damage()?.0;
            }
        }
        self.judge_kept(Rule::Damage, said)?;
        match self.run.board.answer_to_damaged() {
            None => Ok(()),
            Some(said) => {
                self.run.board.excuse_repeats().during(CheckName::Rules)?;
                Err(broken(Rule::Damage, write(&OTHER).kind(), Answer::Nothing {}, answer(&said)))
            }
        }
    }

    /// Each request must have one answer. A link that doubles answers would also double rows, or packets to the board,
    /// which counts these.
    pub(super) fn answered_once(&mut self) -> Result<(), End> {
        let board = &mut self.run.board;
        let [answered, twice] = board.answers();
        if board.rows_came() < ROWS || board.rows_doubled() > 0 || 2 * twice < answered {
            return Ok(());
        }
        let status = board.status().during(CheckName::Rules)?;
        if !board.had_each_packet_once(&status) {
            return Ok(());
        }
        // The repeats are the finding, and so no reason to doubt it.
        board.excuse_repeats().during(CheckName::Rules)?;
        let right = Answer::Replied { payload: String::new() };
        Err(broken(Rule::Once, Kind::TableWrite, right, Answer::Twice {}))
    }

    /// What is read in the row factor's place after damaged packets, and how many of each kind these were.
    fn after_damage(&mut self) -> Result<(Result<Response, BoardError>, [u32; 2]), End> {
        self.replied(Rule::Damage, &write(&KEPT), Vec::new())?;
        let damaged = self.run.board.give_damaged(&write(&OTHER));
        Ok((self.read(), damaged))
    }

    /// Damaged packets must be counted by their kind. What stands between host and board may drop some of a kind, such as
    /// those that do not unstuff, or all of both.
    fn damage_counted(&mut self) -> Result<(), End> {
        let before = self.status()?;
        let (_, [crc, framing]) = self.after_damage()?;
        let after = self.status()?;
        if !self.run.board.had_each_packet_once(&after) {
            return Ok(());
        }
        let counted = [
            after.crc_errors.saturating_sub(before.crc_errors),
            after.framing_errors.saturating_sub(before.framing_errors),
        ];
        let is_of_both = counted[0] > crc && counted[0] >= most_of(framing);
        match counted {
            [0, 0] => Ok(()),
            [0, _] => Err(miscounted(Some(Rule::Damage), Counter::CrcErrors, 0, crc)),
            [_, 0] => Err(miscounted(Some(Rule::Damage), Counter::FramingErrors, 0, framing)),
            [counted, _] if is_of_both => {
                Err(miscounted(Some(Rule::Damage), Counter::CrcErrors, counted, crc))
            }
            _ => Ok(()),
        }
    }

    /// The row factor must stay although packets of other sessions would write another one, and each of these must be refused.
    pub(super) fn other_sessions(&mut self) -> Result<(), End> {
        let other = write(&OTHER);
        for session in others(self.run.board.session()) {
            let said = self.run.board.ask_in_session(session, other.kind(), &payload(&other));
            let posed = self.posed();
            let refusal = Refusal { code: RefusalCode::Session, kind: other.kind().code(), detail: 0 };
            // Read first: a board that carries the packet out may answer as in its own session, which is then not taken
            // for an answer.
            let read = self.read();
            let kept = self.judge_kept(Rule::Session, read);
            if kept.as_ref().is_err_and(|end| !end.is_outage()) {
                return kept;
            }
            // A link that broke meanwhile must not hide what was answered before.
            self.judge(Rule::Session, posed, said, &Response::Refused(refusal))?;
            kept?;
        }
        Ok(())
    }

    fn read(&mut self) -> Result<Response, BoardError> {
        self.run.board.ask(READ.kind(), &payload(&READ))
    }

    /// Ends if `said`, which was read in the row factor's place, is not what was written there.
    fn judge_kept(&mut self, rule: Rule, said: Result<Response, BoardError>) -> Result<(), End> {
        if is_other(&said) {
            // Whatever else the link did, only a packet that must have no effect can have written this.
            self.run.board.excuse_repeats().during(CheckName::Rules)?;
        }
        self.judge(rule, self.posed(), said, &Response::Replied(payload(&write(&KEPT))))
    }
}

/// Three quarters of `packets`.
fn most_of(packets: u32) -> u32 {
    packets - packets / 4
}

/// Whether the row factor is the one that must not have been written.
fn is_other(said: &Result<Response, BoardError>) -> bool {
    matches!(said, Ok(Response::Replied(entry)) if entry.ends_with(&OTHER))
}

fn write(bytes: &[u8; 4]) -> Request<'_> {
    Request::TableWrite(Entries { span: FIRST_FACTOR, bytes })
}

/// 0, the session before `open`, and those whose numbers differ from it in one bit.
pub(super) fn others(open: u8) -> impl Iterator<Item = u8> {
    let before = if open == 1 { u8::MAX } else { open - 1 };
    // 255 follows 254, and 1 follows 255.
    let ahead = move |session: u8| (u16::from(session) + 255 - u16::from(open)) % 255;
    let with_a_bit = (0..u8::BITS).map(move |bit| open ^ 1 << bit);
    let apart = with_a_bit.filter(move |&session| session != 0 && ahead(session) > TO_COME);
    [0, before].into_iter().chain(apart.filter(move |&session| session != before))
}
