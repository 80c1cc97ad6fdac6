//! Grids that must be refused, on a board that takes grids.

use std::collections::BTreeSet;

use halfrow_model::{Geometry, GridShape, TableSet};
use halfrow_protocol::message::{Commit, Entries, Grids, RefusalCode, Request, Shape, Span, Table};

use super::tables::PLACE;
use super::{FIRST_FACTOR, Rules};
use crate::board::{RowTiming, grids};
use crate::result::Rule;
use crate::run::findings::End;
use crate::run::plan::parts::of_height;

/// The numbers of COMMIT's fields (WIRE.md, 13).
const V: u16 = 1;
const K: u16 = 2;

impl Rules<'_, '_> {
    pub(super) fn known_grids(&self) -> Option<Grids> {
        grids(&self.capabilities)
    }

    /// Grid entries with a bit too many, after a right one and before it.
    pub(super) fn grid_entries(&mut self) -> Result<(), End> {
        // Of a board of one row only entry 0 is looked at afterwards.
        let first = PLACE.min(self.capabilities.max_height - 1);
        let most = *TableSet::GRID_RANGE.end();
        for wrong in (0..u32::BITS).map(|bit| 1_u32 << bit).filter(|&wrong| wrong > most) {
            for (place, entries) in [(1, [most, wrong]), (0, [wrong, most])] {
                let bytes = entries.map(u32::to_le_bytes).concat();
                let span = Span { table: Table::Grid, first, count: 2, ..FIRST_FACTOR };
                let request = Request::TableWrite(Entries { span, bytes: &bytes });
                self.refused(Rule::Entry, &request, RefusalCode::Range, first + place)?;
            }
        }
        Ok(())
    }

    /// `right`, which is not committed yet, with each shape that a grid cannot have, with a shape of more entries than a
    /// bank holds, and as a grid that reads back otherwise.
    pub(super) fn shapes(&mut self, grids: Grids, right: Commit) -> Result<(), End> {
        let of = |v, k| Commit { shape: Some(Shape { v, k }), ..right };
        let known = (0..u8::BITS as u8).find(|&k| grids.takes(k)).unwrap_or_default();
        let others = (0..u8::BITS).map(|bit| 1 << bit).chain([0, 4, 7]).filter(|&k| !grids.takes(k));
        let columns = others.map(|k| (K, of(1, k)));
        let greatest = *GridShape::V.end() as u8;
        let rows = (0..u8::BITS).map(|bit| greatest | 1 << bit).filter(|&v| v > greatest);
        let wrong: Vec<_> = rows.map(|v| (V, of(v, known))).chain(columns).collect();
        for (field, commit) in wrong {
            self.refused(Rule::Shape, &Request::Commit(commit), RefusalCode::Range, field)?;
        }
        self.refused(Rule::Shape, &Request::Commit(of(1, known)), RefusalCode::TableCrc, Table::Grid as u16)?;
        self.kernel_of_grid(of(1, known))?;
        self.most_entries(grids, of(1, known))
    }

    /// `finest` with the CRC of a grid that reads back right and of a kernel that does not. The grid's entries are the
    /// row factors that the bank holds.
    fn kernel_of_grid(&mut self, finest: Commit) -> Result<(), End> {
        let geometry = of_height(&self.small.geometry, self.height);
        let entries = shape_of(finest).map(|shape| shape.entries(&geometry));
        let there = self.small.tables[1].tables.to_bytes();
        let grid = entries.and_then(|entries| there.get(..entries * Table::Grid.entry_bytes()));
        let Some(grid) = grid else { return Ok(()) };
        let other = Commit { steps_crc: crc32fast::hash(grid), kernel_crc: !finest.kernel_crc, ..finest };
        self.refused(Rule::Shape, &Request::Commit(other), RefusalCode::TableCrc, Table::Kernel as u16)
    }

    /// The grid of `finest`, which reads back otherwise, in the narrowest and the widest frames: for the most rows for which a bank has
    /// the entries, and for more.
    fn most_entries(&mut self, grids: Grids, finest: Commit) -> Result<(), End> {
        let Some(shape) = shape_of(finest) else { return Ok(()) };
        let (height, depth) = (self.height, self.small.geometry.depth());
        let most = usize::from(self.capabilities.max_height);
        for width in BTreeSet::from([self.width, usize::from(self.capabilities.max_width) & !1]) {
            let of_rows = |rows| Geometry::new(width, rows, depth, width as u32 - 1).ok();
            let is_held = |rows: &usize| {
                of_rows(*rows).is_some_and(|geometry| shape.entries(&geometry) <= grids.entries.into())
            };
            let tallest = (1..=most).rev().find(is_held).unwrap_or(0);
            for rows in BTreeSet::from([tallest.max(1), (tallest + 1).min(most), most]) {
                let Some(geometry) = of_rows(rows) else { continue };
                self.set(&geometry, RowTiming::default())?;
                let (code, detail) = if rows <= tallest {
                    (RefusalCode::TableCrc, Table::Grid as u16)
                } else {
                    (RefusalCode::Range, K)
                };
                self.refused(Rule::Shape, &Request::Commit(finest), code, detail)?;
            }
        }
        self.configure(height)
    }
}

/// The grid that `commit` names.
fn shape_of(commit: Commit) -> Option<GridShape> {
    let Shape { v, k } = commit.shape?;
    GridShape::new(v.into(), k.into()).ok()
}
