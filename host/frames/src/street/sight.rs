//! How a camera sees the street.

use halfrow_model::{Camera, exact_inverse};

use super::super::scene::Scene;

/// A lens and sensor that look along the street. Points are in pixels from the optical centre, x to the right and y down.
pub trait Sight: Sync {
    /// The column of the optical centre.
    fn centre_x(&self) -> f64;

    /// y of `row`.
    fn y(&self, row: usize) -> f64;

    /// The direction that is seen at a point, as a unit vector: u right, v down, w ahead. None if the lens sees nothing there.
    fn ray(&self, x: f64, y: f64) -> Option<[f64; 3]>;

    /// The x at which a longitude, in radians, is imaged on the horizon: its column in the exact projection (Eq. 6).
    fn on_horizon(&self, longitude: f64) -> Option<f64>;

    /// The x at which a longitude, in radians, is imaged in the row at `y`.
    fn imaged(&self, longitude: f64, y: f64) -> Option<f64>;
}

/// Through its equidistant lens.
impl Sight for Scene {
    fn centre_x(&self) -> f64 {
        self.centre_x()
    }

    fn y(&self, row: usize) -> f64 {
        self.y(row)
    }

    fn ray(&self, x: f64, y: f64) -> Option<[f64; 3]> {
        self.lens.ray(x, y)
    }

    fn on_horizon(&self, longitude: f64) -> Option<f64> {
        Some(self.lens.focal_length() * longitude)
    }

    fn imaged(&self, longitude: f64, y: f64) -> Option<f64> {
        exact_inverse(&self.lens, self.lens.focal_length() * longitude, y).map(|(x, _)| x)
    }
}

/// Through the calibrated lens.
impl Sight for Camera {
    fn centre_x(&self) -> f64 {
        self.centre().0
    }

    fn y(&self, row: usize) -> f64 {
        row as f64 - self.centre().1
    }

    fn ray(&self, x: f64, y: f64) -> Option<[f64; 3]> {
        self.lens().ray(x, y)
    }

    fn on_horizon(&self, longitude: f64) -> Option<f64> {
        Some(self.lens().column(longitude.abs())?.copysign(longitude))
    }

    fn imaged(&self, longitude: f64, y: f64) -> Option<f64> {
        let (centre_x, centre_y) = self.centre();
        Some(self.source_column(centre_x + self.on_horizon(longitude)?, centre_y + y) - centre_x)
    }
}
