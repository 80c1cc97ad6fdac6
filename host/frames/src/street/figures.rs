//! What stands in the street: lamp posts and people.

use super::ground::SHADOW;
use super::light::Light;
use super::town::CAMERA;

/// Something upright that looks the same from every side.
struct Figure {
    /// Where it stands.
    u: f64,
    w: f64,
    /// Its height, and half of its greatest width.
    height: f64,
    reach: f64,
    kind: Kind,
}

enum Kind {
    Post,
    /// A person with a coat and trousers of these colours.
    Person(Light, Light),
}

const fn post(u: f64, w: f64) -> Figure {
    Figure { u, w, height: 6.2, reach: 0.24, kind: Kind::Post }
}

const fn person(u: f64, w: f64, height: f64, coat: Light, trousers: Light) -> Figure {
    Figure { u, w, height, reach: 0.27, kind: Kind::Person(coat, trousers) }
}

const RED: Light = Light::new(0.55, 0.08, 0.07);
const BLUE: Light = Light::new(0.08, 0.14, 0.36);
const GREEN: Light = Light::new(0.10, 0.28, 0.13);
const YELLOW: Light = Light::new(0.75, 0.60, 0.10);
const DARK: Light = Light::new(0.05, 0.05, 0.06);
const JEANS: Light = Light::new(0.10, 0.14, 0.24);
const SKIN: Light = Light::new(0.62, 0.42, 0.31);
const HAIR: Light = Light::new(0.07, 0.05, 0.035);
const IRON: Light = Light::new(0.07, 0.08, 0.08);
const LANTERN: Light = Light::new(0.85, 0.82, 0.70);

/// Where a coat begins and ends, as a share of a person's height.
const HIP: f64 = 0.48;
const NECK: f64 = 0.85;

static FIGURES: [Figure; 15] = [
    post(-5.1, 5.7),
    post(-5.1, 15.0),
    post(-5.1, 26.0),
    post(5.9, 7.6),
    post(5.9, 18.5),
    person(-3.1, 2.3, 1.74, RED, DARK),
    person(-6.9, 3.5, 1.68, YELLOW, JEANS),
    person(-6.0, 9.8, 1.82, BLUE, DARK),
    person(-6.9, 16.6, 1.71, GREEN, JEANS),
    person(3.4, 3.2, 1.78, BLUE, JEANS),
    person(6.6, 4.4, 1.70, YELLOW, DARK),
    person(7.2, 10.5, 1.80, RED, JEANS),
    person(6.8, 14.2, 1.66, GREEN, DARK),
    person(-1.2, 23.6, 1.76, RED, JEANS),
    person(1.5, 24.2, 1.72, YELLOW, DARK),
];

/// The light from the nearest figure that `ray` meets within `distance`, if it meets one.
pub(super) fn seen([u, v, w]: [f64; 3], distance: f64) -> Option<Light> {
    let level = u * u + w * w;
    let mut nearest = distance;
    let mut found = None;
    for figure in &FIGURES {
        let ahead = u * figure.u + w * figure.w;
        let aside = u * figure.w - w * figure.u;
        if ahead <= 0.0 || aside * aside > figure.reach * figure.reach * level || ahead > nearest * level {
            continue;
        }
        let (away, offset) = (ahead / level, aside / level.sqrt());
        if let Some(light) = figure.light(offset, CAMERA - away * v) {
            (nearest, found) = (away, Some(light));
        }
    }
    found
}

/// Whether the shadow of a figure lies on the ground at (u, w).
pub(super) fn shades(u: f64, w: f64) -> bool {
    FIGURES.iter().any(|figure| {
        let up = (figure.u - u) / SHADOW;
        figure.width(up).is_some_and(|width| (w - figure.w).abs() < width)
    })
}

impl Figure {
    /// Half of its width at `height` above the ground; none above its top and below the ground.
    fn width(&self, height: f64) -> Option<f64> {
        let share = height / self.height;
        if !(0.0..=1.0).contains(&share) {
            return None;
        }
        let ellipse = |middle: f64, half: f64| (1.0 - ((share - middle) / half).powi(2)).max(0.0).sqrt();
        Some(match self.kind {
            Kind::Post if share < 0.12 => 0.12,
            Kind::Post if share < 0.93 => 0.065,
            Kind::Post => 0.24 * ellipse(0.965, 0.04),
            Kind::Person(..) if share < 0.43 => 0.13 + 0.08 * share,
            Kind::Person(..) if share < HIP => 0.24,
            Kind::Person(..) if share < 0.76 => 0.25,
            Kind::Person(..) if share < NECK => (0.25 * ellipse(0.76, 0.09)).max(0.06),
            Kind::Person(..) => (0.09 * ellipse(0.925, 0.075)).max(if share < 0.87 { 0.055 } else { 0.0 }),
        })
    }

    /// The light from it at `offset` from its axis and `height` above the ground, if it reaches that far.
    fn light(&self, offset: f64, height: f64) -> Option<Light> {
        let width = self.width(height).filter(|width| offset.abs() < *width)?;
        let (share, across) = (height / self.height, offset.abs());
        let colour = match self.kind {
            Kind::Post if share > 0.93 => LANTERN,
            Kind::Post => IRON,
            Kind::Person(..) if share < 0.44 && across < 0.025 => return None,
            Kind::Person(_, trousers) if share < HIP && across < 0.17 => trousers,
            Kind::Person(..) if share < 0.47 => SKIN,
            Kind::Person(coat, _) if share < 0.74 && (across - 0.165).abs() < 0.012 => coat.scaled(0.4),
            Kind::Person(coat, _) if share < NECK => coat,
            Kind::Person(..) if share > 0.95 => HAIR,
            Kind::Person(..) => SKIN,
        };
        Some(lit(colour, offset / width))
    }
}

/// A round surface, brighter on the side towards the sun; `turn` goes from −1 to 1 across it.
fn lit(colour: Light, turn: f64) -> Light {
    colour.under(Light::SHADE.mixed(Light::SUN, 0.55 + 0.45 * turn))
}
