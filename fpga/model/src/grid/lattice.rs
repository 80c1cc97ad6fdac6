//! The exact projection at a lattice of outputs, and how far tables deviate from it.

use std::f64::consts::FRAC_PI_2;

use super::projection::{POLE, ProjectedRow};
use super::residual_sum::{GridResidual, ResidualSum};
use crate::{Camera, RowValues, TableSet};

/// How far off the axis outputs count as inner, in degrees.
pub const INNER_DEGREES: f64 = 85.0;

/// Its cosine, which no constant can be computed by.
const INNER: f64 = 0.087_155_742_747_658_17;

/// The share of the circle's height within which rows count as inner.
pub const INNER_ROWS: f64 = 0.9;

/// The errors that tables leave, against the exact projection.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GridResiduals {
    /// In the whole image circle: up to 90 degrees off the axis, except the 500th part of its height next to the poles.
    pub circle: GridResidual,
    /// In its inner part: up to [`INNER_DEGREES`] off the axis and within [`INNER_ROWS`] of the circle's height.
    pub inner: GridResidual,
    /// In the rest of the circle: the rim and what is next to the poles.
    pub rim: GridResidual,
    /// The share of the frame's outputs outside the circle, 0 to 1: those that show what is beyond 90 degrees or beyond where r(θ)
    /// turns back, or a pole.
    pub beyond: f64,
}

/// Where in the picture an output lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// It shows nothing within 90 degrees of the axis, nothing within where r(θ) turns back, or a pole.
    Outside,
    /// Next to the rim or to a pole.
    Rim,
    Inner,
}

/// Outputs at the crossings of some columns and some rows.
pub(super) struct Lattice {
    pub(super) columns: Vec<usize>,
    pub(super) rows: Vec<usize>,
    /// The right source and the part of each output, row by row.
    pub(super) wanted: Vec<(f64, Part)>,
}

impl Lattice {
    /// The outputs at every `column_step`th column and every `row_step`th row of `camera`'s frame, and at the last ones.
    pub(super) fn new(camera: &Camera, column_step: usize, row_step: usize) -> Self {
        let (columns, rows) =
            (steps(camera.geometry().width(), column_step), steps(camera.geometry().height(), row_step));
        // Where the lens images 90 degrees, the source says what an output shows, also on the rim itself.
        let has_rim = camera.lens().widest() >= FRAC_PI_2;
        let wanted = rows.iter().flat_map(|&row| {
            let projected = ProjectedRow::new(camera, row as f64);
            let of = |&column: &usize| {
                let source = projected.source(column as f64);
                let is_shown = has_rim || projected.shows(column);
                (source, if is_shown { part(camera, source, row) } else { Part::Outside })
            };
            columns.iter().map(of).collect::<Vec<_>>()
        });
        Self { wanted: wanted.collect(), columns, rows }
    }

    /// The largest error of the inner part; infinite when a ring of `ring` samples, if one is given, cannot serve `tables`.
    pub(super) fn error(&self, tables: &TableSet, ring: Option<usize>) -> f64 {
        if ring.is_none_or(|ring| tables.check_ring(ring).is_ok()) {
            self.residuals(tables).inner.max
        } else {
            f64::INFINITY
        }
    }

    /// The errors that `tables` leave.
    pub(super) fn residuals(&self, tables: &TableSet) -> GridResiduals {
        let (mut inner, mut rim, mut beyond) = (ResidualSum::default(), ResidualSum::default(), 0);
        for (&row, wanted) in self.rows.iter().zip(self.wanted.chunks_exact(self.columns.len())) {
            let Some(values) = tables.values(row) else { continue };
            let columns = self.columns.iter().take_while(|&&column| column < tables.geometry().width());
            for (&column, &(wanted, part)) in columns.zip(wanted) {
                let amount = (found(&values, column) - wanted).abs();
                match part {
                    Part::Inner => inner.add(amount),
                    Part::Rim => rim.add(amount),
                    Part::Outside => beyond += 1,
                }
            }
        }
        GridResiduals {
            circle: inner.and(&rim).residual(),
            inner: inner.residual(),
            rim: rim.residual(),
            beyond: f64::from(beyond) / self.wanted.len().max(1) as f64,
        }
    }
}

/// The source of `column`, in columns.
fn found(values: &RowValues, column: usize) -> f64 {
    values.coordinate(column) as f64 / f64::from(1 << 28)
}

/// 0 to `count` − 1 in steps, and the last number.
fn steps(count: usize, step: usize) -> Vec<usize> {
    let last = Some(count - 1).filter(|last| !last.is_multiple_of(step.max(1)));
    (0..count).step_by(step.max(1)).chain(last).collect()
}

/// The part of the picture for the output that comes from column `source` of row `row`.
fn part(camera: &Camera, source: f64, row: usize) -> Part {
    let (x, y) = (source - camera.centre().0, row as f64 - camera.centre().1);
    let height = height_in_circle(camera, row);
    match camera.lens().ray(x, y) {
        Some([.., ahead]) if is_inner(ahead, height) => Part::Inner,
        Some([.., ahead]) if ahead >= 0.0 && height < POLE => Part::Rim,
        _ => Part::Outside,
    }
}

/// The distance of row `row` from the axis, relative to the height of the circle of 180 degrees.
pub(crate) fn height_in_circle(camera: &Camera, row: usize) -> f64 {
    (row as f64 - camera.centre().1).abs() / camera.hemisphere_height()
}

/// Whether a source with cos θ = `ahead`, in a row at the [`height_in_circle`] `height`, is inner.
pub(crate) fn is_inner(ahead: f64, height: f64) -> bool {
    ahead >= INNER && height <= INNER_ROWS
}

impl Camera {
    /// The errors that each of `tables` leaves against the exact projection at every `step`th column and row of the frame: how
    /// many columns away from the right place outputs are taken. The tables must be of the camera's geometry; rows and columns
    /// that they do not have do not count. Several tables take little more time than one.
    #[must_use]
    pub fn each_grid_residuals<const N: usize>(
        &self,
        tables: [&TableSet; N],
        step: usize,
    ) -> [GridResiduals; N] {
        let lattice = Lattice::new(self, step, step);
        tables.map(|tables| lattice.residuals(tables))
    }

    /// The share of the frame's outputs, 0 to 1, that show what is beyond 90 degrees off the axis or beyond where r(θ) turns back,
    /// or a pole.
    #[must_use]
    pub fn share_beyond(&self) -> f64 {
        let (width, height) = (self.geometry().width(), self.geometry().height());
        let shown = |row| {
            if height_in_circle(self, row) < POLE {
                ProjectedRow::new(self, row as f64).shown(width)
            } else {
                0
            }
        };
        1.0 - (0..height).map(shown).sum::<usize>() as f64 / (width * height) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inner_part_ends_at_its_degrees() {
        assert!((INNER - INNER_DEGREES.to_radians().cos()).abs() < 1e-15);
    }
}
