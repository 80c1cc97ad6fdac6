//! The lens: from a point of the fisheye image to the direction it was seen in (Eqs. 1 to 4).
//!
//! Image points are in pixels from the optical centre, x to the right and y down.

use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt;

/// The smallest image radius that a lens may have, in pixels.
pub const MIN_RADIUS: f64 = 1.0;

/// The largest image radius that a lens may have, in pixels; its square is still exact enough in double precision.
pub const MAX_RADIUS: f64 = 1e9;

/// A lens whose image radius is proportional to the angle to the axis: α = r / f (Eq. 1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equidistant {
    focal_length: f64,
    radius: f64,
}

/// A direction on the unit sphere, the optical axis at longitude 0, latitude 0 (Eq. 3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spherical {
    /// θ in radians, −π to π, positive to the right.
    pub longitude: f64,
    /// φ in radians, −π/2 to π/2, positive downwards as y is.
    pub latitude: f64,
}

impl Spherical {
    /// The longitude and latitude of the direction `ray`, of any length.
    ///
    /// The two-argument arctangent also holds beyond 90°, where those of Eqs. 3 and 4 would fold over, and keeps its precision
    /// near the poles.
    #[must_use]
    pub fn of([u, v, w]: [f64; 3]) -> Self {
        Self { longitude: u.atan2(w), latitude: v.atan2(u.hypot(w)) }
    }
}

/// A number in a message: printed with an exponent where plain digits would be long.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Short(pub f64);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(number) = *self;
        let size = number.abs();
        if size.is_finite() && size != 0.0 && !(1e-6..1e9).contains(&size) {
            write!(f, "{number:e}")
        } else {
            write!(f, "{number}")
        }
    }
}

/// The figures do not describe a lens.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LensError {
    /// An image radius outside [`MIN_RADIUS`] to [`MAX_RADIUS`].
    #[error(
        "an image radius of {} pixels is outside {min} to {max:e}; give the pixels from the axis to where a ray at \
         90 degrees lands, or a focal length, pitch and field of view that lead there",
        Short(*.0),
        min = MIN_RADIUS,
        max = MAX_RADIUS
    )]
    Radius(f64),
    /// A focal length that is not a finite number above zero.
    #[error("a focal length of {} mm is not a finite number above zero; take it from the lens's data sheet", Short(*.0))]
    FocalLength(f64),
    /// A pixel pitch that is not a finite number above zero.
    #[error("a pixel pitch of {} um is not a finite number above zero; take it from the sensor's data sheet", Short(*.0))]
    PixelPitch(f64),
    /// A field of view that is not above 0°, or is above 360°.
    #[error(
        "a field of view of {} degrees is not above 0 and at most 360; give the full angle across the image circle, \
         180 for a hemisphere",
        Short(*.0)
    )]
    FieldOfView(f64),
    /// A coefficient that is no finite number, or that leads to one.
    #[error("a coefficient of {} gives no lens; calibrate the lens again", Short(*.0))]
    Coefficient(f64),
    /// A profile that does not rise from the axis outwards.
    #[error(
        "the lens images no ray farther out than the axis itself; check the sign of the first coefficient"
    )]
    Axis,
    /// A picture that is not upright.
    #[error(
        "the lens's picture is mirrored, upside down or flat: its axes are {} pixels to the right and {} pixels \
         down; flip the frames, not the lens, and calibrate with upright ones",
        Short(*.right),
        Short(*.down)
    )]
    Mirrored {
        /// Pixels to the right for a unit to the right.
        right: f64,
        /// Pixels down for a unit down.
        down: f64,
    },
    /// A profile that turns back inside the frame.
    #[error(
        "the lens's r(θ) turns back at {angle:.1} degrees off the axis, inside the frame; calibrate with points out to \
         the frame's corners, or give a field of view below {field:.1} degrees",
        field = (20.0 * .angle).floor() / 10.0
    )]
    TurnsBack {
        /// Degrees from the axis.
        angle: f64,
    },
}

impl Equidistant {
    /// The lens that images 90° off the axis at `radius_px` pixels: R of Eq. 9, so f = 2R/π.
    ///
    /// # Errors
    /// [`LensError::Radius`] when the radius is outside [`MIN_RADIUS`] to [`MAX_RADIUS`].
    pub fn from_radius(radius_px: f64) -> Result<Self, LensError> {
        Self::checked(radius_px / FRAC_PI_2, radius_px)
    }

    /// The lens of focal length `focal_length_px` whose R is `radius_px`, as [`Self::focal_length`] and [`Self::radius`] say them.
    ///
    /// # Errors
    /// [`LensError::Radius`] when R is outside [`MIN_RADIUS`] to [`MAX_RADIUS`], or the radius of 90° is no finite number above
    /// zero.
    pub fn from_both(focal_length_px: f64, radius_px: f64) -> Result<Self, LensError> {
        if !is_positive(focal_length_px) {
            return Err(LensError::Radius(focal_length_px * FRAC_PI_2));
        }
        Self::checked(focal_length_px, radius_px)
    }

    /// The lens of focal length `focal_mm` on pixels of `pixel_um`, with an image circle `field_of_view_deg` across.
    ///
    /// R becomes the radius of the image circle, f · fov/2. Eq. 9 takes R as half the size of the whole image of 180°, so 180
    /// gives the paper's R. Another field of view stretches the rows until *its* circle fills the frame. It changes R alone and
    /// leaves f, and with it the exact projection, as it is.
    ///
    /// # Errors
    /// [`LensError`] when the focal length or the pitch is not above zero, the field of view is not above 0° and at most 360°,
    /// or R is outside [`MIN_RADIUS`] to [`MAX_RADIUS`].
    pub fn from_focal_length(
        focal_mm: f64,
        pixel_um: f64,
        field_of_view_deg: f64,
    ) -> Result<Self, LensError> {
        if !is_positive(focal_mm) {
            return Err(LensError::FocalLength(focal_mm));
        }
        if !is_positive(pixel_um) {
            return Err(LensError::PixelPitch(pixel_um));
        }
        if !is_positive(field_of_view_deg) || field_of_view_deg > 360.0 {
            return Err(LensError::FieldOfView(field_of_view_deg));
        }
        let focal_length = focal_mm * 1000.0 / pixel_um;
        Self::checked(focal_length, focal_length * field_of_view_deg.to_radians() / 2.0)
    }

    fn checked(focal_length: f64, radius: f64) -> Result<Self, LensError> {
        if (MIN_RADIUS..=MAX_RADIUS).contains(&radius) {
            Ok(Self { focal_length, radius })
        } else {
            Err(LensError::Radius(radius))
        }
    }

    /// f in pixels.
    #[must_use]
    pub fn focal_length(&self) -> f64 {
        self.focal_length
    }

    /// R in pixels, the radius of Eq. 9; see [`Self::from_radius`] and [`Self::from_focal_length`].
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The direction seen at the image point (`x`, `y`), as a unit vector: u right, v down, w forward (Eq. 2). None farther out
    /// than πf, where nothing is imaged.
    ///
    /// Beyond 90° (r > πf/2) w is negative: the ray comes from behind the lens.
    #[must_use]
    pub fn ray(&self, x: f64, y: f64) -> Option<[f64; 3]> {
        let r = x.hypot(y);
        (r <= PI * self.focal_length).then(|| self.direction(x, y, r))
    }

    /// [`Self::ray`] at the distance `r` from the axis, going on periodically beyond πf.
    fn direction(&self, x: f64, y: f64, r: f64) -> [f64; 3] {
        if r == 0.0 {
            return [0.0, 0.0, 1.0];
        }
        let (sine, cosine) = (r / self.focal_length).sin_cos();
        [sine * x / r, sine * y / r, cosine]
    }

    /// The direction seen at the image point (`x`, `y`), which is no farther out than πf, as longitude and latitude.
    #[must_use]
    pub fn spherical(&self, x: f64, y: f64) -> Spherical {
        Spherical::of(self.direction(x, y, x.hypot(y)))
    }

    /// Where the direction `ray` is imaged, (x, y) in pixels: the inverse of [`Self::ray`] for vectors of any length.
    ///
    /// The direction straight back is imaged all around the rim; the rightmost point stands for it. A zero vector has no
    /// direction and gives the centre.
    #[must_use]
    pub fn image_point(&self, ray: [f64; 3]) -> (f64, f64) {
        let [u, v, w] = ray;
        let across = u.hypot(v);
        let r = self.focal_length * across.atan2(w);
        if across == 0.0 { (r, 0.0) } else { (r * u / across, r * v / across) }
    }
}

impl Default for Equidistant {
    /// The paper's lens on its sensor: 1.55 mm, 2.2 µm, 180°, so R = 1106.697 pixels (Sect. 4.2).
    fn default() -> Self {
        let focal_length = 1550.0 / 2.2;
        Self { focal_length, radius: focal_length * PI / 2.0 }
    }
}

pub(crate) fn is_positive(value: f64) -> bool {
    value.is_finite() && value > 0.0
}
