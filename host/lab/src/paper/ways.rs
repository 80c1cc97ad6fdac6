//! The ways to make tables, which are compared side by side.

use halfrow_model::{Camera, GridRoomError, TableSet};

/// A way to make tables for a lens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// The paper's formula.
    Equation9,
    /// One factor a row, with the least largest error.
    Fitted,
    /// A grid of factors for the exact projection (DATAPATH.md, *Datapath 2*).
    Exact,
}

impl Way {
    /// All of them, the paper's first.
    pub(super) const ALL: [Self; 3] = [Self::Equation9, Self::Fitted, Self::Exact];

    /// What it is called on pages.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Equation9 => "Eq. 9",
            Self::Fitted => "fitted rows",
            Self::Exact => "exact projection",
        }
    }

    /// What captions begin with.
    pub(super) fn caption(self) -> &'static str {
        match self {
            Self::Equation9 => "By Eq. 9",
            Self::Fitted => "By fitted rows",
            Self::Exact => "By a grid for the exact projection",
        }
    }

    /// What files that show it are named after.
    pub(super) fn file(self) -> &'static str {
        match self {
            Self::Equation9 => "equation-9",
            Self::Fitted => "fitted",
            Self::Exact => "exact",
        }
    }

    /// The tables for `camera`, a grid of at most `entries` entries.
    ///
    /// # Errors
    /// [`GridRoomError`] when every grid has more.
    pub(super) fn tables(self, camera: &Camera, entries: usize) -> Result<TableSet, GridRoomError> {
        match self {
            Self::Equation9 => Ok(camera.equation_9()),
            Self::Fitted => Ok(camera.fitted()),
            Self::Exact => camera.best_grid(entries),
        }
    }
}
