//! The table set: row factors or a grid of factors. This is all that the datapath keeps of the lens.

use std::fmt;
use std::ops::RangeInclusive;

use crate::grid::{ENTRY_BITS, Grid, GridFault};
use crate::projection::shrink_factor;
use crate::{
    BitDepth, Equidistant, Geometry, GeometryError, GridShape, RowFactor, RowFactorError, RowValues,
};

/// One row factor per row, or a grid, with the geometry that they were made for (DATAPATH.md, "Table" and "Grid").
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TableSet {
    geometry: Geometry,
    entries: Entries,
}

/// What a bank of tables holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Entries {
    /// Datapath 1: the row factor of every row.
    Rows(Vec<RowFactor>),
    /// Datapath 2.
    Grid(Grid),
}

/// Tables that no board could use.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TableError {
    /// Not exactly one row factor per row.
    #[error("{row_factors} row factors for {height} rows; give one for each row")]
    Count {
        /// Row factors given.
        row_factors: usize,
        /// Rows of the geometry.
        height: usize,
    },
    /// A row's entry that is no row factor.
    #[error("the entry of row {row} cannot be used")]
    RowFactor {
        /// The row.
        row: usize,
        /// What is wrong with its entry.
        source: RowFactorError,
    },
    /// Not as many entries as the grid has.
    #[error(
        "{entries} entries for a grid of {columns} columns and {rows} grid rows; give {}, column by column",
        .columns * .rows
    )]
    GridCount {
        /// Entries given.
        entries: usize,
        /// N + 2.
        columns: usize,
        /// Z.
        rows: usize,
    },
    /// An entry with more bits than a board keeps.
    #[error("entry ({column}, {row}) of the grid is {units}; give 0 to {max}", max = TableSet::GRID_RANGE.end())]
    GridEntry {
        /// c: 0 for offsets, 1 + s for node s.
        column: usize,
        /// b.
        row: usize,
        /// The entry.
        units: u32,
    },
    /// A row that begins left of the frame.
    #[error(
        "row {row} begins left of the frame; raise the offsets of its grid rows by {raise}, or make the grid from the \
         lens again"
    )]
    BeforeFirst {
        /// The first such row.
        row: usize,
        /// How much must be added to O, at least.
        raise: i64,
    },
    /// A row that ends right of the frame.
    #[error(
        "row {row} ends {} right of the frame; lower the offsets of its grid rows, or make the grid from \
         the lens again",
        Columns(*.excess)
    )]
    AfterLast {
        /// The first such row.
        row: usize,
        /// Columns too far right.
        excess: usize,
    },
    /// A vertical centre that is no finite number.
    #[error("the optical centre is at row {0}; give a finite number, or none for the middle of the frame")]
    CentreRow(f64),
    /// A row that needs samples before they have arrived.
    #[error(
        "row {row} needs samples {} later than half a row of delay brings them; \
         move the optical centre to the left, towards the middle, or give a larger image radius",
        Columns(*.excess)
    )]
    LookAhead {
        /// The first such row.
        row: usize,
        /// Columns too far ahead.
        excess: usize,
    },
    /// A row that needs samples that the ring has already overwritten.
    #[error(
        "row {row} needs samples {} older than a ring of {ring} still holds; move the optical centre \
         to the right, towards the middle, give a larger image radius, or use a build with a longer ring",
        Columns(*.excess)
    )]
    LookBack {
        /// The first such row.
        row: usize,
        /// Columns too far back.
        excess: usize,
        /// Samples in the ring.
        ring: usize,
    },
}

/// A count of columns in a message.
struct Columns(usize);

impl fmt::Display for Columns {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} column{}", self.0, if self.0 == 1 { "" } else { "s" })
    }
}

impl TableSet {
    /// The range of a grid's entries.
    pub const GRID_RANGE: RangeInclusive<u32> = 0..=(1 << ENTRY_BITS) - 1;

    /// The table of `row_factors`, one for each row of `geometry` from the top.
    ///
    /// # Errors
    /// [`TableError::Count`] when there is not exactly one row factor per row.
    pub fn new(geometry: Geometry, row_factors: Vec<RowFactor>) -> Result<Self, TableError> {
        if row_factors.len() != geometry.height() {
            return Err(TableError::Count { row_factors: row_factors.len(), height: geometry.height() });
        }
        Ok(Self { geometry, entries: Entries::Rows(row_factors) })
    }

    /// The grid of shape `shape` with these entries, in a board's order: column by column from the offsets, each column from
    /// its first grid row.
    ///
    /// # Errors
    /// [`TableError`] when there are not (N + 2)·Z entries or one is outside [`Self::GRID_RANGE`].
    pub fn from_grid(geometry: Geometry, shape: GridShape, entries: &[u32]) -> Result<Self, TableError> {
        let (columns, rows) = (shape.columns(&geometry), shape.rows(&geometry));
        let grid = Grid::new(&geometry, shape, entries).map_err(|fault| match fault {
            GridFault::Count(entries) => TableError::GridCount { entries, columns, rows },
            GridFault::Entry { place, units } => {
                TableError::GridEntry { column: place / rows, row: place % rows, units }
            }
        })?;
        Ok(Self { geometry, entries: Entries::Grid(grid) })
    }

    /// The table of the row factors `units`, in units of 2^-24, one for each row of `geometry` from the top.
    ///
    /// # Errors
    /// [`TableError`] when there is not exactly one row factor per row, or one is outside [`RowFactor::RANGE`].
    pub fn from_units(geometry: Geometry, units: &[u32]) -> Result<Self, TableError> {
        let row_factor = |(row, &units): (usize, &u32)| {
            RowFactor::new(units).map_err(|source| TableError::RowFactor { row, source })
        };
        let row_factors: Result<_, _> = units.iter().enumerate().map(row_factor).collect();
        Self::new(geometry, row_factors?)
    }

    /// The table of `lens` with its axis at row `centre_y`, by default the frame's middle (H − 1)/2.
    ///
    /// Q = max(1, floor(2^24 · sqrt(R² − y²)/R + ½)) in double precision; a row outside the image circle is not
    /// stretched (Eqs. 8, 9). R is the lens's [`Equidistant::radius`].
    ///
    /// # Errors
    /// [`TableError::CentreRow`] when `centre_y` is not finite.
    pub fn from_lens(
        geometry: Geometry,
        lens: &Equidistant,
        centre_y: Option<f64>,
    ) -> Result<Self, TableError> {
        if let Some(centre_y) = centre_y.filter(|centre_y| !centre_y.is_finite()) {
            return Err(TableError::CentreRow(centre_y));
        }
        let shrink = |row| shrink_factor(lens.radius(), geometry.row_offset(row, centre_y));
        Ok(Self::of_rows(geometry, |row| RowFactor::nearest(shrink(row))))
    }

    /// The table with `row_factor(row)` for every row.
    pub(crate) fn of_rows(geometry: Geometry, row_factor: impl Fn(usize) -> RowFactor) -> Self {
        let row_factors = (0..geometry.height()).map(row_factor).collect();
        Self { geometry, entries: Entries::Rows(row_factors) }
    }

    /// The table of a grid made for `geometry`.
    pub(crate) fn of_grid(geometry: Geometry, grid: Grid) -> Self {
        Self { geometry, entries: Entries::Grid(grid) }
    }

    /// The same entries for frames of the same size with samples of `depth` and the optical centre at column `centre2` / 2.
    ///
    /// # Errors
    /// [`GeometryError::Centre`] when `centre2` is above 2W − 2.
    pub fn with_settings(&self, depth: BitDepth, centre2: u32) -> Result<Self, GeometryError> {
        let geometry = Geometry::new(self.geometry.width(), self.geometry.height(), depth, centre2)?;
        Ok(Self { geometry, entries: self.entries.clone() })
    }

    /// The tables of the upper `rows` rows alone; none when the frame has fewer rows, or `rows` is 0.
    #[must_use]
    pub fn upper(&self, rows: usize) -> Option<Self> {
        let own = &self.geometry;
        let rows = Some(rows).filter(|&rows| rows <= own.height())?;
        let geometry = Geometry::new(own.width(), rows, own.depth(), own.centre2()).ok()?;
        let entries = match &self.entries {
            Entries::Rows(row_factors) => Entries::Rows(row_factors.get(..rows)?.to_vec()),
            Entries::Grid(grid) => Entries::Grid(grid.upper(&geometry)?),
        };
        Some(Self { geometry, entries })
    }

    /// The tables that stretch half as much: every entry half way to 2^24, rounded down.
    #[must_use]
    pub fn halved(&self) -> Self {
        let entries = match &self.entries {
            Entries::Rows(row_factors) => {
                Entries::Rows(row_factors.iter().map(|own| own.midpoint(RowFactor::ONE)).collect())
            }
            Entries::Grid(grid) => Entries::Grid(grid.halved()),
        };
        Self { geometry: self.geometry, entries }
    }

    /// The geometry that the tables are for.
    #[must_use]
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    pub(crate) fn stored(&self) -> &Entries {
        &self.entries
    }

    /// The shape of a grid; none for row factors.
    #[must_use]
    pub fn shape(&self) -> Option<GridShape> {
        match &self.entries {
            Entries::Rows(_) => None,
            Entries::Grid(grid) => Some(grid.shape()),
        }
    }

    /// The row factor of every row from the top; none for a grid, whose factors depend on the column.
    #[must_use]
    pub fn row_factors(&self) -> Option<&[RowFactor]> {
        match &self.entries {
            Entries::Rows(row_factors) => Some(row_factors),
            Entries::Grid(_) => None,
        }
    }

    /// The row factor of row `row`, if the tables are row factors and the frame has this row.
    #[must_use]
    pub fn row_factor(&self, row: usize) -> Option<RowFactor> {
        self.row_factors()?.get(row).copied()
    }

    /// The values of row `row`, if the frame has this row.
    #[must_use]
    pub fn values(&self, row: usize) -> Option<RowValues> {
        self.values_about(self.geometry.centre2(), row)
    }

    /// The same about the column `centre2` / 2, of whatever optical centre a board has. It may lie beyond the row.
    #[must_use]
    pub fn values_about(&self, centre2: u32, row: usize) -> Option<RowValues> {
        let mut values = RowValues::default();
        match &self.entries {
            Entries::Rows(row_factors) => {
                values.take_factor(&self.geometry, centre2, *row_factors.get(row)?);
            }
            Entries::Grid(grid) if row < self.geometry.height() => grid.values(centre2, row, &mut values),
            Entries::Grid(_) => return None,
        }
        Some(values)
    }

    /// The entries in a board's order, in units of 2^-24: row factors from the top, as [`Self::from_units`] takes them, or
    /// those of a grid, as [`Self::from_grid`] takes them.
    pub fn entries(&self) -> impl DoubleEndedIterator<Item = u32> + ExactSizeIterator + '_ {
        let count = match &self.entries {
            Entries::Rows(row_factors) => row_factors.len(),
            Entries::Grid(grid) => grid.len(),
        };
        (0..count).map(|place| match &self.entries {
            Entries::Rows(row_factors) => row_factors[place].get(),
            Entries::Grid(grid) => grid.entry(place),
        })
    }

    /// The tables in a board's format: each entry as 32 bits, little endian, in a board's order.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        self.entries().flat_map(u32::to_le_bytes).collect()
    }
}
