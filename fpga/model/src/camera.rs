//! A lens in front of a frame: its row factors, by Eq. 9 or fitted, and the error that they leave.

use std::f64::consts::FRAC_PI_2;

use crate::grid::{height_in_circle, is_inner};
use crate::lens::{Short, is_positive};
use crate::projection::{is_outside, shrink_factor};
use crate::{
    CalibratedLens, Geometry, GeometryError, LensError, MAX_RADIUS, MIN_RADIUS, RowFactor, TableSet,
};

/// A frame and the lens that it is seen through.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    geometry: Geometry,
    lens: CalibratedLens,
    centre: (f64, f64),
    half_field: f64,
}

/// The lens cannot be used with frames of this size.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CameraError {
    /// The figures describe no lens, or one that does not fit this frame.
    #[error(transparent)]
    Lens(#[from] LensError),
    /// The optical centre is outside the frame.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// The row of the optical centre is no finite number, or farther from the frame than any lens reaches.
    #[error(
        "the optical centre is at row {}, beyond {max:e}; give the row of the lens's axis, counted from 0",
        Short(*.0),
        max = MAX_RADIUS
    )]
    CentreRow(f64),
}

/// A sample of the fisheye frame, and where the exact projection puts it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// The sample's column.
    pub column: usize,
    /// The column of the corrected frame where it belongs, 0 to W − 1.
    pub right_column: f64,
    /// The row where it would belong if samples could change their row.
    pub right_row: f64,
    /// Whether it is inner: up to 85 degrees off the axis, and within 0.9 of the height of the circle of 180 degrees.
    pub is_inner: bool,
}

/// How far a sample is from where it belongs, in pixels of the corrected frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual {
    /// Columns to the right of where it belongs: what a row factor changes.
    pub columns: f64,
    /// Rows below where it belongs: what Eq. 7 leaves, whatever the row factor.
    pub rows: f64,
}

impl Camera {
    /// The lens `lens` with its axis at column and row `centre` of the frame; C of `geometry` becomes round(2 · column).
    ///
    /// `field_of_view_deg` is the angle across what counts as the image circle, in degrees: 180 is the hemisphere of the paper.
    ///
    /// # Errors
    /// [`CameraError`] when the centre's column is outside the frame or its row beyond [`MAX_RADIUS`], the field of view is not
    /// above 0° and at most 360°, R is outside [`MIN_RADIUS`] to [`MAX_RADIUS`], or r(θ) turns back inside both the circle and
    /// the frame.
    pub fn new(
        geometry: Geometry,
        lens: CalibratedLens,
        centre: (f64, f64),
        field_of_view_deg: f64,
    ) -> Result<Self, CameraError> {
        if !is_positive(field_of_view_deg) || field_of_view_deg > 360.0 {
            return Err(LensError::FieldOfView(field_of_view_deg).into());
        }
        if !(-MAX_RADIUS..=MAX_RADIUS).contains(&centre.1) {
            return Err(CameraError::CentreRow(centre.1));
        }
        let geometry = geometry.with_centre(centre.0)?;
        let camera = Self { geometry, lens, centre, half_field: field_of_view_deg.to_radians() / 2.0 };
        if !(MIN_RADIUS..=MAX_RADIUS).contains(&camera.radius()) {
            return Err(LensError::Radius(camera.radius()).into());
        }
        if camera.lens.widest() < camera.half_field && !camera.corners_are_reached() {
            return Err(LensError::TurnsBack { angle: camera.lens.widest().to_degrees() }.into());
        }
        Ok(camera)
    }

    fn corners_are_reached(&self) -> bool {
        let (right, bottom) = (self.geometry.width() - 1, self.geometry.height() - 1);
        let corners = [(0, 0), (right, 0), (0, bottom), (right, bottom)];
        corners.into_iter().all(|(column, row)| {
            let (x, y) = self.offset(column, row);
            self.lens.reaches(x, y)
        })
    }

    /// The frame's geometry, with its centre at the lens's, to half a column.
    #[must_use]
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// The lens.
    #[must_use]
    pub fn lens(&self) -> &CalibratedLens {
        &self.lens
    }

    /// Column and row of the lens's axis.
    #[must_use]
    pub fn centre(&self) -> (f64, f64) {
        self.centre
    }

    /// The angle across the image circle, in radians.
    #[must_use]
    pub fn field_of_view(&self) -> f64 {
        2.0 * self.half_field
    }

    /// R of Eq. 9 in columns: where the lens images the edge of the field of view, so that a row that reaches the edge of the
    /// circle is stretched to the circle's full width. If the profile turns back before that edge, which is then outside the
    /// frame, R is f · fov/2.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.lens.column(self.half_field).unwrap_or(self.lens.focal_length() * self.half_field)
    }

    /// The row factors of Eq. 9 for [`Self::radius`]. y is counted in pixel widths, since the circle is round in no other unit.
    #[must_use]
    pub fn equation_9(&self) -> TableSet {
        self.table(|row| RowFactor::nearest(shrink_factor(self.radius(), self.height_of(row))))
    }

    /// The row factors that make the largest horizontal error of every row as small as possible.
    ///
    /// With a = column − C/2 and b = the column where it belongs − C/2, the error of a sample is k·a − b. So the largest error
    /// of a row is the upper envelope of lines in k, least where its rising part meets its falling part. k is at least 1, as a
    /// board requires, and a row without samples in the circle is not stretched. The samples are those of [`Self::targets`],
    /// and the error is that of Fig. 5, against this lens's own [`CalibratedLens::straightened`].
    #[must_use]
    pub fn fitted(&self) -> TableSet {
        self.table(|row| self.fitted_to(row))
    }

    fn table(&self, row_factor: impl Fn(usize) -> RowFactor) -> TableSet {
        TableSet::of_rows(self.geometry, row_factor)
    }

    fn fitted_to(&self, row: usize) -> RowFactor {
        let lines: Vec<(f64, f64)> = self.targets(row).map(|target| self.line(target)).collect();
        // As no a is negative, outward errors rise with k and inward errors fall.
        let outwards = |k: f64| lines.iter().map(|(a, b)| k * a - b).fold(f64::NEG_INFINITY, f64::max);
        let inwards = |k: f64| lines.iter().map(|(a, b)| b - k * a).fold(f64::NEG_INFINITY, f64::max);
        let (mut low, mut high) = (1.0, 1.0 / RowFactor::LEAST.fraction());
        if lines.is_empty() || outwards(low) >= inwards(low) {
            return RowFactor::ONE;
        }
        // Far finer than half a unit of Q: 1/k is known to 1e-13 of itself.
        while high - low > 1e-13 * low {
            let middle = f64::midpoint(low, high);
            if outwards(middle) < inwards(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        RowFactor::nearest(1.0 / low)
    }

    /// a and b of a sample, mirrored so that a is not negative.
    fn line(&self, target: Target) -> (f64, f64) {
        let middle = f64::from(self.geometry.centre2()) / 2.0;
        let (a, b) = (target.column as f64 - middle, target.right_column - middle);
        if a < 0.0 { (-a, -b) } else { (a, b) }
    }

    /// The samples of row `row` that lie in the image circle and belong inside the corrected frame, from left to right.
    pub fn targets(&self, row: usize) -> impl Iterator<Item = Target> + '_ {
        let last = (self.geometry.width() - 1) as f64;
        let nearest_to_axis = self.half_field.cos();
        let height = height_in_circle(self, row);
        let target = move |column| {
            let (x, y) = self.offset(column, row);
            let ray = self.lens.ray(x, y).filter(|ray| ray[2] >= nearest_to_axis)?;
            let (right, down) = self.lens.straightened(ray)?;
            let right_column = self.centre.0 + right;
            let inside = (0.0..=last).contains(&right_column);
            let (right_row, is_inner) = (self.centre.1 + down, is_inner(ray[2], height));
            inside.then_some(Target { column, right_column, right_row, is_inner })
        };
        (0..self.geometry.width()).filter_map(target)
    }

    /// How far the sample `target` of row `row` is from where it belongs when the row is corrected with `row_factor`.
    #[must_use]
    pub fn residual(&self, row: usize, row_factor: RowFactor, target: Target) -> Residual {
        let middle = f64::from(self.geometry.centre2()) / 2.0;
        let stretched = (target.column as f64 - middle) / row_factor.fraction();
        Residual { columns: middle + stretched - target.right_column, rows: row as f64 - target.right_row }
    }

    /// How far each of [`Self::targets`] of row `row` is from where it belongs in a frame corrected with `tables`.
    pub fn residuals<'a>(
        &'a self,
        tables: &'a TableSet,
        row: usize,
    ) -> impl Iterator<Item = (Target, Residual)> + 'a {
        let stretched = tables.row_factor(row);
        let values = if stretched.is_none() { tables.values(row) } else { None };
        self.targets(row).filter_map(move |target| {
            let residual = match (stretched, &values) {
                (Some(row_factor), _) => self.residual(row, row_factor, target),
                (None, Some(values)) => {
                    let columns = values.output(target.column as f64) - target.right_column;
                    Residual { columns, rows: row as f64 - target.right_row }
                }
                (None, None) => return None,
            };
            Some((target, residual))
        })
    }

    /// How many rows lie outside the image circle of [`Self::radius`].
    #[must_use]
    pub fn rows_outside_circle(&self) -> usize {
        (0..self.geometry.height()).filter(|&row| is_outside(self.radius(), self.height_of(row))).count()
    }

    /// How far above and below the axis the circle of 180 degrees reaches, in rows: the rows that the exact projection has,
    /// whatever [`Self::field_of_view`] is.
    #[must_use]
    pub fn hemisphere_height(&self) -> f64 {
        self.lens.lowest_row(FRAC_PI_2)
    }

    /// How many rows lie above or below the circle of 180 degrees.
    #[must_use]
    pub fn rows_outside_hemisphere(&self) -> usize {
        (0..self.geometry.height()).filter(|&row| height_in_circle(self, row) >= 1.0).count()
    }

    fn offset(&self, column: usize, row: usize) -> (f64, f64) {
        (column as f64 - self.centre.0, row as f64 - self.centre.1)
    }

    /// y of a row, in pixel widths.
    fn height_of(&self, row: usize) -> f64 {
        (row as f64 - self.centre.1) * self.lens.pixel_height()
    }
}
