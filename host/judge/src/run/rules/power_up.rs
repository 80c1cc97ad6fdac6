//! A board that has forgotten everything: it is not ready for rows, and its tables are as they are at power-up.

use halfrow_model::{NODES, RowFactor};
use halfrow_protocol::message::{Bank, Commit, NODE_BYTES, RefusalCode, Request, RowPlace, Table};

use super::Rules;
use super::commits::FRAME;
use crate::result::Rule;
use crate::run::findings::End;

/// The generation of tables that no frame uses.
const GENERATION: u8 = 0xff;

impl Rules<'_, '_> {
    pub(super) fn power_up(&mut self) -> Result<(), End> {
        self.forget()?;
        // With a configuration it would be out of range, which comes second.
        let commit = Commit { steps_crc: 0, kernel_crc: 0, first_frame: 0, generation: 0, shape: None };
        self.not_ready(&Request::Commit(commit))?;
        self.not_ready_for_rows()?;
        self.configure(self.small.rows())?;
        self.not_ready_for_rows()?;
        for bank in [Bank::Shadow, Bank::Active] {
            self.sums_of(Rule::PowerUp, bank, &row_factors(self.capabilities.max_height), &nodes())?;
        }
        self.tallest()
    }

    /// The tables of frames one row less than the tallest must be committed whole. Of that height usually most bits are set.
    fn tallest(&mut self) -> Result<(), End> {
        let rows = self.capabilities.max_height.saturating_sub(1).max(1);
        self.configure(rows.into())?;
        let steps_crc = crc32fast::hash(&row_factors(rows));
        let kernel_crc = crc32fast::hash(&nodes());
        let right = Commit { steps_crc, kernel_crc, first_frame: 0, generation: GENERATION, shape: None };
        let other = Commit { steps_crc: crc32fast::hash(&row_factors(rows - 1)), ..right };
        self.refused(
            Rule::CommitCrc,
            &Request::Commit(other),
            RefusalCode::TableCrc,
            Table::RowFactors as u16,
        )?;
        for first_frame in [FRAME, !FRAME] {
            self.waited_for(Commit { first_frame, ..right })?;
        }
        Ok(())
    }

    /// Until the frame of `commit` there are no tables, unless the board has one bank of them.
    fn waited_for(&mut self, commit: Commit) -> Result<(), End> {
        self.replied(Rule::Generation, &Request::Commit(commit), vec![commit.generation])?;
        if self.capabilities.table_banks > 1 {
            self.pending = Some(commit.first_frame);
            for frame in (0..u16::BITS).map(|bit| commit.first_frame ^ 1 << bit) {
                let place = RowPlace { frame, ..self.place(0) };
                self.row_refused(Rule::NotReady, place, RefusalCode::NotReady)?;
            }
            self.pending = None;
        }
        // So that another commit may wait.
        self.drop_rows()
    }

    fn not_ready(&mut self, request: &Request<'_>) -> Result<(), End> {
        self.refused(Rule::NotReady, request, RefusalCode::NotReady, 0)
    }

    fn not_ready_for_rows(&mut self) -> Result<(), End> {
        let place = RowPlace { frame: 0, ..self.place(0) };
        self.row_refused(Rule::NotReady, place, RefusalCode::NotReady)?;
        // Credit is looked at before that.
        let beyond = RowPlace { row_sequence: self.run.board.credit(), ..place };
        self.row_refused(Rule::Credit, beyond, RefusalCode::Credit)?;
        self.small_burst(1).map_or(Ok(()), |burst| self.not_ready(&Request::Burst(burst)))
    }
}

/// `rows` row factors, as they are at power-up.
fn row_factors(rows: u16) -> Vec<u8> {
    RowFactor::ONE.get().to_le_bytes().repeat(rows.into())
}

/// All nodes, as they are at power-up.
fn nodes() -> Vec<u8> {
    vec![0; NODES * NODE_BYTES]
}
