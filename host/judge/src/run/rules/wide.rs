//! Rows of the greatest width, with gaps.

use halfrow_model::{BitDepth, Geometry};
use halfrow_protocol::message::{RefusalCode, RowPlace};
use rand_pcg::Pcg64Mcg;

use super::Rules;
use super::compared::Compared;
use crate::board::{Capabilities, RowTiming};
use crate::result::{CheckName, Rule};
use crate::run::drawn::drawn_factors;
use crate::run::findings::{During, End};
use crate::tables::Generation;

/// The generation with which they are made.
const GENERATION: u8 = 0x69;
/// Their frame.
const FRAME: u16 = 0xcba9;
/// Two rows, so that the second pushes the first out.
pub(super) const ROWS: usize = 2;

/// Two rows of the greatest width; none if no board can have such.
pub(super) fn geometry(capabilities: &Capabilities, depth: BitDepth) -> Option<Geometry> {
    let width = capabilities.max_width.min(capabilities.ring) & !1;
    let rows = ROWS.min(capabilities.max_height.into());
    Geometry::new(width.into(), rows, depth, u32::from(width).checked_sub(1)?).ok()
}

impl Rules<'_, '_> {
    pub(super) fn wide(&mut self) -> Result<(), End> {
        let Some(made) = self.wide_tables() else { return Ok(()) };
        let Generation { number, tables, kernel } = &made;
        // The inverse of the seed of streamed frames' gaps.
        let gap_seed = !self.small.seed | 1;
        self.set(tables.geometry(), RowTiming { gap_seed, ..RowTiming::default() })?;
        let board = &mut self.run.board;
        board.upload(tables, kernel).during(CheckName::Rules)?;
        board.commit(tables, kernel, FRAME, *number).during(CheckName::Rules)?;
        let narrow = tables.geometry().width() as u16 - 2;
        let place = RowPlace { frame: FRAME, width: narrow, last: false, ..self.place(0) };
        self.row_refused(Rule::RowPlace, place, RefusalCode::Row)?;
        let compared = Compared::with_gaps(gap_seed).with(&self.small, [FRAME], &made);
        self.frames(Rule::Wide, compared)?;
        self.last_row_trapped(&made)?;
        // What follows needs the small tables again.
        self.rows_again()
    }

    /// Tables for two rows of the greatest width; none if the board can take none.
    fn wide_tables(&self) -> Option<Generation> {
        let geometry = geometry(&self.capabilities, self.small.geometry.depth())?;
        let mut draws = Pcg64Mcg::new(u128::from(self.small.seed) | 1 << 66);
        let tables = drawn_factors(geometry, self.capabilities.ring.into(), &mut draws)?;
        let kernel = self.small.tables[1].kernel.clone();
        Some(Generation { number: GENERATION, tables, kernel })
    }
}
