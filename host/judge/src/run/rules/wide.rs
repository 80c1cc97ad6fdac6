//! Rows of the greatest width, with gaps.

use halfrow_model::Geometry;
use halfrow_protocol::message::{RefusalCode, Request, RowIn, RowPlace};
use halfrow_protocol::samples::pack;
use rand_pcg::Pcg64Mcg;

use super::compared::{Compared, Made};
use super::{Rules, of_board};
use crate::board::RowTiming;
use crate::result::Rule;
use crate::run::at_speed::drawn_factors;
use crate::run::findings::End;
use crate::run::variations::Build;

/// The generation that they are made with.
const GENERATION: u8 = 0x69;
/// Their frame.
const FRAME: u16 = 0xcba9;
/// Rows, so that one is pushed out by the next.
const ROWS: usize = 2;

impl Rules<'_, '_> {
    pub(super) fn wide(&mut self) -> Result<(), End> {
        let Some(made) = self.wide_tables() else { return Ok(()) };
        let Made { generation, tables, kernel, gap_seed } = &made;
        let board = &mut self.run.board;
        let timing = RowTiming { gap_seed: *gap_seed, ..RowTiming::default() };
        board.configure(tables.geometry(), timing).map_err(of_board)?;
        board.upload(tables, kernel).map_err(of_board)?;
        board.commit(tables, kernel, FRAME, *generation).map_err(of_board)?;
        self.narrow_row(tables.geometry().width() - 2)?;
        let compared = Compared::default().with(&self.small, FRAME, &made);
        self.frames(Rule::Wide, compared)?;
        // What follows is made with the small tables again.
        self.rows_again()
    }

    /// Tables for two rows of the greatest width; none if the board can have none.
    fn wide_tables(&self) -> Option<Made> {
        let build = Build::of(&self.capabilities);
        let width = usize::from(self.capabilities.max_width).min(build.ring) & !1;
        let rows = ROWS.min(self.capabilities.max_height.into());
        let geometry = Geometry::new(width, rows, self.small.geometry.depth(), width as u32 - 1).ok()?;
        let mut draws = Pcg64Mcg::new(u128::from(self.small.seed) | 1 << 66);
        let tables = drawn_factors(geometry, build.ring, &mut draws)?;
        let kernel = self.small.tables[1].kernel.clone();
        Some(Made { generation: GENERATION, tables, kernel, gap_seed: self.small.seed | 1 })
    }

    /// A row of another width must be refused.
    fn narrow_row(&mut self, width: usize) -> Result<(), End> {
        let row_sequence = self.run.board.acknowledged();
        let place = RowPlace { row_sequence, frame: FRAME, row: 0, width: width as u16, last: false };
        let mut packed = Vec::new();
        pack(&vec![0; width], &mut packed);
        let request = Request::RowIn(RowIn { place, packed: &packed });
        self.refused(Rule::RowPlace, &request, RefusalCode::Row, 0)
    }
}
