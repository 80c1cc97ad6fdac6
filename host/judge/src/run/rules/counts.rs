//! The board's counters after what changes them, and after what must not.

use std::mem;

use super::rows::{FRAME, GENERATION};
use super::without_effect::others;
use super::{Refusals, Rules, miscounted, of_rows};
use crate::board::{Given, Status};
use crate::result::{CheckName, Counter, Finding, Rule};
use crate::run::findings::{During, End};
use crate::run::frames::counters::MOVED_BY_LINKS;

/// Rows of a frame whose first row is asked for again: the second one pushes it out.
const ROWS: usize = 2;
/// How often a row is given that is no longer needed.
const UNNEEDED: u32 = 4;
/// The counters that only rows change which enter the core.
const MOVED_BY_NEW_ROWS: [Counter; 5] =
    [Counter::RowsIn, Counter::RowsOut, Counter::SamplesOver, Counter::LeastLatency, Counter::MostLatency];
/// A value with which STATUS clears, like 1.
const CLEAR: u8 = 0x80;

impl Rules<'_, '_> {
    pub(super) fn counts(&mut self) -> Result<(), End> {
        if self.height >= ROWS {
            self.thrice(Self::rows_counted)?;
        }
        self.always(Self::cleared)
    }

    /// Neither STATUS without *clear* nor RESET may clear a counter.
    pub(super) fn counts_stay(&mut self) -> Result<(), End> {
        self.always(|rules| rules.counts_on(None, |_| Ok(())))?;
        self.always(|rules| rules.counts_on(None, Self::drop_rows))
    }

    /// Rows must be counted that are asked for again or not needed, and other sessions may acknowledge none.
    fn rows_counted(&mut self) -> Result<(), End> {
        self.given = Given::default();
        self.drop_rows()?;
        self.configure(ROWS)?;
        let tables = self.small.made(0, ROWS, GENERATION).tables;
        let frame = self.small.frame(FRAME, &tables).frame;
        let before = self.status()?;
        self.give(0);
        self.give(1);
        let (first, second) = (self.place(0), self.place(1));
        let rows = [(&first, frame.row(0)), (&second, frame.row(1))];
        self.run.board.again(rows[0], Some(rows[1]), 0).map_err(|error| of_rows(Rule::Again, error))?;
        for session in others(self.run.board.session()) {
            self.run.board.acknowledge_in_session(session, second.row_sequence + 1);
        }
        let status = self.status()?;
        equal(
            Some(Rule::Session),
            &status,
            &[(Counter::NextRowIn, second.row_sequence + 1), (Counter::NextRowOut, first.row_sequence)],
        )?;
        let came =
            self.run.board.again(rows[0], Some(rows[1]), 1).map_err(|error| of_rows(Rule::Again, error))?;
        self.run.board.acknowledge(first.row_sequence + mem::take(&mut self.given).rows);
        let status = self.status()?;
        let repeated = before.rows_repeated.saturating_add(came.repeats.into());
        at_least(Some(Rule::Again), &status, &[(Counter::RowsRepeated, repeated)])?;
        for _ in 0..UNNEEDED {
            self.run.board.give(&first, frame.row(0));
        }
        let unneeded = status.rows_unneeded.saturating_add(UNNEEDED);
        let status = self.status()?;
        if self.run.board.had_each_packet_once(&status) {
            at_least(Some(Rule::Again), &status, &[(Counter::RowsUnneeded, unneeded)])?;
        }
        self.configure(self.small.rows())
    }

    /// Tries `scenario` up to three times. A count or a session that is wrong each time is not due to late copies of
    /// requests: there are not that many. Wrong rows may be, through wrong tables.
    pub(super) fn always(&mut self, scenario: fn(&mut Self) -> Result<(), End>) -> Result<(), End> {
        self.thrice(scenario).map_err(|end| match end.finding() {
            Finding::CounterWrong { .. } | Finding::RuleBroken { rule: Rule::NewSession, .. } => {
                end.beyond_links()
            }
            _ => end,
        })
    }

    /// The counters of rows may not go down through `act`.
    pub(super) fn counts_on(
        &mut self,
        rule: Option<Rule>,
        act: impl FnOnce(&mut Self) -> Result<(), End>,
    ) -> Result<(), End> {
        self.right_frames(&[FRAME])?;
        let before = self.status()?;
        act(self)?;
        let after = self.status()?;
        let counters = [Counter::RowsIn, Counter::RowsOut, Counter::SamplesOver];
        at_least(rule, &after, &counters.map(|counter| (counter, counter.in_status(&before))))
    }

    /// STATUS with any number but 0 must clear all counters, and tell what they were before. A second copy of it is told of
    /// cleared ones, but the link does not make one each time.
    fn cleared(&mut self) -> Result<(), End> {
        self.right_frames(&[FRAME])?;
        let before = self.status()?;
        let had_each_once = self.run.board.had_each_packet_once(&before);
        let retries = self.run.board.tally().retries;
        let told = self.clear()?;
        let is_calm = had_each_once && self.run.board.tally().retries == retries;
        if let Some(told) = told.filter(|_| is_calm) {
            let counters = [Counter::RowsIn, Counter::RowsOut, Counter::MostLatency];
            at_least(None, &told, &counters.map(|counter| (counter, counter.in_status(&before))))?;
        }
        let status = self.status()?;
        self.not_counted(None, &status)
    }

    /// Clears all counters, and returns what the board says that they were.
    pub(super) fn clear(&mut self) -> Result<Option<Status>, End> {
        let told = self.run.board.clear_by(CLEAR).during(CheckName::Rules)?;
        if told.is_some() {
            (self.refusals, self.before) = (Refusals::default(), Status::default());
        }
        Ok(told)
    }

    /// `status`, which came after something that clears all counters, must have all of them 0.
    pub(super) fn not_counted(&self, rule: Option<Rule>, status: &Status) -> Result<(), End> {
        // There was no new row, and no link can make one.
        equal(rule, status, &MOVED_BY_NEW_ROWS.map(|counter| (counter, 0))).map_err(End::beyond_links)?;
        let board = &self.run.board;
        let is_calm =
            status.damaged() == 0 && board.had_each_packet_once(status) && board.sent_nothing_again();
        if is_calm { equal(rule, status, &MOVED_BY_LINKS.map(|counter| (counter, 0))) } else { Ok(()) }
    }
}

/// Each counter, given with what is right, must be that in `status` after `rule` was tried. Ends with the first that is not.
pub(super) fn equal(rule: Option<Rule>, status: &Status, counts: &[(Counter, u32)]) -> Result<(), End> {
    all_right(rule, status, counts, |counted, right| counted == right)
}

/// The same for counters of which the board may count more.
pub(super) fn at_least(rule: Option<Rule>, status: &Status, counts: &[(Counter, u32)]) -> Result<(), End> {
    all_right(rule, status, counts, |counted, right| counted >= right)
}

fn all_right(
    rule: Option<Rule>,
    status: &Status,
    counts: &[(Counter, u32)],
    is_right: fn(u32, u32) -> bool,
) -> Result<(), End> {
    match counts.iter().find(|(counter, right)| !is_right(counter.in_status(status), *right)) {
        None => Ok(()),
        Some(&(counter, right)) => Err(miscounted(rule, counter, counter.in_status(status), right)),
    }
}
