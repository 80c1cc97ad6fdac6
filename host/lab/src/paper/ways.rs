//! The ways of making tables, which are compared side by side.

use halfrow_model::{Camera, GridRoomError, TableSet};

/// A way of making tables for a lens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// The paper's formula.
    Equation9,
    /// One factor a row, whose largest error is smallest.
    Fitted,
    /// A grid of factors for the exact projection (DATAPATH.md, *Datapath 2*).
    Exact,
}

impl Way {
    /// All of them, the paper's first.
    pub(super) const ALL: [Self; 3] = [Self::Equation9, Self::Fitted, Self::Exact];

    /// Its name on pages.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Equation9 => "Eq. 9",
            Self::Fitted => "fitted rows",
            Self::Exact => "exact projection",
        }
    }

    /// The beginning of its captions.
    pub(super) fn caption(self) -> &'static str {
        match self {
            Self::Equation9 => "By Eq. 9",
            Self::Fitted => "By fitted rows",
            Self::Exact => "By a grid for the exact projection",
        }
    }

    /// The stem of the file names for it.
    pub(super) fn file(self) -> &'static str {
        match self {
            Self::Equation9 => "equation-9",
            Self::Fitted => "fitted",
            Self::Exact => "exact",
        }
    }

    /// The tables for `camera`. A grid has at most `entries` entries.
    ///
    /// # Errors
    /// [`GridRoomError`] when every grid would have more.
    pub(super) fn tables(self, camera: &Camera, entries: usize) -> Result<TableSet, GridRoomError> {
        match self {
            Self::Equation9 => Ok(camera.equation_9()),
            Self::Fitted => Ok(camera.fitted()),
            Self::Exact => camera.best_grid(entries),
        }
    }
}
