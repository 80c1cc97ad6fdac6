//! The ground: a road with markings, pavements, and the shadows on both.

use super::figures;
use super::light::{Light, speckle};
use super::town::{House, ROWS, Side};

/// Where the road ends at the left and at the right.
const KERBS: (f64, f64) = (-4.6, 5.4);
/// The crossing street at the end.
const CROSSING: (f64, f64) = (27.5, 34.0);
/// How far a shadow falls for each metre of height; it falls to the left.
pub(super) const SHADOW: f64 = 0.72;

const ASPHALT: Light = Light::new(0.135, 0.135, 0.14);
const PAINT: Light = Light::grey(0.62);
const SLAB: Light = Light::new(0.40, 0.385, 0.36);
const KERB: Light = Light::new(0.52, 0.51, 0.49);

/// The light from the ground at (u, w).
pub(super) fn light(u: f64, w: f64) -> Light {
    let falling = if is_shaded(u, w) { Light::SHADE } else { Light::SUN };
    colour(u, w).under(falling)
}

fn colour(u: f64, w: f64) -> Light {
    let crossing = (CROSSING.0..CROSSING.1).contains(&w);
    if !crossing && (w > CROSSING.1 || !(KERBS.0..KERBS.1).contains(&u)) {
        return pavement(u, w);
    }
    let wear = 0.9 + 0.2 * speckle(u * 12.0, w * 12.0);
    if is_painted(u, w) { PAINT.scaled(wear) } else { ASPHALT.scaled(wear) }
}

fn pavement(u: f64, w: f64) -> Light {
    let from_kerb = (KERBS.0 - u).max(u - KERBS.1);
    if w < CROSSING.0 && from_kerb < 0.18 {
        return KERB;
    }
    let joint = |place: f64| place - place.floor() < 0.035;
    if joint(u) || joint(w) { SLAB.scaled(0.6) } else { SLAB.scaled(0.9 + 0.15 * speckle(u, w)) }
}

/// A broken line in the middle, a solid one on each side, and a zebra crossing.
fn is_painted(u: f64, w: f64) -> bool {
    let middle = (KERBS.0 + KERBS.1) / 2.0;
    let zebra = (22.5..25.5).contains(&w);
    let (from_middle, from_kerb) = ((u - middle).abs(), (u - KERBS.0).min(KERBS.1 - u));
    if zebra {
        return (u - KERBS.0).rem_euclid(1.0) < 0.5 && from_kerb > 0.1;
    }
    w < 21.5 && (from_middle < 0.07 && w.rem_euclid(5.0) < 2.5 || (0.25..0.37).contains(&from_kerb))
}

/// Whether the houses on the right or a figure in the street shade the place.
fn is_shaded(u: f64, w: f64) -> bool {
    let houses = ROWS.iter().filter(|row| row.side == Side::Right).any(|row| {
        let at = |house: &&House| (house.from..house.to).contains(&w);
        row.houses.iter().find(at).is_some_and(|house| u > row.distance - SHADOW * house.roof)
    });
    houses || figures::shades(u, w)
}
