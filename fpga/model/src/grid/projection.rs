//! The exact projection from outputs to sources: f(x, y) by Eqs. 5 to 7.

use std::f64::consts::FRAC_PI_2;

use crate::{Camera, Spherical};

/// Rows nearer to a pole than this, relative to the circle's height, are treated like the row there: at the pole itself the
/// picture of a whole row is a point.
pub(crate) const POLE: f64 = 0.998;

/// Beyond 90 degrees the projection continues as a parabola through three points this far apart, relative to the circle's
/// width.
const STEP: f64 = 1.0 / 64.0;

/// The largest mean slope with which it continues, in columns a column: far out, and next to a pole, the parabola is much
/// steeper.
const STEEPEST: f64 = 1.5;

/// One row of the exact projection, in columns and rows from the optical centre.
pub(crate) struct ProjectedRow<'a> {
    camera: &'a Camera,
    y: f64,
    /// The sources of the row's first and last output that show something in front of the lens.
    sources: [f64; 2],
    /// Those outputs.
    outputs: [f64; 2],
}

impl<'a> ProjectedRow<'a> {
    /// Row `row` of `camera`'s frame, or of its continuation above and below.
    pub(crate) fn new(camera: &'a Camera, row: f64) -> Self {
        let lens = camera.lens();
        // A little further in, for a profile that ends before 90 degrees.
        let widest = FRAC_PI_2.min(lens.widest() * (1.0 - 1e-6));
        let pole = POLE * lens.lowest_row(widest);
        let y = (row - camera.centre().1).clamp(-pole, pole);
        let mut projected = Self { camera, y, sources: lens.columns_at(widest, y), outputs: [0.0; 2] };
        projected.outputs = projected.sources.map(|source| projected.output(source));
        projected
    }

    /// f: the column that the output at `column` comes from, both in the frame's columns.
    pub(crate) fn source(&self, column: f64) -> f64 {
        let centre = self.camera.centre().0;
        let output = column - centre;
        let [first, last] = self.outputs;
        centre
            + if output < first {
                self.beyond(first, output)
            } else if output > last {
                self.beyond(last, output)
            } else {
                self.inside(output)
            }
    }

    /// How many of the outputs at columns 0 to `width` − 1 show something in front of the lens.
    pub(super) fn shown(&self, width: usize) -> usize {
        (0..width).filter(|&column| self.shows(column)).count()
    }

    /// Whether the output at `column` shows something in front of the lens.
    pub(super) fn shows(&self, column: usize) -> bool {
        let [first, last] = self.outputs.map(|output| output + self.camera.centre().0);
        (first..=last).contains(&(column as f64))
    }

    /// The column where the exact projection puts the source at column `source`: where the lens images its longitude on the
    /// horizon.
    fn output(&self, source: f64) -> f64 {
        let lens = self.camera.lens();
        let longitude = lens.ray(source, self.y).map_or(0.0, |ray| Spherical::of(ray).longitude);
        lens.column(longitude.abs()).unwrap_or(0.0).copysign(longitude)
    }

    /// The source of an output between both ends, by regula falsi that halves the value at an end that stays (the Illinois
    /// method).
    fn inside(&self, output: f64) -> f64 {
        let [mut kept, mut newest] = self.sources;
        let [mut kept_miss, mut miss] = self.outputs.map(|end| end - output);
        for _ in 0..100 {
            if miss == 0.0 || (newest - kept).abs() <= 1e-12 * newest.abs().max(1.0) {
                return newest;
            }
            let next = newest - miss * (newest - kept) / (miss - kept_miss);
            let next_miss = self.output(next) - output;
            if (next_miss < 0.0) == (miss < 0.0) {
                kept_miss /= 2.0;
            } else {
                (kept, kept_miss) = (newest, miss);
            }
            (newest, miss) = (next, next_miss);
        }
        newest
    }

    /// The source of an output beyond the end `end`.
    fn beyond(&self, end: f64, output: f64) -> f64 {
        let step = STEP * end;
        let [near, middle, far] = [end, end - step, end - 2.0 * step].map(|output| self.inside(output));
        if step == 0.0 {
            return near + output - end;
        }
        let (slope, bend) = ((3.0 * near - 4.0 * middle + far) / 2.0, (near - 2.0 * middle + far) / 2.0);
        let rate = (slope + bend * (output - end) / step) / step;
        near + (output - end) * rate.clamp(0.0, STEEPEST)
    }
}
