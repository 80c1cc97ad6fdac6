//! The projection of Carroll, Agrawala and Agarwala, *Optimizing content-preserving projections for wide-angle images*, ACM
//! Transactions on Graphics 28 (2009). A net over the sphere is laid into the plane by sparse least squares so that shapes are
//! kept, lines stay straight, and neighbours are treated alike.

mod equations;
mod raster;

use nalgebra_sparse::factorization::CscCholesky;

use super::PaperError;
use super::lines::{Constraint, Line};
use equations::{Equations, Unknown};

pub(super) use raster::shown;

/// Degrees between two knots of the net.
const STEP: f64 = 4.0;
/// Knots on either side of the middle one, across and down: up to 80°.
const HALF: usize = 20;
/// Knots in a row or a column.
const KNOTS: usize = 2 * HALF + 1;

/// Knots from the middle to where the ends of the horizon are held: 60°.
const WIDE: usize = 15;

/// How many times lines of unknown direction are given the direction that they have so far.
const ROUNDS: usize = 5;

/// The weights of errors in shapes, in lines and between neighbours, and of what holds the middle in place.
const SHAPE: f64 = 1.0;
const STRAIGHT: f64 = 1000.0;
const SMOOTH: f64 = 0.5;
const PINNED: f64 = 1000.0;

/// A net over the sphere, laid into the plane. Its knots are every 4° of longitude and latitude, up to 80°.
#[derive(Clone, Debug)]
pub(super) struct Net {
    /// x and y of each knot in pixels, row after row from the top.
    knots: Vec<(f64, f64)>,
}

impl Net {
    /// The projection that keeps `lines`, with `scale` pixels a radian along the horizon.
    ///
    /// # Errors
    /// [`PaperError::Lines`] when the equations have no unique solution.
    pub(super) fn optimised(lines: &[Line], scale: f64) -> Result<Self, PaperError> {
        let mut net = Self::solved(lines, scale, None)?;
        for _ in 0..ROUNDS {
            net = Self::solved(lines, scale, Some(&net))?;
        }
        Ok(net)
    }

    /// One round. Lines of unknown direction are held to the direction that they have in `before`, or not at all without it.
    fn solved(lines: &[Line], scale: f64, before: Option<&Self>) -> Result<Self, PaperError> {
        let mut equations = Equations::new(2 * KNOTS * KNOTS + lines.len());
        keep_shapes(&mut equations);
        keep_smooth(&mut equations);
        pin(&mut equations, scale);
        for (number, line) in lines.iter().enumerate() {
            let normal = match line.held {
                Constraint::Upright => Some((1.0, 0.0)),
                Constraint::Level => Some((0.0, 1.0)),
                Constraint::Straight => before.map(|net| net.normal(line)),
            };
            keep_line(&mut equations, line, normal, 2 * KNOTS * KNOTS + number);
        }
        let (matrix, right) = equations.normal();
        let factors = CscCholesky::factor(&matrix).map_err(|_| PaperError::Lines)?;
        let solution = factors.solve(&right);
        let knots = (0..KNOTS * KNOTS).map(|knot| (solution[2 * knot], solution[2 * knot + 1]));
        Ok(Self { knots: knots.collect() })
    }

    /// The position at which a direction, longitude and latitude in radians, is shown, in pixels from the middle.
    #[must_use]
    pub(super) fn place(&self, longitude: f64, latitude: f64) -> (f64, f64) {
        let parts = around(longitude, latitude).map(|(knot, share)| {
            let (x, y) = self.knots[knot];
            (share * x, share * y)
        });
        parts.into_iter().fold((0.0, 0.0), |sum, part| (sum.0 + part.0, sum.1 + part.1))
    }

    /// The unit vector perpendicular to a line as it is shown.
    fn normal(&self, line: &Line) -> (f64, f64) {
        let points: Vec<_> = line.directions.iter().map(|&(across, down)| self.place(across, down)).collect();
        let count = points.len() as f64;
        let middle =
            points.iter().fold((0.0, 0.0), |sum, point| (sum.0 + point.0 / count, sum.1 + point.1 / count));
        let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
        for (x, y) in points {
            let (x, y) = (x - middle.0, y - middle.1);
            (xx, xy, yy) = (xx + x * x, xy + x * y, yy + y * y);
        }
        // The axis of the least spread is perpendicular to that of the greatest.
        let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
        (-angle.sin(), angle.cos())
    }
}

/// The index of the knot in this row and column, both from 0.
const fn knot(row: usize, column: usize) -> usize {
    row * KNOTS + column
}

/// The latitude of a row of knots, or the longitude of a column, in radians.
fn angle(place: usize) -> f64 {
    ((place as f64 - HALF as f64) * STEP).to_radians()
}

/// The four knots around a direction, each with its weight.
fn around(longitude: f64, latitude: f64) -> [(usize, f64); 4] {
    let place = |angle: f64| {
        let place = (angle.to_degrees() / STEP + HALF as f64).clamp(0.0, (KNOTS - 1) as f64);
        let before = (place as usize).min(KNOTS - 2);
        (before, place - before as f64)
    };
    let ((column, across), (row, down)) = (place(longitude), place(latitude));
    [
        (knot(row, column), (1.0 - across) * (1.0 - down)),
        (knot(row, column + 1), across * (1.0 - down)),
        (knot(row + 1, column), (1.0 - across) * down),
        (knot(row + 1, column + 1), across * down),
    ]
}

const fn x(knot: usize) -> usize {
    2 * knot
}

const fn y(knot: usize) -> usize {
    2 * knot + 1
}

/// Every small square stays a square (their Eqs. 5 and 6): the step down is the step across, turned by a right angle.
fn keep_shapes(to: &mut Equations) {
    for row in 0..KNOTS - 1 {
        let cosine = f64::midpoint(angle(row), angle(row + 1)).cos();
        for column in 0..KNOTS - 1 {
            let (here, beside, below) = (knot(row, column), knot(row, column + 1), knot(row + 1, column));
            let grown: [Unknown; 4] =
                [(y(below), cosine), (y(here), -cosine), (x(beside), -1.0), (x(here), 1.0)];
            let turned: [Unknown; 4] =
                [(x(below), cosine), (x(here), -cosine), (y(beside), 1.0), (y(here), -1.0)];
            to.add(SHAPE, &grown, 0.0);
            to.add(SHAPE, &turned, 0.0);
        }
    }
}

/// Neighbours are alike: no knot is far from the middle of its two neighbours (their Eqs. 9 to 12, in the net's own steps).
fn keep_smooth(to: &mut Equations) {
    for row in 0..KNOTS {
        let cosine = angle(row).cos();
        for column in 0..KNOTS {
            for part in [x as fn(usize) -> usize, y] {
                let mut bend = |before: usize, after: usize| {
                    let here = part(knot(row, column));
                    let three = [(part(before), cosine), (here, -2.0 * cosine), (part(after), cosine)];
                    to.add(SMOOTH, &three, 0.0);
                };
                if (1..KNOTS - 1).contains(&row) {
                    bend(knot(row - 1, column), knot(row + 1, column));
                }
                if (1..KNOTS - 1).contains(&column) {
                    bend(knot(row, column - 1), knot(row, column + 1));
                }
            }
        }
    }
}

/// The middle's column is in the middle, and the horizon is as wide as in a view whose columns are longitudes. Otherwise the net
/// would shrink, since a smaller net has smaller errors.
fn pin(to: &mut Equations, scale: f64) {
    let middle = knot(HALF, HALF);
    to.add(PINNED, &[(x(middle), 1.0)], 0.0);
    for column in [HALF - WIDE, HALF + WIDE] {
        let end = knot(HALF, column);
        to.add(PINNED, &[(x(end), 1.0)], scale * angle(column));
        to.add(PINNED, &[(y(end), 1.0)], 0.0);
    }
}

/// All points of a line have the same distance from the middle along the line's normal, which is the unknown `distance` (their
/// Eq. 3).
fn keep_line(to: &mut Equations, line: &Line, normal: Option<(f64, f64)>, distance: usize) {
    let Some((across, down)) = normal else {
        // No other equation contains this unknown.
        to.add(1.0, &[(distance, 1.0)], 0.0);
        return;
    };
    for &(longitude, latitude) in &line.directions {
        let knots = around(longitude, latitude);
        let parts =
            knots.iter().flat_map(|&(knot, share)| [(x(knot), share * across), (y(knot), share * down)]);
        let terms: Vec<Unknown> = parts.chain([(distance, -1.0)]).collect();
        to.add(STRAIGHT, &terms, 0.0);
    }
}
