//! The sky: bluer towards the zenith, with some clouds.

use super::light::{Light, cloud};

const HORIZON: Light = Light::new(0.78, 0.84, 0.90);
const ZENITH: Light = Light::new(0.24, 0.42, 0.78);
const CLOUD: Light = Light::new(0.95, 0.95, 0.96);

/// The light from the direction `ray`.
pub(super) fn light([u, v, w]: [f64; 3]) -> Light {
    let rise = (-v).max(0.0);
    let blue = HORIZON.mixed(ZENITH, (1.6 * rise).min(1.0));
    let (x, y) = (u / (rise + 0.12), w / (rise + 0.12));
    let density = 0.6 * cloud(x, y + 5.0) + 0.3 * cloud(2.3 * x, 2.3 * y) + 0.1 * cloud(5.1 * x, 5.1 * y);
    blue.mixed(CLOUD, ((density - 0.5) * 4.0).clamp(0.0, 0.85))
}
