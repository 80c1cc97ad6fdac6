//! A street seen through the fisheye lens: what a camera of the paper's kind delivers, with the truth about it known.
//!
//! For each pixel some rays go out through the lens and come back with the colour of what they meet. The filter array
//! keeps one colour of it, and the sensor adds its noise. The world is in metres from the camera, which looks along the
//! street: u to the right, v down, w ahead, as the lens counts.

mod edges;
mod facade;
mod figures;
mod ground;
mod light;
mod lines;
mod sensor;
mod sky;
mod town;

use halfrow_model::{Colour, Frame, FrameError};

pub use edges::{EdgeDeviation, edge_deviation};
pub use lines::{SceneLine, lines};

use super::scene::Scene;
use light::Light;
use sensor::Sensor;

/// Where in a pixel the rays pass, in pixels from its middle: four places, each in a row and a column of its own, two
/// opposite ones first.
const RAYS: [(f64, f64); 4] = [(-0.375, -0.125), (0.375, 0.125), (0.125, -0.375), (-0.125, 0.375)];

/// The cosine of the angle to the axis beyond which the lens passes no light: 93°, half the field of the paper's lens.
const RIM: f64 = -0.052;

/// The street as `scene`'s sensor sees it.
///
/// # Errors
/// None for a legal geometry, as the sensor saturates at the largest sample.
pub(super) fn render(scene: &Scene) -> Result<Frame, FrameError> {
    scene.frame_of_rows(|row, samples| {
        let mut sensor = Sensor::new(scene.seed, scene.max(), row * samples.len());
        for (column, sample) in samples.iter_mut().enumerate() {
            let light = pixel(scene, column as f64 - scene.centre_x(), scene.y(row));
            *sample = sensor.sample(match scene.phase.colour(row, column) {
                Colour::Red => light.red,
                Colour::Green => light.green,
                Colour::Blue => light.blue,
            });
        }
    })
}

/// The light of the pixel whose middle is (`x`, `y`) from the optical centre. Where the first two rays agree, two more
/// would not tell anything else.
fn pixel(scene: &Scene, x: f64, y: f64) -> Light {
    let [first, second, third, fourth] = RAYS.map(|(dx, dy)| (x + dx, y + dy));
    let through = |(x, y)| through(scene, x, y);
    let (first, second) = (through(first), through(second));
    let half = (first + second).scaled(0.5);
    if first.differs(second) { half.mixed((through(third) + through(fourth)).scaled(0.5), 0.5) } else { half }
}

/// The light that the lens passes to one image point. It falls off a little towards the rim.
fn through(scene: &Scene, x: f64, y: f64) -> Light {
    let ray = scene.lens.ray(x, y);
    let [_, _, w] = ray;
    if w < RIM { Light::BLACK } else { town::light(ray).scaled(0.75 + 0.25 * w.max(0.0)) }
}
