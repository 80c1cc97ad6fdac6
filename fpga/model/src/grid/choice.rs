//! The best grid for a lens in the room that a board has.

use super::fit::fitted;
use super::lattice::Lattice;
use crate::{Camera, GridShape, LONGEST_RING, TableSet};

/// Columns between the outputs to which a grid is fitted.
const COLUMN_STEP: usize = 8;

/// The most rows between those outputs, and about how many rows they lie on at least.
const ROW_STEP: usize = 4;
const ROWS: usize = 128;

/// How much nearer to the right places, in columns, a grid must be to ask for a longer ring than the smallest for its width.
const WORTH_A_RING: f64 = 0.05;

/// Shapes to which a grid is fitted: those whose closed form has the least largest error.
const TRIED: usize = 2;

/// The most entries of a grid that is fitted. The time of a fit grows with the entries and with the square of the grid rows, and
/// with so many the closed form is next to exact.
const MOST_FITTED: usize = 8192;

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
        fitted(self, shape, &self.lattice(), Some(self.shortest_ring())).1
    }

    /// The grid of at most `entries` entries with the least largest error in the inner part of the picture, preferably one that
    /// the smallest ring for this width can serve: another one only if it is more than 0.05 columns nearer. If no ring can serve
    /// any, it is the one that would have the least error with a ring that could. Of the grids of more than 8192 entries only the
    /// best by closed form is considered, unfitted.
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
        let shapes: Vec<_> = all.filter(|shape| shape.entries(geometry) <= entries).collect();
        let lattice = self.lattice();
        let served_by = |ring| self.best_of(&shapes, &lattice, ring);
        let best = served_by(Some(self.shortest_ring())).map(|short| {
            if short.0 <= WORTH_A_RING {
                return short;
            }
            let long = served_by(Some(LONGEST_RING));
            let best = long.filter(|long| long.0 + WORTH_A_RING < short.0).unwrap_or(short);
            if best.0.is_finite() { best } else { served_by(None).unwrap_or(best) }
        });
        best.map(|(_, tables)| tables).ok_or_else(|| self.no_room(entries, coarsest))
    }

    /// The best grid of one of these shapes that a ring of `ring` samples, if one is given, can serve, and its largest error; none
    /// without shapes.
    fn best_of(
        &self,
        shapes: &[GridShape],
        lattice: &Lattice,
        ring: Option<usize>,
    ) -> Option<(f64, TableSet)> {
        let closed = |&shape: &GridShape| {
            let table = self.grid_by_formula(shape);
            (lattice.error(&table, ring), shape, table)
        };
        let mut closed: Vec<_> = shapes.iter().map(closed).collect();
        closed.sort_by(|one, other| one.0.total_cmp(&other.0));
        let is_large = |shape: &GridShape| shape.entries(self.geometry()) > MOST_FITTED;
        let (large, small): (Vec<_>, Vec<_>) = closed.into_iter().partition(|(_, shape, _)| is_large(shape));
        let fitted = small.into_iter().take(TRIED).map(|(_, shape, _)| fitted(self, shape, lattice, ring));
        let tried = fitted.chain(large.into_iter().take(1).map(|(error, _, table)| (error, table)));
        tried.min_by(|one, other| one.0.total_cmp(&other.0))
    }

    /// The smallest ring that frames of this width can have, in samples.
    fn shortest_ring(&self) -> usize {
        self.geometry().width().next_power_of_two()
    }

    fn no_room(&self, entries: usize, shape: GridShape) -> GridRoomError {
        let (width, height) = (self.geometry().width(), self.geometry().height());
        GridRoomError { entries, width, height, least: shape.entries(self.geometry()), shape }
    }

    fn lattice(&self) -> Lattice {
        Lattice::new(self, COLUMN_STEP, (self.geometry().height() / ROWS).clamp(1, ROW_STEP))
    }
}
