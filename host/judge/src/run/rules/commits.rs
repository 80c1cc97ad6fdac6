//! Commits that must be refused, and when the others take effect.

use std::mem;

use halfrow_model::GridShape;
use halfrow_protocol::message::{Commit, Entries, RefusalCode, Request, Shape, Span, Table};

use super::compared::Compared;
use super::{FIRST_FACTOR, Rules, longer, payload};
use crate::result::Rule;
use crate::run::findings::End;
use crate::tables::Generation;

/// Generations that differ in every bit.
const FIRST: u8 = 0x55;
const SECOND: u8 = 0xaa;
/// The frame with which tables are committed. Whatever bit a board loses shows in it or in its inverse.
pub(super) const FRAME: u16 = 0x5a5a;
/// The most row banks at which tables are changed.
const BANKS: u8 = 8;

impl Rules<'_, '_> {
    pub(super) fn commits(&mut self) -> Result<(), End> {
        // One row a frame.
        self.configure(1)?;
        self.upload(0)?;
        // A v without a k.
        self.commit_shapeless(Rule::Skipped, (0, FIRST), &[*GridShape::V.end() as u8])?;
        self.one_rows(Rule::CommitFrame, &[FRAME], (FIRST, 0))?;
        self.upload(1)?;
        self.wrong_sums()?;
        if self.capabilities.table_banks > 1 {
            self.pending()?;
            self.forgotten()?;
            self.at_each_bank()?;
        }
        Ok(())
    }

    /// The commit of the small tables at `place` for frames of one row.
    fn commit_of(&self, place: usize, generation: u8, first_frame: u16) -> Commit {
        let Generation { tables, kernel, .. } = self.small.made(place, 1, generation);
        Commit {
            steps_crc: crc32fast::hash(&tables.to_bytes()),
            kernel_crc: crc32fast::hash(&kernel.to_bytes()),
            first_frame,
            generation,
            shape: None,
        }
    }

    fn commit(&mut self, place: usize, generation: u8, first_frame: u16) -> Result<(), End> {
        let request = Request::Commit(self.commit_of(place, generation, first_frame));
        self.replied(Rule::Generation, &request, vec![generation])
    }

    /// Commits the small tables at `place` with a `shape` that is none, so that the bank holds row factors.
    fn commit_shapeless(
        &mut self,
        rule: Rule,
        (place, generation): (usize, u8),
        shape: &[u8],
    ) -> Result<(), End> {
        let request = Request::Commit(self.commit_of(place, generation, FRAME));
        let bytes = [&payload(&request), shape].concat();
        self.bytes_replied(rule, request.kind(), &bytes, vec![generation])
    }

    /// Frames of one row each, which must be made with the small tables at `place` as `generation`.
    fn one_rows(&mut self, rule: Rule, frames: &[u16], (generation, place): (u8, usize)) -> Result<(), End> {
        let made = self.small.made(place, 1, generation);
        let compared = Compared::default().with(&self.small, frames.iter().copied(), &made);
        self.frames(rule, compared)
    }

    /// Commits with generation 0, and with each bit of both CRCs wrong.
    fn wrong_sums(&mut self) -> Result<(), End> {
        let right = self.commit_of(1, !FIRST, FRAME);
        let unnamed = Request::Commit(Commit { generation: 0, ..right });
        self.refused(Rule::Generation, &unnamed, RefusalCode::Range, 0)?;
        for bit in 0..u32::BITS {
            let steps = Request::Commit(Commit { steps_crc: right.steps_crc ^ 1 << bit, ..right });
            self.refused(Rule::CommitCrc, &steps, RefusalCode::TableCrc, Table::RowFactors as u16)?;
            let kernel = Request::Commit(Commit { kernel_crc: right.kernel_crc ^ 1 << bit, ..right });
            self.refused(Rule::CommitCrc, &kernel, RefusalCode::TableCrc, Table::Kernel as u16)?;
        }
        if let Some(grids) = self.known_grids() {
            self.shapes(grids, right)?;
        }
        self.others_refused(FIRST)
    }

    /// With `active` tables, a commit that names them must change nothing, and one whose generation differs in a bit must
    /// count as another.
    fn others_refused(&mut self, active: u8) -> Result<(), End> {
        let wrong = Commit { steps_crc: !0, generation: active, ..self.commit_of(0, 0, FRAME) };
        self.replied(Rule::Generation, &Request::Commit(wrong), vec![active])?;
        let whole = Request::Commit(Commit { shape: Some(Shape { v: 0, k: 0 }), ..wrong });
        self.bytes_replied(Rule::Skipped, whole.kind(), &longer(&whole), vec![active])?;
        for bit in 0..u8::BITS {
            let other = Request::Commit(Commit { generation: active ^ 1 << bit, ..wrong });
            self.refused(Rule::CommitCrc, &other, RefusalCode::TableCrc, Table::RowFactors as u16)?;
        }
        Ok(())
    }

    fn pending(&mut self) -> Result<(), End> {
        self.commit_shapeless(Rule::NoGrid, (1, SECOND), &[0, u8::MAX])?;
        for generation in [FIRST, SECOND] {
            let again = Commit { generation, kernel_crc: 0, ..self.commit_of(1, 0, FRAME) };
            self.replied(Rule::Generation, &Request::Commit(again), vec![generation])?;
        }
        self.busy_with_commit(SECOND)?;
        let others: Vec<u16> = (0..u16::BITS).map(|bit| FRAME ^ 1 << bit).collect();
        self.one_rows(Rule::CommitFrame, &others, (FIRST, 0))?;
        self.one_rows(Rule::CommitFrame, &[FRAME, FRAME + 1], (SECOND, 1))?;
        self.upload(0)?;
        self.others_refused(SECOND)
    }

    /// With the commit of `generation` pending, another one and what would change its tables must be refused.
    fn busy_with_commit(&mut self, generation: u8) -> Result<(), End> {
        for bit in 0..u8::BITS {
            let another = Commit { generation: generation ^ 1 << bit, ..self.commit_of(1, 0, FRAME) };
            self.refused(Rule::Pending, &Request::Commit(another), RefusalCode::Busy, 0)?;
        }
        let span = Span { count: 0, ..FIRST_FACTOR };
        let write = Request::TableWrite(Entries { span, bytes: &[] });
        self.refused(Rule::Pending, &write, RefusalCode::Busy, 0)?;
        self.small_burst(1)
            .map_or(Ok(()), |burst| self.refused(Rule::Pending, &Request::Burst(burst), RefusalCode::Busy, 0))
    }

    /// After a RESET a commit must no longer be pending, and its tables must be where they were.
    fn forgotten(&mut self) -> Result<(), End> {
        self.commit(0, FIRST, FRAME)?;
        self.busy_with_commit(FIRST)?;
        self.drop_rows()?;
        self.one_rows(Rule::Forgotten, &[FRAME], (SECOND, 1))?;
        self.sums(Rule::Forgotten, 0)?;
        self.commit(0, FIRST, FRAME)?;
        self.one_rows(Rule::CommitFrame, &[FRAME], (FIRST, 0))?;
        // The banks have changed places.
        self.sums(Rule::CommitFrame, 1)
    }

    /// Tables that change while the row before still leaves, from each output bank in turn.
    fn at_each_bank(&mut self) -> Result<(), End> {
        let (mut active, mut next) = ((FIRST, 0), (SECOND, 1));
        for before in 0..u16::from(self.capabilities.row_banks_out.min(BANKS)) {
            let frame = if before % 2 == 0 { FRAME } else { !FRAME };
            self.upload(next.1)?;
            self.commit(next.1, next.0, frame)?;
            let old = self.small.made(active.1, 1, active.0);
            let new = self.small.made(next.1, 1, next.0);
            let compared = Compared::default().with(&self.small, 0..=before, &old);
            let compared = compared.with(&self.small, [frame, frame + 1], &new);
            self.frames(Rule::CommitFrame, compared)?;
            mem::swap(&mut active, &mut next);
        }
        Ok(())
    }
}
