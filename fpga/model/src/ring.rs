//! Which tables suit a board's ring (DATAPATH.md, "Ring" and "Legal").

use crate::grid::q_of_grid;
use crate::table::Entries;
use crate::{RowFactor, RowValues, TableError, TableSet, source};

/// The most samples that a ring may hold: the greatest power of two in capability 07 (WIRE.md). What a board with a shorter one
/// takes is known only when it is asked.
pub const LONGEST_RING: usize = 1 << 15;

/// n of a row's first and last column. j − n never falls along a row, so these two decide.
type Ends = [i64; 2];

impl TableSet {
    /// Checks that a ring of `ring` samples holds every sample that every row reads, and that every source of a grid lies in
    /// its row (DATAPATH.md, "Ring" and "Legal").
    ///
    /// # Errors
    /// [`TableError::BeforeFirst`], [`TableError::AfterLast`], [`TableError::LookAhead`] or [`TableError::LookBack`] for
    /// the first row that breaks a condition.
    pub fn check_ring(&self, ring: usize) -> Result<(), TableError> {
        match self.stored() {
            Entries::Rows(row_factors) => {
                let mut rows = row_factors.iter().enumerate();
                rows.try_for_each(|(row, &row_factor)| self.check_row(row, self.ends(row_factor), ring))
            }
            Entries::Grid(grid) => {
                let mut values = RowValues::default();
                (0..self.geometry().height()).try_for_each(|row| {
                    grid.values(self.geometry().centre2(), row, &mut values);
                    self.check_row(row, self.ends_of_values(row, &values)?, ring)
                })
            }
        }
    }

    fn ends(&self, row_factor: RowFactor) -> Ends {
        let geometry = self.geometry();
        [0, geometry.width() - 1].map(|column| source(geometry, row_factor, column).column)
    }

    /// The ends of row `row` of a grid, if both lie in the row.
    fn ends_of_values(&self, row: usize, values: &RowValues) -> Result<Ends, TableError> {
        let last = self.geometry().width() - 1;
        let [first, end] = [0, last].map(|column| q_of_grid(values.coordinate(column)));
        if first < 0 {
            // O is in units of q.
            return Err(TableError::BeforeFirst { row, raise: -first });
        }
        match excess(end >> 13, last) {
            Some(excess) => Err(TableError::AfterLast { row, excess }),
            None => Ok([first >> 13, end >> 13]),
        }
    }

    /// Checks both of the ring's conditions for one row.
    fn check_row(&self, row: usize, ends: Ends, ring: usize) -> Result<(), TableError> {
        let (half, last) = (self.geometry().width() / 2, self.geometry().width() - 1);
        let [first, end] = ends;
        if let Some(excess) = excess(first + 4, half + 3) {
            return Err(TableError::LookAhead { row, excess });
        }
        let back = last as i64 - end + half as i64 - 1;
        match excess(back + 1, ring) {
            Some(excess) => Err(TableError::LookBack { row, excess, ring }),
            None => Ok(()),
        }
    }
}

/// How far `value` is above `limit`, if it is.
fn excess(value: i64, limit: usize) -> Option<usize> {
    usize::try_from(value).ok()?.checked_sub(limit).filter(|&excess| excess > 0)
}
