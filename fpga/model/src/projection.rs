//! From the fisheye image to the corrected image: the exact projection (Eqs. 6, 7) and the simplified one (Eqs. 8, 9).
//!
//! All points are in pixels from the optical centre, x to the right and y down; `d` marks the distorted (fisheye) image and `u`
//! the undistorted one. Both projections keep y (Eq. 7), so that each row depends on itself alone.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::Equidistant;

/// The exact projection of the fisheye point (`x_d`, `y_d`): x_u = f · longitude (Eq. 6), y_u = y_d (Eq. 7).
///
/// Meaningful where the lens sees something, r < πf.
#[must_use]
pub fn exact(lens: &Equidistant, x_d: f64, y_d: f64) -> (f64, f64) {
    (lens.focal_length() * lens.spherical(x_d, y_d).longitude, y_d)
}

/// The fisheye point that [`exact`] projects to (`x_u`, `y_u`).
///
/// `None` where there is no such point or more than one: on rows at or beyond the poles (|y| ≥ πf/2), and for longitudes of
/// 180° and more (|x_u| ≥ πf). Elsewhere x_u rises with x_d, from the middle to the rim of the sphere at r = πf, and bisection
/// finds x_d to the last bit.
#[must_use]
pub fn exact_inverse(lens: &Equidistant, x_u: f64, y_u: f64) -> Option<(f64, f64)> {
    let f = lens.focal_length();
    let inside = y_u.abs() < FRAC_PI_2 * f && x_u.abs() < PI * f;
    if !inside {
        return None;
    }
    let rim = ((PI * f).powi(2) - y_u * y_u).sqrt();
    let x_d = bisect(rim, |x_d| exact(lens, x_d, y_u).0 < x_u.abs());
    Some((x_d.copysign(x_u), y_u))
}

/// The least double in 0..=`upper` for which `is_below` is false, for a predicate that is true below it.
fn bisect(upper: f64, is_below: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, upper);
    if !is_below(low) {
        return low;
    }
    loop {
        let middle = f64::midpoint(low, high);
        if middle <= low || middle >= high {
            return high;
        }
        if is_below(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/// The stretch factor of row `y`: k = R / sqrt(R² − y²) (Eq. 9), and 1 for a row outside the image circle, |y| ≥ R.
#[must_use]
pub fn stretch_factor(radius: f64, y: f64) -> f64 {
    1.0 / shrink_factor(radius, y)
}

/// 1/k, which takes a corrected column back to its source: sqrt(R² − y²) / R in (0, 1], and 1 outside the circle.
pub(crate) fn shrink_factor(radius: f64, y: f64) -> f64 {
    if is_outside(radius, y) { 1.0 } else { (radius * radius - y * y).sqrt() / radius }
}

/// Whether row `y` misses the image circle.
pub(crate) fn is_outside(radius: f64, y: f64) -> bool {
    y * y >= radius * radius
}

/// The simplified projection of the fisheye point (`x_d`, `y_d`): x_u = k · x_d, y_u = y_d (Eq. 8).
#[must_use]
pub fn simplified(radius: f64, x_d: f64, y_d: f64) -> (f64, f64) {
    (stretch_factor(radius, y_d) * x_d, y_d)
}

/// The fisheye point that [`simplified`] projects to (`x_u`, `y_u`).
#[must_use]
pub fn simplified_inverse(radius: f64, x_u: f64, y_u: f64) -> (f64, f64) {
    (shrink_factor(radius, y_u) * x_u, y_u)
}
