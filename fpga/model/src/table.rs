//! The table set: one step a row, which is all that the datapath keeps of the lens.

use crate::projection::shrink_factor;
use crate::{Equidistant, Geometry, source};

/// The step of a row that is not stretched: 1/k = 1 in units of 2^-24.
pub const STEP_ONE: u32 = 1 << 24;

/// The rows' steps Q together with the geometry they were made for (DATAPATH.md, "Table").
///
/// A step is 1/k of Eq. 9, the distance in source columns from one output column to the next, with 24 fractional bits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TableSet {
    geometry: Geometry,
    steps: Vec<u32>,
}

/// Steps that no board could use.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TableError {
    /// Not one step a row.
    #[error("{steps} steps for {height} rows; give one step for each row")]
    Count {
        /// Steps given.
        steps: usize,
        /// Rows of the geometry.
        height: usize,
    },
    /// A step outside 1 to 2^24.
    #[error(
        "the step of row {row} is {step}, outside 1 to {max}; a step is 2^24 / k with a stretch factor k of at least 1",
        max = STEP_ONE
    )]
    Step {
        /// The row.
        row: usize,
        /// Its step.
        step: u32,
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
    /// The table of `steps`, one for each row of `geometry` from the top.
    ///
    /// # Errors
    /// [`TableError`] when there is not one step a row or one is outside 1 to [`STEP_ONE`].
    pub fn new(geometry: Geometry, steps: Vec<u32>) -> Result<Self, TableError> {
        if steps.len() != geometry.height() {
            return Err(TableError::Count { steps: steps.len(), height: geometry.height() });
        }
        match steps.iter().position(|step| !(1..=STEP_ONE).contains(step)) {
            Some(row) => Err(TableError::Step { row, step: steps[row] }),
            None => Ok(Self { geometry, steps }),
        }
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
        let step = |row| nearest_step(shrink_factor(lens.radius(), geometry.row_offset(row, centre_y)));
        Ok(Self { geometry, steps: (0..geometry.height()).map(step).collect() })
    }

    /// The table of steps that are legal and one a row by the way they were made.
    pub(crate) fn of_legal_steps(geometry: Geometry, steps: Vec<u32>) -> Self {
        Self { geometry, steps }
    }

    /// The geometry that the steps are for.
    #[must_use]
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// Q of every row from the top, each 1 to [`STEP_ONE`].
    #[must_use]
    pub fn steps(&self) -> &[u32] {
        &self.steps
    }

    /// Q of row `row`, if the frame has it.
    #[must_use]
    pub fn step(&self, row: usize) -> Option<u32> {
        self.steps.get(row).copied()
    }

    /// Whether a ring of `ring` samples holds every sample that every row reads (DATAPATH.md, "Ring").
    ///
    /// # Errors
    /// [`TableError::LookAhead`] or [`TableError::LookBack`] for the first row that breaks a condition.
    pub fn check_ring(&self, ring: usize) -> Result<(), TableError> {
        self.steps.iter().enumerate().try_for_each(|(row, &step)| self.check_row(row, step, ring))
    }

    /// Both conditions for one row. Columns minus sources never fall along a row, so its two ends decide.
    fn check_row(&self, row: usize, step: u32, ring: usize) -> Result<(), TableError> {
        let half = self.geometry.width() / 2;
        let last = self.geometry.width() - 1;
        let ahead = source(&self.geometry, step, 0).column + 4;
        if let Some(excess) = excess(ahead, half + 3) {
            return Err(TableError::LookAhead { row, excess });
        }
        let back = last as i64 - source(&self.geometry, step, last).column + half as i64 - 1;
        match excess(back + 1, ring) {
            Some(excess) => Err(TableError::LookBack { row, excess, ring }),
            None => Ok(()),
        }
    }

    /// The table as a board takes it: each step as 32 bits, little endian, from the top row.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        self.steps.iter().flat_map(|step| step.to_le_bytes()).collect()
    }
}

/// The step nearest to `shrink` = 1/k, 1 to [`STEP_ONE`].
pub(crate) fn nearest_step(shrink: f64) -> u32 {
    ((f64::from(STEP_ONE) * shrink + 0.5).floor() as u32).clamp(1, STEP_ONE)
}

/// By how much `value` is above `limit`, if it is.
fn excess(value: i64, limit: usize) -> Option<usize> {
    usize::try_from(value).ok()?.checked_sub(limit).filter(|&excess| excess > 0)
}
