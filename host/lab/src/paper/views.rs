//! Flat views of what a fisheye lens sees: the projections of Fig. 4 and their inverses.
//!
//! Points are in pixels from the optical centre, x to the right and y down. Rays are u right, v down, w ahead.

use halfrow_model::{Equidistant, exact, exact_inverse, simplified, simplified_inverse};

/// Half the field of view of the perspective, from the axis to the middle of a side: 60°.
const PERSPECTIVE_HALF_FIELD: f64 = std::f64::consts::FRAC_PI_3;

/// A way of showing the sphere on a square of 2R x 2R.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// The lens's own image.
    Fisheye,
    /// Straight lines stay straight. It is 120° across, since 180° would be infinite.
    Perspective,
    /// Columns are longitudes, and angles are kept.
    Mercator,
    /// The paper's projection (Eqs. 6, 7).
    Exact,
    /// The paper's approximation to it (Eqs. 8, 9).
    Simplified,
}

impl View {
    /// All of them, in the order of Fig. 4.
    pub const ALL: [Self; 5] =
        [Self::Fisheye, Self::Perspective, Self::Mercator, Self::Exact, Self::Simplified];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Fisheye => "fisheye",
            Self::Perspective => "perspective",
            Self::Mercator => "Mercator",
            Self::Exact => "exact",
            Self::Simplified => "simplified",
        }
    }

    /// The position at which the direction `ray` is shown. It is meaningful only ahead of the lens (w > 0).
    #[must_use]
    pub fn place(self, lens: &Equidistant, ray: [f64; 3]) -> (f64, f64) {
        let [u, v, w] = ray;
        let (x_d, y_d) = lens.image_point(ray);
        let f = lens.focal_length();
        match self {
            Self::Fisheye => (x_d, y_d),
            Self::Perspective => {
                (perspective_focal_length(lens) * u / w, perspective_focal_length(lens) * v / w)
            }
            // ln tan(π/4 + φ/2) = asinh(tan φ)
            Self::Mercator => (f * u.atan2(w), f * (v / u.hypot(w)).asinh()),
            Self::Exact => exact(lens, x_d, y_d),
            Self::Simplified => simplified(lens.radius(), x_d, y_d),
        }
    }

    /// The fisheye point that is shown at (`x`, `y`); none if it would lie outside the image circle.
    #[must_use]
    pub fn source(self, lens: &Equidistant, x: f64, y: f64) -> Option<(f64, f64)> {
        let f = lens.focal_length();
        let point = match self {
            Self::Fisheye => (x, y),
            Self::Perspective => lens.image_point([x, y, perspective_focal_length(lens)]),
            Self::Mercator => lens.image_point(ray(x / f, (y / f).sinh().atan())),
            Self::Exact => exact_inverse(lens, x, y)?,
            Self::Simplified => simplified_inverse(lens.radius(), x, y),
        };
        (point.0.hypot(point.1) <= lens.radius() + 1e-9).then_some(point)
    }
}

/// The direction with this longitude and latitude in radians, as a unit vector (Eq. 3).
#[must_use]
pub fn ray(longitude: f64, latitude: f64) -> [f64; 3] {
    let across = latitude.cos();
    [across * longitude.sin(), latitude.sin(), across * longitude.cos()]
}

/// The distance from the eye to the picture, in pixels.
fn perspective_focal_length(lens: &Equidistant) -> f64 {
    lens.radius() / PERSPECTIVE_HALF_FIELD.tan()
}
