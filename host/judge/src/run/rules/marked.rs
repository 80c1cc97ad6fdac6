//! Rows with what a board must ignore, and rows that must not be refused.

use halfrow_protocol::Kind;
use halfrow_protocol::message::{RefusalCode, Request, RowIn, RowPlace};
use halfrow_protocol::samples::pack;

use super::rows::{FRAME, GENERATION, black};
use super::{Rules, answer, broken, longer};
use crate::board::Response;
use crate::result::{Answer, Rule};
use crate::run::findings::End;

/// Where the flags of a row's place are, just before its generation, and the one flag that has a meaning (WIRE.md, 20).
const FLAGS: usize = 10;
const LAST: u8 = 1;

impl Rules<'_, '_> {
    /// Sends a black row at `place` with what a board must ignore, which must be refused all the same. Ends with `rule` if the row
    /// is not refused without all that either.
    pub(super) fn marked_row_refused(
        &mut self,
        rule: Rule,
        place: RowPlace,
        code: RefusalCode,
    ) -> Result<(), End> {
        let bytes = marked(RowIn { place, packed: &black(place) });
        let found = self.bytes_refused(Rule::Skipped, Kind::RowIn, &bytes, code, 0);
        self.or_plain(found, |rules| {
            // Should the board have taken the row, it would know this one.
            let before = rules.run.board.acknowledged();
            rules.drop_rows()?;
            let further = rules.run.board.acknowledged().saturating_sub(before);
            let row_sequence = place.row_sequence.saturating_add(further);
            rules.row_refused(rule, RowPlace { row_sequence, ..place }, code)
        })
    }

    /// A row that arrives before the row above it. While it waits the window must stay. The row above has what a board must ignore.
    pub(super) fn early_row(&mut self) -> Result<(), End> {
        self.drop_rows()?;
        self.give(1);
        self.status()?;
        self.window_stays()?;
        let made = self.small.made(0, self.height, GENERATION);
        let frame = self.small.frame(FRAME, &made.tables).frame;
        let mut packed = Vec::new();
        pack(frame.row(0), &mut packed);
        let marked = marked(RowIn { place: self.place(0), packed: &packed });
        let number = self.run.board.give_bytes(Kind::RowIn, &marked);
        self.given.numbers.push(number);
        let came = self.right_frames(&[FRAME, FRAME + 1]);
        self.unless_refused(Rule::Skipped, number, came)
    }

    /// What was `tried` after the row in the packet `number` was sent; ends with `rule` instead if that row was the last refused one.
    /// A board that has lost its session refuses all rows.
    pub(super) fn unless_refused(
        &mut self,
        rule: Rule,
        number: u16,
        tried: Result<(), End>,
    ) -> Result<(), End> {
        let refusal = self.run.board.refusal_of_row(number);
        match refusal.filter(|refusal| refusal.code != RefusalCode::Session) {
            None => tried,
            Some(refusal) => {
                let found = answer(&Response::Refused(refusal));
                Err(broken(rule, Kind::RowIn, Answer::Nothing {}, found))
            }
        }
    }
}

/// The payload of `row` with what a board must ignore: the other flags, the generation, and a byte after the samples.
fn marked(row: RowIn<'_>) -> Vec<u8> {
    let mut bytes = longer(&Request::RowIn(row));
    bytes[FLAGS] |= !LAST;
    bytes[FLAGS + 1] = GENERATION;
    bytes
}
