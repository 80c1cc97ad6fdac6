//! Straight lines of a scene, as directions from the camera. An optimised projection keeps them, and they show how straight any
//! projection is.

use halfrow::frames::street;
use serde::Deserialize;

/// How far from the middle and from the horizon a line counts, in degrees of longitude and latitude.
const REACH: (f64, f64) = (75.0, 65.0);

/// Steps along a whole line.
const SAMPLES: usize = 48;

/// What a straight line must be in the picture that is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Constraint {
    /// A column.
    Upright,
    /// A row.
    Level,
    /// Straight, in any direction.
    Straight,
}

/// A straight line of the scene.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Line {
    /// Directions along it: longitude and latitude in radians, to the right and down.
    pub(super) directions: Vec<(f64, f64)>,
    /// What it must be.
    pub(super) held: Constraint,
}

impl Line {
    /// The line between two rays of any length, u right, v down, w ahead, as far as it counts; none if too little of it counts,
    /// or if both rays are the same.
    #[must_use]
    pub(super) fn between(ends: [[f64; 3]; 2], held: Constraint) -> Option<Self> {
        let [from, to] = ends.map(unit);
        let steps = (0..=SAMPLES).map(|step| step as f64 / SAMPLES as f64);
        let along = steps.map(|share| std::array::from_fn(|at| from[at] + share * (to[at] - from[at])));
        let directions = along.map(|[u, v, w]: [f64; 3]| (u.atan2(w), v.atan2(u.hypot(w))));
        let counts = |(longitude, latitude): &(f64, f64)| {
            longitude.abs() < REACH.0.to_radians() && latitude.abs() < REACH.1.to_radians()
        };
        let directions: Vec<_> = directions.filter(counts).collect();
        (from != to && directions.len() > SAMPLES / 8).then_some(Self { directions, held })
    }
}

/// The lines of the street: its upright edges, the roofs across it, and those along it.
#[must_use]
pub(super) fn of_the_street() -> Vec<Line> {
    let line = |line: street::SceneLine| {
        let is_across = line.ends[0][2] == line.ends[1][2];
        let held = match (line.is_upright, is_across) {
            (true, _) => Constraint::Upright,
            (false, true) => Constraint::Level,
            (false, false) => Constraint::Straight,
        };
        Line::between(line.ends, held)
    };
    street::lines().into_iter().filter_map(line).collect()
}

fn unit(ray: [f64; 3]) -> [f64; 3] {
    let length = ray.iter().map(|part| part * part).sum::<f64>().sqrt();
    ray.map(|part| part / length)
}
