//! Rows that a board keeps in its output banks until the host has them: as many as there are banks, no more (WIRE.md, 4).

use std::mem;

use halfrow_protocol::Kind;
use halfrow_protocol::message::{RefusalCode, RowPlace};

use super::compared::Compared;
use super::counts::equal;
use super::rows::{FRAME, GENERATION, TRIES};
use super::sessions::TIMES;
use super::{Rules, broken, counter_wrong, doubted, miscounted, other_row, unanswered};
use crate::board::{BoardError, NumberedFrame, Status};
use crate::result::{Answer, CheckName, Counter, Doubt, Rule};
use crate::run::findings::End;

/// Rows that wait because all banks are full. The first of them takes the first bank that becomes free.
const WAITING: u32 = 2;

/// The rows that fill the banks, and those that wait.
struct FilledBanks {
    /// The row sequence number of the first one.
    first: u32,
    /// How many the banks hold.
    banks: u32,
    /// Rows of a frame. Whole frames fill the banks.
    height: u32,
    width: u16,
    /// How they must come back.
    right: Compared,
    /// The board's counters before them, the ROW_OUT packets that had come by then, and the retries.
    before: Status,
    came_before: u32,
    retries: u64,
    /// How often rows were asked for again that had come, and how often rows were sent that need no answer.
    asked: u32,
    unneeded: u32,
    /// Whether no row was given more often than that.
    is_exact: bool,
}

impl FilledBanks {
    /// The place of row `row`, counted from the first one.
    fn place(&self, row: u32) -> RowPlace {
        let (frame, row_of_it) = (row / self.height, row % self.height);
        RowPlace {
            row_sequence: self.first + row,
            frame: FRAME.wrapping_add(frame as u16),
            row: row_of_it as u16,
            width: self.width,
            last: row_of_it + 1 == self.height,
        }
    }

    /// Samples for another copy of a row that the board has; it must not use them.
    fn black(&self) -> Vec<u16> {
        vec![0; self.width.into()]
    }
}

/// The frames, of `height` rows each, of `rows` rows from row `from` on, which is the first of its frame.
fn frames(height: u32, from: u32, rows: u32) -> impl Iterator<Item = u16> {
    let last = (from + rows - 1) / height;
    (from / height..=last).map(|frame| FRAME.wrapping_add(frame as u16))
}

impl Rules<'_, '_> {
    /// Fills the banks, asks for each row again, acknowledges one, and then all.
    pub(super) fn banks(&mut self) -> Result<(), End> {
        let mut kept = self.fill()?;
        self.stay_away(&mut kept)?;
        self.damaged_frees_none(&kept)?;
        for row in 0..kept.banks {
            self.comes_again(&mut kept, row, 1)?;
        }
        self.window_at_most(&kept, 0)?;
        self.acknowledge_one(&mut kept)?;
        for row in [1, kept.banks - 1].into_iter().take(kept.banks as usize - 1) {
            self.comes_again(&mut kept, row, 2)?;
        }
        self.window_at_most(&kept, 1)?;
        self.release(&mut kept)?;
        self.kept_counted(&kept)?;
        self.configure(self.small.rows())
    }

    /// Fills the banks: rows that are not acknowledged must come like any others until there is no bank for another one.
    fn fill(&mut self) -> Result<FilledBanks, End> {
        let banks = u32::from(self.capabilities.row_banks_out);
        let height = (1..=self.small.tall() as u32).rev().find(|&rows| banks.is_multiple_of(rows));
        let height = height.unwrap_or(1);
        self.configure(height as usize)?;
        let (first, width) = (self.run.board.acknowledged(), self.small.geometry.width() as u16);
        let made = self.small.made(0, self.height, GENERATION);
        let mut kept = FilledBanks {
            first,
            banks,
            height,
            width,
            right: Compared::default().with(&self.small, frames(height, 0, banks), &made),
            before: self.status()?,
            came_before: self.run.board.rows_came(),
            retries: self.run.board.tally().retries,
            asked: 0,
            unneeded: 0,
            is_exact: true,
        };
        self.run.board.acknowledge_to(Some(first));
        let streamed = self.stream(&mut kept.right);
        self.end_if_missing(&kept, streamed)?;
        self.judge_rows(Rule::Banks, &kept.right)?;
        kept.right = mem::take(&mut kept.right).with(&self.small, frames(height, banks, 1), &made);
        Ok(kept)
    }

    /// The rows that `came`. If one is missing, ends with the board's silence if that is certain, otherwise with doubt.
    fn end_if_missing<T>(&mut self, kept: &FilledBanks, came: Result<T, BoardError>) -> Result<T, End> {
        let place = match came {
            Ok(came) => return Ok(came),
            Err(BoardError::RowMissing { place, .. }) => place,
            Err(error) => return Err(End::board(CheckName::Rules, &error)),
        };
        let right = Answer::Row { row: place.row.into(), frame: place.frame };
        if self.says_it_sent_no_more(kept)? && self.is_silent_when_asked_again(kept, &place)? {
            return Err(broken(Rule::Banks, Kind::RowIn, right, Answer::Nothing {}));
        }
        Err(unanswered(Rule::Banks, Kind::RowIn, right))
    }

    /// Whether the row at `place` stays away when asked for again, although the board says that it had everything that
    /// was sent.
    fn is_silent_when_asked_again(&mut self, kept: &FilledBanks, place: &RowPlace) -> Result<bool, End> {
        let black = kept.black();
        match self.run.board.again((place, &black), None, 0) {
            Ok(_) => Ok(false),
            Err(BoardError::RowMissing { .. }) => self.says_it_sent_no_more(kept),
            Err(error) => Err(End::board(CheckName::Rules, &error)),
        }
    }

    /// Whether the board had everything that was sent to it, and itself says that it sent only the rows that came.
    fn says_it_sent_no_more(&mut self, kept: &FilledBanks) -> Result<bool, End> {
        let status = self.status()?;
        let sent = |status: &Status| Counter::RowsNumbered.in_status(status);
        let came = self.run.board.rows_came() - kept.came_before;
        let is_all = sent(&status) == sent(&kept.before).saturating_add(came);
        Ok(is_all && self.run.board.had_each_packet_once(&status))
    }

    /// Gives the rows for which no bank is free. They must not come back, even if they are given again.
    fn stay_away(&mut self, kept: &mut FilledBanks) -> Result<(), End> {
        let made = self.small.made(0, self.height, GENERATION);
        let (all, mut next_row_in) = (kept.first + kept.banks + WAITING, 0);
        let mut is_behind_waiting = kept.height == 1;
        for look in 0..TRIES {
            kept.is_exact = look == 0;
            for row in kept.banks..kept.banks + WAITING {
                if row > kept.banks && !is_behind_waiting {
                    is_behind_waiting = self.must_follow(kept, row)?;
                    if !is_behind_waiting {
                        break;
                    }
                }
                let place = kept.place(row);
                let NumberedFrame { frame, .. } = self.small.frame(place.frame, &made.tables);
                let number = self.run.board.give(&place, frame.row(place.row.into()));
                self.given.numbers.push(number);
            }
            let status = self.status()?;
            self.window_at_most(kept, 0)?;
            next_row_in = status.next_row_in;
            if next_row_in == all {
                self.given.rows = WAITING;
                self.right += 1;
                return self.unneeded(kept, kept.banks);
            }
        }
        let not_taken = counter_wrong(Some(Rule::Banks), Counter::NextRowIn, next_row_in, all);
        Err(doubted(not_taken, Doubt::AnswerLost {}))
    }

    /// A row of another frame behind the one that waits must be refused. Returns whether that was tried: if the row before `row` has
    /// not come, any would be taken. Nor may `row` itself have been given, of which a late copy would make the other one known.
    fn must_follow(&mut self, kept: &FilledBanks, row: u32) -> Result<bool, End> {
        let place = kept.place(row);
        if self.status()?.next_row_in != place.row_sequence {
            return Ok(false);
        }
        let other = RowPlace { frame: place.frame ^ 1, ..place };
        self.row_refused(Rule::RowPlace, other, RefusalCode::Row)?;
        Ok(true)
    }

    /// Sends a row again that the board has and that needs no answer, with other samples and of another width. That it is known
    /// comes before its width.
    fn unneeded(&mut self, kept: &mut FilledBanks, row: u32) -> Result<(), End> {
        let place = RowPlace { width: kept.width + 2, ..kept.place(row) };
        let number = self.run.board.give(&place, &vec![0; place.width.into()]);
        kept.unneeded += 1;
        // An answer to the row would come before this one.
        let asked = self.status().map(drop);
        self.unless_refused(Rule::Banks, number, asked)
    }

    /// Damaged ROW_ACKs of all rows must free none. If something on the way makes a damaged packet whole, the board
    /// counts fewer of them than were sent.
    fn damaged_frees_none(&mut self, kept: &FilledBanks) -> Result<(), End> {
        self.run.board.disregard_rows(WAITING);
        let before = self.status()?;
        let sent: u32 = self.run.board.acknowledge_damaged(kept.first + kept.banks).iter().sum();
        let after = self.status()?;
        self.run.board.disregard_rows(0);
        if after.next_row_out == kept.first {
            self.right += 1;
            return Ok(());
        }
        let freed = counter_wrong(Some(Rule::Damage), Counter::NextRowOut, after.next_row_out, kept.first);
        let counted = after.damaged().saturating_sub(before.damaged());
        Err(if counted < sent {
            doubted(freed, Doubt::DamageUncounted { counted, sent })
        } else {
            End::failed(CheckName::Rules, freed)
        })
    }

    /// Row `row` must come again as it came before, with this `repeats`.
    fn comes_again(&mut self, kept: &mut FilledBanks, row: u32, repeats: u16) -> Result<(), End> {
        let (place, black) = (kept.place(row), kept.black());
        let came = self.run.board.again((&place, &black), None, repeats);
        let came = self.end_if_missing(kept, came)?;
        kept.asked += 1;
        let is_counted = came.repeats == repeats || !self.is_calm(kept.retries)?;
        let row = came.row(&place);
        if !is_counted || !kept.right.is_right(&row) {
            let differs = kept.right.differing_again(&row, if is_counted { came.repeats } else { repeats });
            return Err(other_row(Rule::Banks, place.row.into(), place.frame, differs));
        }
        self.right += 1;
        Ok(())
    }

    /// The board's window must be no further than if as many rows have entered as there are output banks, plus `freed`.
    fn window_at_most(&self, kept: &FilledBanks, freed: u32) -> Result<(), End> {
        let rows = self.run.board.window().saturating_sub(kept.first);
        let most = kept.banks + freed + u32::from(self.capabilities.row_banks_in);
        if rows <= most {
            return Ok(());
        }
        Err(broken(Rule::Banks, Kind::RowIn, Answer::Credit { rows: most }, Answer::Credit { rows }))
    }

    /// Acknowledges the first row. The board must free this one and no other, and another row takes its bank.
    fn acknowledge_one(&mut self, kept: &mut FilledBanks) -> Result<(), End> {
        let is_pushed = kept.height == 1;
        self.run.board.disregard_rows(is_pushed.into());
        let mut came = 0;
        for _ in 0..TRIES {
            let alone = self.alone(|board| board.acknowledge_alone(kept.first + 1))?;
            came += usize::from(alone.has_surely_come());
            if is_one_acknowledged(kept, &alone.after)? {
                self.run.board.disregard_rows(0);
                self.right += 1;
                if is_pushed {
                    self.comes_again(kept, kept.banks, 1)?;
                    self.run.board.acknowledge(kept.first + kept.banks + 1);
                    self.given.rows -= 1;
                }
                return self.unneeded(kept, 0);
            }
        }
        let not_freed = counter_wrong(Some(Rule::Banks), Counter::NextRowOut, kept.first, kept.first + 1);
        Err(if came < TIMES {
            doubted(not_freed, Doubt::AnswerLost {})
        } else {
            End::failed(CheckName::Rules, not_freed)
        })
    }

    /// Acknowledges all rows that came. Those that waited must come back right.
    fn release(&mut self, kept: &mut FilledBanks) -> Result<(), End> {
        let next_row = self.run.board.acknowledged();
        self.run.board.acknowledge_to(None);
        self.run.board.acknowledge_alone(next_row);
        let made = self.small.made(0, self.height, GENERATION);
        let (from, to) = (next_row - kept.first, kept.banks + WAITING);
        let compared = Compared::default().with(&self.small, frames(kept.height, from, to - from), &made);
        self.frames(Rule::Banks, compared)
    }

    /// The board must have counted all that.
    fn kept_counted(&mut self, kept: &FilledBanks) -> Result<(), End> {
        let is_calm = kept.is_exact && self.is_calm(kept.retries)?;
        let status = self.status()?;
        let FilledBanks { before, first, asked, unneeded, .. } = kept;
        let rows = self.run.board.acknowledged() - first;
        let more = |counter: Counter, by| (counter, counter.in_status(before).saturating_add(by));
        let rule = Some(Rule::Banks);
        equal(rule, &status, &[more(Counter::RowsIn, rows), more(Counter::RowsOut, rows)])?;
        if !is_calm {
            return Ok(());
        }
        equal(
            rule,
            &status,
            &[
                more(Counter::RowsRepeated, *asked),
                more(Counter::RowsUnneeded, *unneeded),
                more(Counter::Refusals, u32::from(kept.height > 1)),
            ],
        )
    }
}

/// Whether `status` says that only the first row is acknowledged. That none is may be the link's fault; anything else is the
/// board's.
fn is_one_acknowledged(kept: &FilledBanks, status: &Status) -> Result<bool, End> {
    match status.next_row_out.wrapping_sub(kept.first) {
        0 => Ok(false),
        1 => Ok(true),
        _ => Err(miscounted(Some(Rule::Banks), Counter::NextRowOut, status.next_row_out, kept.first + 1)),
    }
}
