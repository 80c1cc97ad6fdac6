//! The table set: one row factor a row, which is all that the datapath keeps of the lens.

use crate::projection::shrink_factor;
use crate::{Equidistant, Geometry, RowFactor, RowFactorError, source};

/// The row factors together with the geometry they were made for (DATAPATH.md, "Table").
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TableSet {
    geometry: Geometry,
    row_factors: Vec<RowFactor>,
}

/// Row factors that no board could use.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TableError {
    /// Not one row factor a row.
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
    /// A vertical centre that is no finite number.
    #[error("the optical centre is at row {0}; give a finite number, or none for the middle of the frame")]
    CentreRow(f64),
    /// A row that needs samples before they have come.
    #[error(
        "row {row} needs samples {excess} columns later than half a row of delay brings them; \
         move the optical centre to the left, towards the middle, or give a larger image radius"
    )]
    LookAhead {
        /// The first such row.
        row: usize,
        /// Columns too far ahead.
        excess: usize,
    },
    /// A row that needs samples the ring has overwritten.
    #[error(
        "row {row} needs samples {excess} columns older than a ring of {ring} still holds; move the optical centre \
         to the right, towards the middle, give a larger image radius, or use a build with a longer ring"
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

impl TableSet {
    /// The table of `row_factors`, one for each row of `geometry` from the top.
    ///
    /// # Errors
    /// [`TableError::Count`] when there is not one row factor a row.
    pub fn new(geometry: Geometry, row_factors: Vec<RowFactor>) -> Result<Self, TableError> {
        if row_factors.len() != geometry.height() {
            return Err(TableError::Count { row_factors: row_factors.len(), height: geometry.height() });
        }
        Ok(Self { geometry, row_factors })
    }

    /// The table of the row factors `units` in units of 2^-24, one for each row of `geometry` from the top.
    ///
    /// # Errors
    /// [`TableError`] when there is not one row factor a row or one is outside [`RowFactor::RANGE`].
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

    /// The table with `row_factor` of every row.
    pub(crate) fn of_rows(geometry: Geometry, row_factor: impl Fn(usize) -> RowFactor) -> Self {
        Self { geometry, row_factors: (0..geometry.height()).map(row_factor).collect() }
    }

    /// The geometry that the row factors are for.
    #[must_use]
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// The row factor of every row from the top.
    #[must_use]
    pub fn row_factors(&self) -> &[RowFactor] {
        &self.row_factors
    }

    /// The row factor of row `row`, if the frame has it.
    #[must_use]
    pub fn row_factor(&self, row: usize) -> Option<RowFactor> {
        self.row_factors.get(row).copied()
    }

    /// The row factors from the top in units of 2^-24, which [`Self::from_units`] takes.
    pub fn units(&self) -> impl DoubleEndedIterator<Item = u32> + '_ {
        self.row_factors.iter().map(|row_factor| row_factor.get())
    }

    /// Whether a ring of `ring` samples holds every sample that every row reads (DATAPATH.md, "Ring").
    ///
    /// # Errors
    /// [`TableError::LookAhead`] or [`TableError::LookBack`] for the first row that breaks a condition.
    pub fn check_ring(&self, ring: usize) -> Result<(), TableError> {
        let mut rows = self.row_factors.iter().enumerate();
        rows.try_for_each(|(row, &row_factor)| self.check_row(row, row_factor, ring))
    }

    /// Both conditions for one row. Columns minus sources never fall along a row, so its two ends decide.
    fn check_row(&self, row: usize, row_factor: RowFactor, ring: usize) -> Result<(), TableError> {
        let half = self.geometry.width() / 2;
        let last = self.geometry.width() - 1;
        let ahead = source(&self.geometry, row_factor, 0).column + 4;
        if let Some(excess) = excess(ahead, half + 3) {
            return Err(TableError::LookAhead { row, excess });
        }
        let back = last as i64 - source(&self.geometry, row_factor, last).column + half as i64 - 1;
        match excess(back + 1, ring) {
            Some(excess) => Err(TableError::LookBack { row, excess, ring }),
            None => Ok(()),
        }
    }

    /// The table as a board takes it: each row factor as 32 bits, little endian, from the top row.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        self.units().flat_map(u32::to_le_bytes).collect()
    }
}

/// By how much `value` is above `limit`, if it is.
fn excess(value: i64, limit: usize) -> Option<usize> {
    usize::try_from(value).ok()?.checked_sub(limit).filter(|&excess| excess > 0)
}
