//! r(θ): how far from the centre a lens images a ray at the angle θ to its axis.

use std::f64::consts::PI;

use crate::LensError;

/// Places between the axis and the end of the search at which the slope of r(θ) is checked.
const PLACES: u32 = 4096;

/// How far out a polynomial is searched, in its own focal lengths: a stereographic lens images 152° there.
const REACH: f64 = 8.0;

/// A lens's profile, with its coefficients.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile {
    /// r = θ, of focal length 1 (Eq. 1).
    Equidistant,
    /// r = θ(1 + k1·θ² + k2·θ⁴ + k3·θ⁶ + k4·θ⁸), of focal length 1: Kannala and Brandt's model as in OpenCV's `fisheye`
    /// functions, the coefficients in the order k1 to k4.
    KannalaBrandt([f64; 4]),
    /// The ray at the image radius r goes r sideways for every −(a0 + a1·r + a2·r² + …) ahead: Scaramuzza's model, as in
    /// OCamCalib. The coefficients start with a0, which is minus the focal length in pixels.
    Polynomial(Vec<f64>),
}

/// The part of a [`Profile`] from the axis outwards in which r and θ rise together, so that each determines the other.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RisingProfile {
    profile: Profile,
    widest: f64,
    farthest: f64,
}

impl RisingProfile {
    /// # Errors
    /// [`LensError::Coefficient`] when a coefficient is not finite, [`LensError::Axis`] when r does not rise at the axis.
    pub(crate) fn new(profile: Profile) -> Result<Self, LensError> {
        let coefficients = match &profile {
            Profile::Equidistant => &[][..],
            Profile::KannalaBrandt(coefficients) => coefficients,
            Profile::Polynomial(coefficients) => coefficients,
        };
        if let Some(&wrong) = coefficients.iter().find(|coefficient| !coefficient.is_finite()) {
            return Err(LensError::Coefficient(wrong));
        }
        let end = profile.rising_end();
        let (widest, farthest) = match &profile {
            Profile::Polynomial(coefficients) => (angle_of(coefficients, end), end),
            _ => (end, profile.plain_radius(end).0),
        };
        if widest > 0.0 && farthest > 0.0 && farthest.is_finite() {
            Ok(Self { profile, widest, farthest })
        } else {
            Err(LensError::Axis)
        }
    }

    /// r = θ up to π, straight back.
    pub(crate) const fn equidistant() -> Self {
        Self { profile: Profile::Equidistant, widest: PI, farthest: PI }
    }

    pub(crate) fn profile(&self) -> &Profile {
        &self.profile
    }

    /// The largest θ in radians up to which r rises, at most π.
    pub(crate) fn widest(&self) -> f64 {
        self.widest
    }

    /// r at [`Self::widest`].
    pub(crate) fn farthest(&self) -> f64 {
        self.farthest
    }

    /// The slope of r(θ) at the axis.
    pub(crate) fn focal_length(&self) -> f64 {
        match &self.profile {
            Profile::Polynomial(coefficients) => -polynomial(coefficients, 0.0).0,
            _ => 1.0,
        }
    }

    /// r of θ in radians; none beyond the part in which it rises.
    pub(crate) fn radius(&self, angle: f64) -> Option<f64> {
        if !(0.0..=self.widest).contains(&angle) {
            return None;
        }
        Some(match &self.profile {
            Profile::Polynomial(coefficients) => {
                let (sine, cosine) = angle.sin_cos();
                let guess = (self.focal_length() * angle).min(self.farthest);
                rising_root(self.farthest, guess, |r| {
                    let (below, slope) = polynomial(coefficients, r);
                    (r * cosine + below * sine, cosine + slope * sine)
                })
            }
            _ => self.profile.plain_radius(angle).0,
        })
    }

    /// θ of r in radians; none beyond the part in which it rises.
    pub(crate) fn angle(&self, radius: f64) -> Option<f64> {
        if !(0.0..=self.farthest).contains(&radius) {
            return None;
        }
        Some(match &self.profile {
            Profile::Equidistant => radius,
            Profile::Polynomial(coefficients) => angle_of(coefficients, radius),
            Profile::KannalaBrandt(_) => rising_root(self.widest, radius.min(self.widest), |angle| {
                let (found, slope) = self.profile.plain_radius(angle);
                (found - radius, slope)
            }),
        })
    }
}

impl Profile {
    /// r and its slope, for a profile that is a formula of θ.
    fn plain_radius(&self, angle: f64) -> (f64, f64) {
        let Self::KannalaBrandt([k1, k2, k3, k4]) = self else {
            return (angle, 1.0);
        };
        let square = angle * angle;
        let series = [1.0, *k1, *k2, *k3, *k4];
        let (value, slope) = polynomial(&series, square);
        (angle * value, value + 2.0 * square * slope)
    }

    /// Where r and θ stop rising together: θ where r is a formula of θ, and r for a polynomial.
    fn rising_end(&self) -> f64 {
        let end = match self {
            Self::Polynomial(coefficients) => REACH * coefficients.first().map_or(0.0, |first| first.abs()),
            _ => PI,
        };
        let rises = |place: f64| match self {
            // The slope of θ = atan2(r, −p) by r has the sign of r·p′ − p.
            Self::Polynomial(coefficients) => {
                let (value, slope) = polynomial(coefficients, place);
                place * slope - value > 0.0
            }
            _ => self.plain_radius(place).1 > 0.0,
        };
        let place = |index: u32| end * f64::from(index) / f64::from(PLACES);
        match (0..=PLACES).find(|&index| !rises(place(index))) {
            None => end,
            Some(0) => 0.0,
            Some(index) => last_rising(place(index - 1), place(index), rises),
        }
    }
}

/// The last place between `low`, where the function rises, and `high`, where it does not.
fn last_rising(mut low: f64, mut high: f64, rises: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..60 {
        let middle = f64::midpoint(low, high);
        if rises(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// θ of the image radius `r`, 0 to π.
fn angle_of(coefficients: &[f64], r: f64) -> f64 {
    r.atan2(-polynomial(coefficients, r).0)
}

/// The value and the slope at `x` of the polynomial with these coefficients, lowest power first.
fn polynomial(coefficients: &[f64], x: f64) -> (f64, f64) {
    coefficients
        .iter()
        .rev()
        .fold((0.0, 0.0), |(value, slope), &coefficient| (value * x + coefficient, slope * x + value))
}

/// The root in 0..=`high` of a function that rises through 0 there: Newton's method, and bisection where a step would leave the
/// interval.
///
/// `function` returns the value and the slope.
fn rising_root(mut high: f64, guess: f64, function: impl Fn(f64) -> (f64, f64)) -> f64 {
    let (mut low, mut x) = (0.0, guess);
    for _ in 0..100 {
        let (value, slope) = function(x);
        if value == 0.0 {
            return x;
        }
        if value < 0.0 {
            low = x;
        } else {
            high = x;
        }
        let newton = x - value / slope;
        let next = if newton > low && newton < high { newton } else { f64::midpoint(low, high) };
        if (next - x).abs() <= 4.0 * f64::EPSILON * x.abs() {
            return next;
        }
        x = next;
    }
    x
}
