//! Linear light in three colours, and reproducible irregularities of surfaces.

use std::ops::Add;

/// Linear light, or the share of it that a surface reflects. 1 is what the sensor is exposed for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Light {
    pub(super) red: f64,
    pub(super) green: f64,
    pub(super) blue: f64,
}

impl Light {
    pub(super) const BLACK: Self = Self::new(0.0, 0.0, 0.0);

    /// The light on a surface in the sun.
    pub(super) const SUN: Self = Self::new(1.0, 0.95, 0.86);

    /// The light on a surface in the shade, from the sky.
    pub(super) const SHADE: Self = Self::new(0.33, 0.37, 0.44);

    pub(super) const fn new(red: f64, green: f64, blue: f64) -> Self {
        Self { red, green, blue }
    }

    pub(super) const fn grey(level: f64) -> Self {
        Self::new(level, level, level)
    }

    pub(super) fn scaled(self, factor: f64) -> Self {
        Self::new(self.red * factor, self.green * factor, self.blue * factor)
    }

    /// What a surface of this colour reflects of `falling`.
    pub(super) fn under(self, falling: Self) -> Self {
        Self::new(self.red * falling.red, self.green * falling.green, self.blue * falling.blue)
    }

    /// Whether the eye can tell this light from `other`.
    pub(super) fn differs(self, other: Self) -> bool {
        let apart = |a: f64, b: f64| (a - b).abs() > 0.01;
        apart(self.red, other.red) || apart(self.green, other.green) || apart(self.blue, other.blue)
    }

    /// This light, `share` of it replaced by `other`; `share` 0 to 1.
    pub(super) fn mixed(self, other: Self, share: f64) -> Self {
        self.scaled(1.0 - share) + other.scaled(share)
    }
}

impl Add for Light {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::new(self.red + other.red, self.green + other.green, self.blue + other.blue)
    }
}

/// A number in 0..1 for the cell (`x`, `y`), as if drawn at random.
pub(super) fn speckle(x: f64, y: f64) -> f64 {
    let mix = |value: u64| (value ^ (value >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let cell = (x.floor() as i64 as u64) ^ (y.floor() as i64 as u64).rotate_left(32);
    (mix(mix(cell.wrapping_add(0x9e37_79b9_7f4a_7c15))) >> 40) as f64 / f64::from(1 << 24)
}

/// A number in 0..1 that changes smoothly over cells of size 1.
pub(super) fn cloud(x: f64, y: f64) -> f64 {
    let ease = |t: f64| t * t * (3.0 - 2.0 * t);
    let (s, t) = (ease(x - x.floor()), ease(y - y.floor()));
    let across = |y: f64| speckle(x, y) * (1.0 - s) + speckle(x + 1.0, y) * s;
    across(y) * (1.0 - t) + across(y + 1.0) * t
}
