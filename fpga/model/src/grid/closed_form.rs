//! A grid for a lens by formula: a spline through the exact projection's values at a lattice of points.

use super::projection::ProjectedRow;
use super::rows::{RowSpline, fractions};
use super::{ENTRY_BITS, Grid, q_of_grid};
use crate::{Camera, Geometry, GridShape, RowFactor, RowValues, TableSet};

/// Added to a factor, so that dropping its last three bits rounds.
const ROUNDING: f64 = 4.0;

/// How often the offsets are corrected by the error that remains at the node nearest to the centre. Rounding is part of it.
const CORRECTIONS: usize = 3;

/// The sources as coefficients of a quadratic B-spline in both directions, column by column: (s, b) belongs to column
/// h·(s − 1/2) and row 2^v·(b − 1/2).
#[derive(Clone)]
pub(super) struct Spline {
    pub(super) shape: GridShape,
    pub(super) rows: usize,
    pub(super) coefficients: Vec<f64>,
}

impl Spline {
    /// The exact projection's quasi-interpolant, (−f[−1] + 10·f[0] − f[1])/8 in both directions.
    pub(super) fn of_camera(camera: &Camera, shape: GridShape) -> Self {
        let (columns, rows) = (shape.columns(camera.geometry()), shape.rows(camera.geometry()));
        let place = |index: usize, pitch: usize| pitch as f64 * (index as f64 - 1.5);
        let lines: Vec<Vec<f64>> = (0..rows + 2)
            .map(|row| {
                let row = ProjectedRow::new(camera, place(row, shape.row_pitch()));
                let column = |column| row.source(place(column, shape.column_pitch()));
                smoothed(&(0..columns + 2).map(column).collect::<Vec<_>>())
            })
            .collect();
        let column = |column: usize| lines.iter().map(|line| line[column]).collect::<Vec<_>>();
        let coefficients = (0..columns).flat_map(|index| smoothed(&column(index))).collect();
        Self { shape, rows, coefficients }
    }

    /// The table of this spline for `camera`, with offsets that make the node nearest to the centre exact.
    pub(super) fn table(&self, camera: &Camera) -> TableSet {
        let node = self.next_to_centre(camera.geometry());
        let column = (node * self.shape.column_pitch()) as f64;
        self.table_through(camera, node, |row| ProjectedRow::new(camera, row as f64).source(column))
    }

    /// The table of this spline for `camera`, with offsets that put the node nearest to the centre where the spline has it.
    pub(super) fn fitted_table(&self, camera: &Camera) -> TableSet {
        let node = self.next_to_centre(camera.geometry());
        let [left, right] = [node, node + 1].map(|column| &self.coefficients[column * self.rows..]);
        self.table_through(camera, node, |row| {
            let (first, weights) = fractions(self.shape, row);
            (0..3).map(|b| weights[b] * f64::midpoint(left[first + b], right[first + b])).sum()
        })
    }

    /// The table whose offsets bring `node` to the sources `wanted`, one per row.
    fn table_through(&self, camera: &Camera, node: usize, wanted: impl Fn(usize) -> f64) -> TableSet {
        let geometry = camera.geometry();
        let mut grid = Grid::of_columns(geometry, self.shape, &self.entries(geometry));
        let wanted: Vec<f64> = (0..geometry.height()).map(wanted).collect();
        correct_offsets(geometry, &mut grid, node, &wanted);
        raise_offsets(geometry, &mut grid);
        TableSet::of_grid(*geometry, grid)
    }

    /// The node nearest to the centre, among those that are columns of the frame.
    fn next_to_centre(&self, geometry: &Geometry) -> usize {
        let pitch = self.shape.column_pitch();
        let node = (geometry.centre2() as usize + pitch) / (2 * pitch);
        node.min(self.shape.segments(geometry) - 1)
    }

    fn entries(&self, geometry: &Geometry) -> Vec<u32> {
        let one = f64::from(RowFactor::ONE.get());
        let (pitch, centre) = (self.shape.column_pitch() as f64, f64::from(geometry.centre2()) / 2.0);
        let columns = || self.coefficients.chunks_exact(self.rows);
        let factor = |(left, right): (&f64, &f64)| (one * (right - left) / pitch + 0.5).floor() + ROUNDING;
        let factors = columns().zip(columns().skip(1)).flat_map(|(left, right)| left.iter().zip(right));
        let factors: Vec<f64> = factors.map(factor).collect();
        let (left, right) = self.coefficients.split_at(self.rows);
        let first = left.iter().zip(right).zip(&factors);
        let offsets = first.map(|((left, right), factor)| {
            let turned = centre * (1.0 - (factor - ROUNDING) / one);
            (one + 8192.0 * (f64::midpoint(*left, *right) - turned) + 0.5).floor()
        });
        offsets.chain(factors.iter().copied()).map(entry).collect()
    }
}

/// The value as an entry, clamped to its range.
fn entry(value: f64) -> u32 {
    (value as u32).min((1 << ENTRY_BITS) - 1)
}

/// The quasi-interpolant's coefficients for all values but the first and the last.
fn smoothed(values: &[f64]) -> Vec<f64> {
    values.windows(3).map(|three| (10.0 * three[1] - three[0] - three[2]) / 8.0).collect()
}

/// Corrects the offsets, by least squares over all rows, for the difference between the sources of `node` and `wanted`.
fn correct_offsets(geometry: &Geometry, grid: &mut Grid, node: usize, wanted: &[f64]) {
    let column = node * grid.shape.column_pitch();
    let spline = RowSpline::new(grid.shape, geometry);
    let mut values = RowValues::default();
    for _ in 0..CORRECTIONS {
        let misses = wanted.iter().enumerate().map(|(row, wanted)| {
            grid.values(geometry.centre2(), row, &mut values);
            8192.0 * (values.coordinate(column) as f64 / f64::from(1 << 28) - wanted)
        });
        let corrections = spline.fitted(misses);
        for (row, correction) in corrections.into_iter().enumerate() {
            let offset = grid.offset_mut(row);
            *offset = entry(f64::from(*offset) - (correction + 0.5).floor());
        }
    }
}

/// Raises the offsets of rows that would begin left of the frame.
fn raise_offsets(geometry: &Geometry, grid: &mut Grid) {
    let mut values = RowValues::default();
    for row in 0..geometry.height() {
        grid.values(geometry.centre2(), row, &mut values);
        let raise = -q_of_grid(values.coordinate(0));
        if raise > 0 {
            let (first, _) = super::spline(grid.shape, row);
            for row in first..first + 3 {
                let offset = grid.offset_mut(row);
                *offset = entry(f64::from(*offset) + raise as f64);
            }
        }
    }
}

impl Camera {
    /// The source of the output at column `column` of row `row` by the exact projection, which keeps rows: f(x, y) of Eqs. 5 to
    /// 7 with this lens's own r(θ), as in [`CalibratedLens::straightened`](crate::CalibratedLens::straightened).
    ///
    /// Beyond 90 degrees, where neighbouring outputs would need sources more than a column apart, it continues as a parabola.
    /// Rows beyond the poles of the image circle are like the row at the pole.
    #[must_use]
    pub fn source_column(&self, column: f64, row: f64) -> f64 {
        ProjectedRow::new(self, row).source(column)
    }

    /// The grid of shape `shape` that follows the exact projection, by formula: the quadratic spline made from its values at
    /// the middles of the grid's cells.
    #[must_use]
    pub fn grid_by_formula(&self, shape: GridShape) -> TableSet {
        Spline::of_camera(self, shape).table(self)
    }
}
