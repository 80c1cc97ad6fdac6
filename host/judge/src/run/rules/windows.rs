//! How far ahead of the rows that it has a board lets the host send (WIRE.md, 4).

use halfrow_protocol::Kind;

use super::Rules;
use super::counts::equal;
use super::rows::TRIES;
use crate::result::{CheckName, Counter, Rule};
use crate::run::findings::{During, End};
use crate::run::sessions::window::window_wrong;

/// A row sequence number below the greatest that the rules reach, and far from any that they used.
const SMALLER: u32 = 3 << 29;

impl Rules<'_, '_> {
    /// After a RESET no row is inside, so the window must be as far ahead as there are input banks.
    pub(super) fn window(&mut self) -> Result<(), End> {
        let rows = self.run.board.credit_after_reset().during(CheckName::Rules)?;
        self.must_have_credit(Kind::Reset, rows)
    }

    /// After a RESET to a smaller number the window must be as far ahead of that one as there are input banks.
    pub(super) fn window_goes_down(&mut self) -> Result<(), End> {
        let rows = self.run.board.credit_after_reset_to(SMALLER).during(CheckName::Rules)?;
        self.must_have_credit(Kind::Reset, rows)
    }

    /// The refusal of a row, the last answer, must name the same window as the answer to the RESET before it: no row has entered.
    pub(super) fn window_stays(&mut self) -> Result<(), End> {
        let board = &self.run.board;
        let rows = board.answered().window.saturating_sub(board.acknowledged());
        self.must_have_credit(Kind::RowIn, rows)
    }

    /// An acknowledgement of rows that the board has not sent must count as far as it has sent them. The rows after it begin behind
    /// those, so that a late copy acknowledges none of them.
    pub(super) fn ack_beyond(&mut self) -> Result<(), End> {
        self.drop_rows()?;
        let (right, beyond) = (self.run.board.acknowledged(), self.run.board.credit());
        for _ in 0..TRIES {
            self.run.board.acknowledge_alone(beyond);
            let status = self.status()?;
            equal(Some(Rule::Banks), &status, &[(Counter::NextRowOut, right)])?;
            if self.run.board.had_each_packet_once(&status) {
                self.right += 1;
                break;
            }
        }
        self.drop_rows()
    }

    /// After a RESET the board must give credit for as many rows as it has input banks. It gave it for `rows` in its answer to
    /// a request of `kind`.
    fn must_have_credit(&mut self, kind: Kind, rows: u32) -> Result<(), End> {
        let banks = self.capabilities.row_banks_in.into();
        if rows != banks {
            return Err(End::failed(CheckName::Rules, window_wrong(kind, banks, rows)));
        }
        self.right += 1;
        Ok(())
    }
}
