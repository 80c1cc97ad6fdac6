//! A lens as a calibration describes it: its profile, and how its image lies on the sensor's pixels.

use crate::profile::RisingProfile;
use crate::{Equidistant, LensError, Profile, Spherical};

/// A lens that is symmetrical about its axis, in front of a sensor whose pixels may be oblong or slanted.
///
/// As everywhere in this crate, image points are in pixels from the optical centre, x to the right and y down; rays have u to
/// the right, v down and w ahead.
#[derive(Clone, Debug, PartialEq)]
pub struct CalibratedLens {
    profile: RisingProfile,
    /// From the lens's own image to pixels.
    pixels: [[f64; 2]; 2],
    /// From pixels back to the lens's own image.
    image: [[f64; 2]; 2],
}

impl CalibratedLens {
    /// The lens with the profile `profile`, whose image point (right, down) lies at `pixels` · (right, down) on the sensor.
    ///
    /// OpenCV's camera matrix gives \[\[fx, s\], \[0, fy\]\], OCamCalib's affine parameters \[\[1, e\], \[d, c\]\].
    ///
    /// # Errors
    /// [`LensError`] when a number is not finite, the profile does not rise at the axis, or `pixels` does not keep the picture
    /// upright: each axis must keep its direction.
    pub fn new(profile: Profile, pixels: [[f64; 2]; 2]) -> Result<Self, LensError> {
        let [[xx, xy], [yx, yy]] = pixels;
        if let Some(&wrong) = pixels.iter().flatten().find(|entry| !entry.is_finite()) {
            return Err(LensError::Coefficient(wrong));
        }
        let area = xx * yy - xy * yx;
        if !(xx > 0.0 && yy > 0.0 && area > 0.0) {
            return Err(LensError::Mirrored { right: xx, down: yy });
        }
        let image = [[yy / area, -xy / area], [-yx / area, xx / area]];
        if !area.is_finite() || image.iter().flatten().any(|entry| !entry.is_finite()) {
            return Err(LensError::Coefficient(area));
        }
        Ok(Self { profile: RisingProfile::new(profile)?, pixels, image })
    }

    /// The same lens on a sensor with `factor` times as many pixels to the millimetre.
    ///
    /// # Errors
    /// [`LensError`] when `factor` is not above zero or the lens becomes too large or too small for a double.
    pub fn scaled(&self, factor: f64) -> Result<Self, LensError> {
        let pixels = self.pixels.map(|row| row.map(|entry| factor * entry));
        Self::new(self.profile.profile().clone(), pixels)
    }

    /// The angle to the axis, in radians, up to which the image radius grows with the angle; at most π.
    #[must_use]
    pub fn widest(&self) -> f64 {
        self.profile.widest()
    }

    /// The columns to the right of the centre at which a ray `angle` radians off the axis lands; none beyond [`Self::widest`].
    #[must_use]
    pub fn column(&self, angle: f64) -> Option<f64> {
        Some(self.pixels[0][0] * self.profile.radius(angle)?)
    }

    /// The focal length at the axis, in pixels to the right.
    #[must_use]
    pub fn focal_length(&self) -> f64 {
        self.pixels[0][0] * self.profile.focal_length()
    }

    /// The height of a pixel, in pixel widths.
    #[must_use]
    pub fn pixel_height(&self) -> f64 {
        self.pixels[0][0] / self.pixels[1][1]
    }

    /// The direction seen at the image point (`x`, `y`), as a unit vector; none where the profile has turned back.
    #[must_use]
    pub fn ray(&self, x: f64, y: f64) -> Option<[f64; 3]> {
        let (right, down) = transformed(self.image, x, y);
        let r = right.hypot(down);
        if r == 0.0 {
            return Some([0.0, 0.0, 1.0]);
        }
        let (sine, cosine) = self.profile.angle(r)?.sin_cos();
        Some([sine * right / r, sine * down / r, cosine])
    }

    /// Where the direction `ray`, of any length, is imaged; none beyond [`Self::widest`].
    #[must_use]
    pub fn image_point(&self, ray: [f64; 3]) -> Option<(f64, f64)> {
        let [u, v, w] = ray;
        let across = u.hypot(v);
        let r = self.profile.radius(across.atan2(w))?;
        let (right, down) = if across == 0.0 { (r, 0.0) } else { (r * u / across, r * v / across) };
        Some(transformed(self.pixels, right, down))
    }

    /// Where the exact projection puts what is seen in the direction `ray`, in pixels from the optical centre: Eqs. 5 to 7 with
    /// this lens's own r(θ) instead of f·θ.
    ///
    /// Every vertical of the scene is a longitude. It becomes the column at which the lens itself images that longitude on the
    /// horizon. So verticals are straight, the row of the axis stays as it is, and for an equidistant lens this is x_u = f ·
    /// longitude. The second number is the same for latitudes: the row at which the lens images the latitude above or below the
    /// axis. Eq. 7 keeps y instead, since a sample cannot change its row; no row factor can correct that difference.
    ///
    /// None where the longitude or the latitude is beyond [`Self::widest`].
    #[must_use]
    pub fn straightened(&self, ray: [f64; 3]) -> Option<(f64, f64)> {
        let Spherical { longitude, latitude } = Spherical::of(ray);
        let column = self.column(longitude.abs())?.copysign(longitude);
        let row = self.pixels[1][1] * self.profile.radius(latitude.abs())?;
        Some((column, row.copysign(latitude)))
    }

    /// The lowest row below the centre that a ray `angle` radians off the axis reaches; beyond [`Self::widest`], the one at it.
    pub(crate) fn lowest_row(&self, angle: f64) -> f64 {
        let [_, [yx, yy]] = self.pixels;
        yx.hypot(yy) * self.profile.radius(angle).unwrap_or(self.profile.farthest())
    }

    /// The columns, relative to the centre, at which rays `angle` radians off the axis cross row `y`, left and right. The row
    /// must be nearer to the centre than [`Self::lowest_row`].
    pub(crate) fn columns_at(&self, angle: f64, y: f64) -> [f64; 2] {
        let radius = self.profile.radius(angle).unwrap_or(self.profile.farthest());
        // |(a, b)·x + (c, d)| = radius.
        let [[a, c], [b, d]] = [self.image[0], self.image[1]].map(|[x_part, y_part]| [x_part, y_part * y]);
        let square = a * a + b * b;
        let middle = -(a * c + b * d) / square;
        let half = ((radius * radius - c * c - d * d) / square + middle * middle).max(0.0).sqrt();
        [middle - half, middle + half]
    }

    /// Whether the profile has not turned back at the image point (`x`, `y`).
    pub(crate) fn reaches(&self, x: f64, y: f64) -> bool {
        let (right, down) = transformed(self.image, x, y);
        right.hypot(down) <= self.profile.farthest()
    }
}

impl From<Equidistant> for CalibratedLens {
    fn from(lens: Equidistant) -> Self {
        let f = lens.focal_length();
        let profile = RisingProfile::equidistant();
        Self { profile, pixels: [[f, 0.0], [0.0, f]], image: [[1.0 / f, 0.0], [0.0, 1.0 / f]] }
    }
}

fn transformed([[xx, xy], [yx, yy]]: [[f64; 2]; 2], x: f64, y: f64) -> (f64, f64) {
    (xx * x + xy * y, yx * x + yy * y)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: half a radian is the circle of radius 5 in tenths. On it, (0, 5) and its mirror image (4.8, 1.4) in the
    /// direction (0.6, 0.8) land on the same row, and (3, 4) on the lowest one.
    #[test]
    fn a_row_of_slanted_pixels_crosses_a_circle_where_it_does_by_hand() {
        let pixels = [[10.0, 2.0], [7.5, 10.0]];
        let lens = CalibratedLens::new(Profile::KannalaBrandt([0.0; 4]), pixels).unwrap();
        assert!((lens.lowest_row(0.5) - 6.25).abs() < 1e-12);
        let [left, right] = lens.columns_at(0.5, 5.0);
        assert!((left - 1.0).abs() < 1e-12 && (right - 5.08).abs() < 1e-12, "{left} {right}");
    }
}
