//! How far ahead of the rows that it has a board lets the host send (WIRE.md, 4).

use super::counts::equal;
use super::rows::TRIES;
use super::{Posed, Rules, counter_wrong, doubted, rule_broken};
use crate::board::{Board, Status, Tally};
use crate::result::{Answer, CheckName, Counter, Doubt, Finding, Rule};
use crate::run::findings::{During, End};

/// A row sequence number below the greatest that the rules reach, and far from any that they used.
const SMALLER: u32 = 3 << 29;

/// What the board counted before and behind a packet that was sent alone between two STATUS.
pub(super) struct Alone {
    pub(super) before: Status,
    pub(super) after: Status,
    /// Whether each STATUS was asked for and answered once.
    once: bool,
}

impl Alone {
    /// The packets that the board must have counted in the end: two more, that packet and the second STATUS.
    fn packets(&self) -> u32 {
        self.before.packets.saturating_add(2)
    }

    /// Whether something came besides the second STATUS: that packet, or a copy in place of it.
    fn has_come(&self) -> bool {
        self.after.packets >= self.packets()
    }

    /// Whether that was certainly the packet.
    pub(super) fn has_surely_come(&self) -> bool {
        self.once && self.after.packets == self.packets()
    }
}

impl Rules<'_, '_> {
    /// After a RESET no row is inside, so the window must be as far ahead as there are input banks.
    pub(super) fn window(&mut self) -> Result<(), End> {
        let rows = self.run.board.credit_after_reset().during(CheckName::Rules)?;
        self.must_have_credit(rows)
    }

    /// After a RESET to a smaller number the window must be as far ahead of that one as there are input banks.
    pub(super) fn window_goes_down(&mut self) -> Result<(), End> {
        let rows = self.run.board.credit_after_reset_to(SMALLER).during(CheckName::Rules)?;
        self.must_have_credit(rows)
    }

    /// After a RESET to `next_row`, a number not sent yet, the window must be as far ahead of that one as there are input banks.
    pub(super) fn window_goes_up(&mut self, next_row: u32) -> Result<(), End> {
        let rows = self.run.board.credit_after_reset_to(next_row).during(CheckName::Rules)?;
        self.must_have_credit(rows)
    }

    /// The last answer must give credit for as many rows as one to a RESET: every row that has entered is acknowledged. A window
    /// that has wrapped counts as far ahead of them as it is.
    pub(super) fn window_stays(&mut self) -> Result<(), End> {
        let board = &self.run.board;
        let rows = board.answered().window.wrapping_sub(board.acknowledged());
        self.must_have_credit(rows)
    }

    /// An acknowledgement of rows that the board has not sent must count as far as it has sent them. The rows after it begin behind
    /// those, so that a late copy acknowledges none of them.
    pub(super) fn ack_beyond(&mut self) -> Result<(), End> {
        self.drop_rows()?;
        let (right, beyond) = (self.run.board.acknowledged(), self.run.board.credit());
        let (rule, mut packets) = (Some(Rule::Banks), (0, 0));
        for _ in 0..TRIES {
            let alone = self.alone(|board| board.acknowledge_alone(beyond))?;
            self.ends_right()?;
            equal(rule, &alone.after, &[(Counter::NextRowOut, right)])?;
            if alone.has_come() {
                self.right += 1;
                return self.drop_rows();
            }
            packets = (alone.after.packets, alone.packets());
        }
        let (counted, right) = packets;
        Err(doubted(counter_wrong(rule, Counter::Packets, counted, right), Doubt::AnswerLost {}))
    }

    /// Sends a packet that need not be answered between two STATUS.
    pub(super) fn alone<T>(&mut self, send: impl FnOnce(&mut Board) -> T) -> Result<Alone, End> {
        let Tally { packets_out, strays, .. } = self.run.board.tally();
        let before = self.status()?;
        send(self.run.board);
        let after = self.status()?;
        let tally = self.run.board.tally();
        let once = tally.packets_out - packets_out == 3 && tally.strays == strays;
        Ok(Alone { before, after, once })
    }

    /// After a RESET the board must give credit for as many rows as it has input banks, but for none beyond the last number. It
    /// gave it for `rows` in its last answer.
    fn must_have_credit(&mut self, rows: u32) -> Result<(), End> {
        let banks = self.capabilities.row_banks_in.into();
        let right = (u32::MAX - self.run.board.acknowledged()).min(banks);
        if rows != right {
            return Err(End::failed(CheckName::Rules, window_wrong(self.posed(), right, rows)));
        }
        self.right += 1;
        Ok(())
    }
}

/// After a RESET the board gives credit for `rows`, in its answer to a request, instead of for `right`.
pub(in crate::run) fn window_wrong(posed: impl Into<Posed>, right: u32, rows: u32) -> Finding {
    let (right, found) = (Answer::Credit { rows: right }, Answer::Credit { rows });
    rule_broken(Rule::Window, posed, right, found)
}
