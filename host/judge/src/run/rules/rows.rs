//! Rows that must be refused, followed by rows that must come back right.

use std::mem;

use halfrow_protocol::Kind;
use halfrow_protocol::message::{Commit, Entries, RefusalCode, Request, RowIn, RowPlace, Span};
use halfrow_protocol::samples::pack;

use super::compared::Compared;
use super::counts::equal;
use super::{FIRST_FACTOR, Rules, counter_wrong, doubted, of_rows, other_row, payload};
use crate::board::CameAgain;
use crate::reference::correct;
use crate::result::{CheckName, Counter, Doubt, Rule};
use crate::run::drawn::{BY_TURNS, fit};
use crate::run::findings::{During, End};
use crate::tables::Generation;

/// The generation with which rows are made.
pub(super) const GENERATION: u8 = 0x96;
/// The frame whose rows are given out of order.
pub(super) const FRAME: u16 = 0x1234;
/// The bytes of a row's place.
const PLACE: usize = 12;
/// How often a row is given until it is inside the core.
pub(super) const TRIES: u32 = 8;
/// How often the board must say of a row that it has entered and is not inside.
const SAYINGS: u32 = 3;
/// How often a row is asked for again: enough for counts of which any of seven bits is wrong.
const AGAIN: u16 = 64;
/// The lowest bit of a row's number that a session does not reach by counting.
const FAR: u32 = 8;
/// Bytes that are sent to the board between rows and the RESET that drops them.
const BYTES_TO_CUT: [usize; 8] = [0, 3, 9, 17, 30, 50, 77, 120];

impl Rules<'_, '_> {
    pub(super) fn rows(&mut self) -> Result<(), End> {
        self.rows_again()?;
        self.configurations()?;
        self.depths()?;
        self.first_rows()?;
        self.thrice(Self::ack_beyond)?;
        if self.height > 2 {
            self.second_rows()?;
            self.last_rows()?;
            self.early_row()?;
            self.again()?;
            self.cut_rows()?;
        }
        self.banks()?;
        self.heights()?;
        self.numbers()
    }

    /// Has the board make rows with the small tables, and checks a frame.
    pub(super) fn rows_again(&mut self) -> Result<(), End> {
        let rows = self.small.rows();
        self.configure(rows)?;
        self.upload(0)?;
        let Generation { number, tables, kernel } = self.small.made(0, rows, GENERATION);
        self.run.board.commit(&tables, &kernel, FRAME, number).during(CheckName::Rules)?;
        self.right_frames(&[FRAME])
    }

    /// The FAIL of a board that is ready for rows and, after a RESET that must drop nothing but rows, is not; none if that is not so.
    pub(super) fn reset_too_far(&mut self) -> Option<End> {
        self.drop_rows().and_then(|()| self.rows_again()).ok()?;
        self.row_too_wide(Rule::RowPlace).and_then(|()| self.drop_rows()).ok()?;
        self.row_too_wide(Rule::Closed).err().filter(End::is_failed)
    }

    /// Sends a row of another width than the configuration's, which must be refused for that if there are tables.
    fn row_too_wide(&mut self, rule: Rule) -> Result<(), End> {
        let first = self.place(0);
        self.row_refused(rule, RowPlace { width: first.width + 2, ..first }, RefusalCode::Row)
    }

    /// Streams frames of which every row must come back right.
    pub(super) fn right_frames(&mut self, frames: &[u16]) -> Result<(), End> {
        let made = self.small.made(0, self.height, GENERATION);
        let compared = Compared::default().with(&self.small, frames.iter().copied(), &made);
        self.frames(Rule::Rows, compared)
    }

    /// Row `row` of the frame, with the number that it has if the frame is the next one.
    pub(super) fn place(&self, row: u16) -> RowPlace {
        RowPlace {
            row_sequence: self.run.board.acknowledged() + u32::from(row),
            frame: FRAME,
            row,
            width: self.small.geometry.width() as u16,
            last: usize::from(row) + 1 == self.height,
        }
    }

    /// Sends a black row at `place`, which must be refused.
    pub(super) fn row_refused(&mut self, rule: Rule, place: RowPlace, code: RefusalCode) -> Result<(), End> {
        self.refused(rule, &Request::RowIn(RowIn { place, packed: &black(place) }), code, 0)
    }

    /// After a RESET only row 0 in its place must be taken, and nothing beyond the window.
    fn first_rows(&mut self) -> Result<(), End> {
        self.window()?;
        let first = self.place(0);
        let second = RowPlace { row_sequence: first.row_sequence, ..self.place(1) };
        let wrong = [
            second,
            RowPlace { width: first.width + 2, ..first },
            RowPlace { row: self.height as u16, ..first },
            RowPlace { last: !first.last, ..first },
        ];
        for place in wrong {
            self.row_refused(Rule::RowPlace, place, RefusalCode::Row)?;
        }
        self.window_stays()?;
        self.odd_rows(first)?;
        let credit = self.run.board.credit();
        self.marked_row_refused(Rule::RowPlace, second, RefusalCode::Row)?;
        let beyond = RowPlace { row_sequence: credit, ..first };
        self.marked_row_refused(Rule::Credit, beyond, RefusalCode::Credit)?;
        let beyond = (0..u32::BITS).filter_map(|bit| credit.checked_add(1 << bit));
        for row_sequence in beyond.chain([credit]) {
            let place = RowPlace { row_sequence, ..first };
            self.row_refused(Rule::Credit, place, RefusalCode::Credit)?;
        }
        self.right_frames(&[FRAME])?;
        // Only row 0 follows the last row of a frame.
        let following = RowPlace { row_sequence: self.run.board.acknowledged(), ..self.place(1) };
        self.row_refused(Rule::RowPlace, following, RefusalCode::Row)
    }

    /// A row of an odd width whose pairs are there, and rows of which a byte is missing. A board that does not look for the
    /// missing byte says of a row beyond the window that there is no credit, so it plays none.
    fn odd_rows(&mut self, first: RowPlace) -> Result<(), End> {
        let packed = black(RowPlace { width: first.width + 2, ..first });
        let odd = RowPlace { width: first.width + 1, ..first };
        let request = Request::RowIn(RowIn { place: odd, packed: &packed });
        self.refused(Rule::RowPlace, &request, RefusalCode::Row, 0)?;
        let beyond = RowPlace { row_sequence: self.run.board.credit(), ..first };
        let whole = payload(&Request::RowIn(RowIn { place: beyond, packed: &black(beyond) }));
        for bytes in [whole.len() - 1, PLACE, PLACE - 1] {
            self.bytes_refused(Rule::Payload, Kind::RowIn, &whole[..bytes], RefusalCode::Payload, 0)?;
        }
        Ok(())
    }

    /// Gives row `row` of the frame, one of the first two, for which there always is credit.
    pub(super) fn give(&mut self, row: u16) {
        let place = self.place(row);
        let made = self.small.made(0, self.height, GENERATION);
        let frame = self.small.frame(FRAME, &made.tables);
        let number = self.run.board.give(&place, frame.frame.row(row.into()));
        self.given.rows = self.given.rows.max(u32::from(row) + 1);
        self.given.numbers.push(number);
    }

    /// Whether the board says of row 0, whose successor it does not have, that it has entered the core and that none is inside:
    /// each time in one answer, since an old RESET may drop the row.
    fn says_entered(&mut self, place: RowPlace) -> Result<bool, End> {
        let entered = place.row_sequence + 1 + u32::from(self.capabilities.row_banks_in);
        for _ in 0..SAYINGS {
            let (status, window) = self.run.board.status_and_window().during(CheckName::Rules)?;
            if status.core_busy == 1 || window != entered {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Gives row 0 of several, and waits until it is inside the core. The wire does not say how long a row may wait before
    /// that, so a row that does not enter makes no board wrong.
    pub(super) fn enter(&mut self) -> Result<(), End> {
        let place = self.place(0);
        let (rule, after, mut next_row_in) = (Some(Rule::Inside), place.row_sequence + 1, 0);
        for _ in 0..TRIES {
            self.give(0);
            let status = self.status()?;
            if status.core_busy == 1 {
                return Ok(());
            }
            next_row_in = status.next_row_in;
        }
        if next_row_in < after {
            let not_taken = counter_wrong(rule, Counter::NextRowIn, next_row_in, after);
            return Err(doubted(not_taken, Doubt::AnswerLost {}));
        }
        let finding = counter_wrong(rule, Counter::CoreBusy, 0, 1);
        if self.says_entered(place)? {
            return Err(End::failed(CheckName::Rules, finding));
        }
        Err(doubted(finding, Doubt::AnswerLost {}))
    }

    /// With row 0 inside, tries rows other than row 1, and everything that must wait until row 0 has left.
    fn second_rows(&mut self) -> Result<(), End> {
        self.enter()?;
        self.busy(Rule::Inside)?;
        if self.capabilities.table_banks > 1 {
            // No row uses the other bank.
            let span = Span { count: 0, ..FIRST_FACTOR };
            self.replied(Rule::Inside, &Request::TableWrite(Entries { span, bytes: &[] }), Vec::new())?;
        }
        let second = self.place(1);
        let bits = (0..u16::BITS).map(|bit| 1 << bit);
        let frames = bits.clone().map(|bit| RowPlace { frame: FRAME ^ bit, ..second });
        let rows = bits.filter(|bit| second.row ^ bit != 0);
        let rows = rows.map(|bit| RowPlace { row: second.row ^ bit, ..second });
        let others = [
            RowPlace { width: second.width + 2, ..second },
            RowPlace { width: 2 * second.width, ..second },
            RowPlace { last: true, ..second },
        ];
        for place in frames.chain(rows).chain(others) {
            self.row_refused(Rule::RowPlace, place, RefusalCode::Row)?;
        }
        self.right_frames(&[FRAME])
    }

    /// Tries what must wait until the core is empty.
    pub(super) fn busy(&mut self, rule: Rule) -> Result<(), End> {
        let commit =
            Commit { steps_crc: 0, kernel_crc: 0, first_frame: 0, generation: !GENERATION, shape: None };
        let requests = [
            Request::TableRead(FIRST_FACTOR),
            Request::TableCrc(FIRST_FACTOR),
            Request::Commit(commit),
            // A configuration out of range must wait too.
            Request::Configure(self.without_depth(self.configuration())),
        ];
        for request in requests {
            self.refused(rule, &request, RefusalCode::Busy, 0)?;
        }
        Ok(())
    }

    /// A last row that is not marked as the last.
    fn last_rows(&mut self) -> Result<(), End> {
        self.configure(2)?;
        self.give(0);
        let place = RowPlace { last: false, ..self.place(1) };
        self.row_refused(Rule::RowPlace, place, RefusalCode::Row)?;
        self.right_frames(&[FRAME])?;
        self.configure(self.small.rows())
    }

    /// A row must come as often as it is asked for, until it is acknowledged.
    fn again(&mut self) -> Result<(), End> {
        self.configure(2)?;
        let made = self.small.made(0, 2, GENERATION);
        let frame = self.small.frame(FRAME, &made.tables).frame;
        let corrected = correct(&made.tables, &made.kernel, &frame).ok();
        let compared = Compared::default().with(&self.small, [FRAME], &made);
        self.give(0);
        self.give(1);
        let (first, second) = (self.place(0), self.place(1));
        let (row, after) = ((&first, frame.row(0)), (&second, frame.row(1)));
        let retries = self.run.board.tally().retries;
        let mut right = None;
        for repeats in 0..=AGAIN {
            let came = self.run.board.again(row, Some(after), repeats);
            let mut came = came.map_err(|error| of_rows(Rule::Again, error))?;
            came.entered = came.entered.filter(|_| self.small.names_entered);
            // Over a poor link it may have been asked for more often.
            if came.repeats != repeats && !self.is_calm(retries)? {
                came.repeats = repeats;
            }
            let right = right.get_or_insert_with(|| CameAgain {
                generation: GENERATION,
                samples: corrected.as_ref().map_or(&*came.samples, |right| right.row(0)).to_vec(),
                ..came.clone()
            });
            right.repeats = repeats;
            if came != *right {
                let differs = compared.differing_again(&came.row(&first), repeats);
                return Err(other_row(Rule::Again, 0, FRAME, differs));
            }
        }
        // Nothing is inside now, but both rows are still kept.
        let configure = Request::Configure(self.configuration());
        self.refused(Rule::Inside, &configure, RefusalCode::Busy, 0)?;
        self.run.board.acknowledge(first.row_sequence + mem::take(&mut self.given).rows);
        self.configure(self.small.rows())
    }

    /// Whether nothing was sent again since there were `retries`, and nothing reached the board twice.
    pub(super) fn is_calm(&mut self, retries: u64) -> Result<bool, End> {
        let status = self.status()?;
        let board = &self.run.board;
        Ok(board.tally().retries == retries && board.had_each_packet_once(&status))
    }

    /// Rows that are dropped while they leave, each time at another place, followed by rows that must be right.
    fn cut_rows(&mut self) -> Result<(), End> {
        for bytes in BYTES_TO_CUT {
            self.give(0);
            self.give(1);
            let given = mem::take(&mut self.given).rows;
            self.run.board.drop_rows_after(bytes, given).during(CheckName::Rules)?;
            // Whatever row was last before, only row 0 may be first now.
            for row in [1, 2] {
                let place = RowPlace { row_sequence: self.run.board.acknowledged(), ..self.place(row) };
                self.row_refused(Rule::RowPlace, place, RefusalCode::Row)?;
            }
            self.right_frames(&[FRAME])?;
        }
        Ok(())
    }

    /// Rows wrongly marked as the last or not, for heights in which every bit is set once. The row before them has not come.
    fn heights(&mut self) -> Result<(), End> {
        for bits in BY_TURNS {
            let rows = fit(bits, self.capabilities.max_height.into()).max(1);
            self.configure(rows)?;
            let (last, row_sequence) = (rows as u16 - 1, self.run.board.acknowledged() + 1);
            let place = RowPlace { row_sequence, row: last, last: true, ..self.place(0) };
            let others = (0..u16::BITS).map(|bit| RowPlace { row: last ^ 1 << bit, ..place });
            let beyond = RowPlace { row: rows as u16, last: false, ..place };
            for place in others.chain([RowPlace { last: false, ..place }, beyond]) {
                self.row_refused(Rule::RowPlace, place, RefusalCode::Row)?;
            }
        }
        self.configure(self.small.rows())
    }

    /// Row numbers on both sides of each power of two.
    fn numbers(&mut self) -> Result<(), End> {
        for bit in FAR..u32::BITS {
            let next_row = (1 << bit) - 2;
            if next_row > self.run.board.credit() {
                self.window_goes_up(next_row)?;
                self.right_frames(&[FRAME])?;
                self.counted()?;
            }
        }
        Ok(())
    }

    /// The last numbers of all. The window does not wrap, so the greatest one never gets credit.
    pub(super) fn last_numbers(&mut self) -> Result<(), End> {
        self.window_goes_up(u32::MAX - self.height as u32)?;
        self.right_frames(&[FRAME])?;
        self.counted()?;
        self.row_refused(Rule::Credit, self.place(0), RefusalCode::Credit)?;
        self.window_stays()
    }

    /// The board's row numbers must be the host's.
    fn counted(&mut self) -> Result<(), End> {
        let status = self.status()?;
        let right = self.run.board.acknowledged();
        equal(
            Some(Rule::RowNumber),
            &status,
            &[Counter::NextRowIn, Counter::NextRowOut].map(|counter| (counter, right)),
        )
    }
}

/// The samples of a black row.
pub(super) fn black(place: RowPlace) -> Vec<u8> {
    let mut packed = Vec::new();
    pack(&vec![0; place.width.into()], &mut packed);
    packed
}
