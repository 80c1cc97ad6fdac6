//! A street seen through the fisheye lens: what a camera of the paper's kind delivers, of a scene that is known exactly.
//!
//! For each pixel some rays go out through the lens and return the colour of what they meet. The filter array keeps one
//! colour of it, and the sensor adds its noise. The world is in metres from the camera, which looks along the street: u to
//! the right, v down, w ahead, as in the lens model.

mod edges;
mod facade;
mod figures;
mod ground;
mod light;
mod lines;
mod sensor;
mod sight;
mod sky;
mod town;

use halfrow_model::{Camera, Colour, Frame, FrameError, Phase};

pub use edges::{EdgeDeviation, FoundEdge, edge_deviation, found_edges};
pub use lines::{SceneLine, lines};
pub use sight::Sight;

use super::scene::Scene;
use light::Light;
use sensor::Sensor;

/// Where in a pixel the rays pass, in pixels from its middle: four places, each in a row and a column of its own, beginning with
/// two opposite ones.
const RAYS: [(f64, f64); 4] = [(-0.375, -0.125), (0.375, 0.125), (0.125, -0.375), (-0.125, 0.375)];

/// The cosine of the angle to the axis beyond which the lens passes no light: 93°, half the field of view of the paper's lens.
const RIM: f64 = -0.052;

/// The street as `scene`'s sensor sees it.
///
/// # Errors
/// None for a legal geometry, as the sensor saturates at the largest sample.
pub(super) fn render(scene: &Scene) -> Result<Frame, FrameError> {
    rendered(scene, scene)
}

/// The street as a sensor of Bayer `phase` sees it through `camera`'s own lens; the same seed gives the same noise.
///
/// # Errors
/// None for a legal geometry, as the sensor saturates at the largest sample.
pub fn seen_by(camera: &Camera, phase: Phase, seed: u64) -> Result<Frame, FrameError> {
    rendered(&Scene { geometry: *camera.geometry(), phase, seed, ..Scene::default() }, camera)
}

/// The street on the sensor of `scene`, through the lens of `sight`.
fn rendered<S: Sight>(scene: &Scene, sight: &S) -> Result<Frame, FrameError> {
    scene.frame_of_rows(|row, samples| {
        let mut sensor = Sensor::new(scene.seed, scene.max(), row * samples.len());
        for (column, sample) in samples.iter_mut().enumerate() {
            let light = pixel(sight, column as f64 - sight.centre_x(), sight.y(row));
            *sample = sensor.sample(match scene.phase.colour(row, column) {
                Colour::Red => light.red,
                Colour::Green => light.green,
                Colour::Blue => light.blue,
            });
        }
    })
}

/// The light of the pixel whose middle is (`x`, `y`) from the optical centre. If the first two rays agree, two more would
/// add nothing.
fn pixel<S: Sight>(sight: &S, x: f64, y: f64) -> Light {
    let [first, second, third, fourth] = RAYS.map(|(dx, dy)| (x + dx, y + dy));
    let through = |(x, y)| through(sight, x, y);
    let (first, second) = (through(first), through(second));
    let half = (first + second).scaled(0.5);
    if first.differs(second) { half.mixed((through(third) + through(fourth)).scaled(0.5), 0.5) } else { half }
}

/// The light that the lens passes to one image point. It falls off a little towards the rim.
fn through<S: Sight>(sight: &S, x: f64, y: f64) -> Light {
    match sight.ray(x, y) {
        Some(ray @ [.., w]) if w >= RIM => town::light(ray).scaled(0.75 + 0.25 * w.max(0.0)),
        _ => Light::BLACK,
    }
}
