//! The best grid for a lens in the room that a board has.

use super::fit::fitted;
use super::lattice::Lattice;
use crate::{Camera, GridShape, TableSet};

/// Columns between the outputs to which a grid is fitted.
const COLUMN_STEP: usize = 8;

/// The most rows between those outputs, and about how many rows they lie on at least.
const ROW_STEP: usize = 4;
const ROWS: usize = 128;

/// Shapes to which a grid is fitted: those whose closed form has the least largest error.
const TRIED: usize = 2;

/// The board has too few entries for any grid that suits these frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "no grid for frames of {width} x {height} has {entries} entries or fewer; take a board of at least {least}, which \
     the shape {shape} needs, or smaller frames"
)]
pub struct GridRoomError {
    /// Entries of a bank.
    pub entries: usize,
    /// Columns of a frame.
    pub width: usize,
    /// Rows of a frame.
    pub height: usize,
    /// Entries of the smallest grid.
    pub least: usize,
    /// Its shape.
    pub shape: GridShape,
}

impl Camera {
    /// The grid of shape `shape` whose largest error in the inner part of the picture is about as small as possible; the rest
    /// of the image circle follows by least squares.
    ///
    /// The fit starts from [`Self::grid_by_formula`] and its largest error is never above that grid's. The same lens always
    /// gives the same grid.
    #[must_use]
    pub fn fitted_grid(&self, shape: GridShape) -> TableSet {
        fitted(self, shape, &self.lattice())
    }

    /// The grid of at most `entries` entries with the least largest error in the inner part of the picture, preferably one that
    /// the smallest ring for this width can serve.
    ///
    /// # Errors
    /// [`GridRoomError`] when every grid has more entries.
    pub fn best_grid(&self, entries: usize) -> Result<TableSet, GridRoomError> {
        self.best_grid_of(GridShape::all(), entries)
    }

    /// The same for a board that takes only grids with a node every 2^`k` columns.
    ///
    /// # Errors
    /// [`GridRoomError`] when every such grid has more entries.
    pub fn best_grid_with_k(&self, k: u32, entries: usize) -> Result<TableSet, GridRoomError> {
        self.best_grid_of(GridShape::all().filter(move |shape| shape.k() == k), entries)
    }

    /// The best grid of one of these shapes, of which the first is the coarsest.
    fn best_grid_of(
        &self,
        all: impl Iterator<Item = GridShape> + Clone,
        entries: usize,
    ) -> Result<TableSet, GridRoomError> {
        let geometry = self.geometry();
        let coarsest = all.clone().next().unwrap_or(GridShape::COARSEST);
        let fits = |shape: &GridShape| shape.entries(geometry) <= entries;
        let lattice = self.lattice();
        let error = |tables: &TableSet| lattice.error(tables);
        let mut shapes: Vec<_> =
            all.filter(fits).map(|shape| (error(&self.grid_by_formula(shape)), shape)).collect();
        shapes.sort_by(|one, other| one.0.total_cmp(&other.0));
        let tried = shapes.into_iter().take(TRIED).map(|(_, shape)| fitted(self, shape, &lattice));
        let best = tried.min_by(|one, other| error(one).total_cmp(&error(other)));
        best.ok_or_else(|| self.no_room(entries, coarsest))
    }

    fn no_room(&self, entries: usize, shape: GridShape) -> GridRoomError {
        let (width, height) = (self.geometry().width(), self.geometry().height());
        GridRoomError { entries, width, height, least: shape.entries(self.geometry()), shape }
    }

    fn lattice(&self) -> Lattice {
        Lattice::new(self, COLUMN_STEP, (self.geometry().height() / ROWS).clamp(1, ROW_STEP))
    }
}
