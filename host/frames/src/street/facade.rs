//! The façades: shops below, windows above, a cornice at the top.

use super::light::{Light, speckle};
use super::town::{House, Side};

/// Plain wall at either end of a façade, in metres.
pub(super) const MARGIN: f64 = 0.8;
/// The height of the ground floor, and of each floor above it.
const SHOP: f64 = 3.7;
const STOREY: f64 = 3.0;
const CORNICE: f64 = 0.45;
/// The desired distance from window to window.
const BAY: f64 = 2.3;

const TRIM: Light = Light::new(0.80, 0.79, 0.76);
const GLASS: Light = Light::new(0.045, 0.06, 0.075);
const CURTAIN: Light = Light::new(0.42, 0.40, 0.36);
/// How much of the sky a pane mirrors, per metre above its floor.
const SKY_IN_GLASS: Light = Light::new(0.05, 0.07, 0.10);
const LAMP: Light = Light::new(0.95, 0.75, 0.42);

/// The light from a façade at `along` its row and `height` above the ground.
pub(super) fn light(side: Side, house: &House, along: f64, height: f64) -> Light {
    let falling = falling(side);
    let place = (along - house.from).min(house.to - along);
    if house.roof - height < CORNICE {
        return house.wall.mixed(TRIM, 0.25).under(falling).scaled(cornice(house.roof - height));
    }
    if place < MARGIN {
        return house.wall.under(falling);
    }
    let inner = house.to - house.from - 2.0 * MARGIN;
    let bays = (inner / BAY).round().max(1.0);
    let bay = (along - house.from - MARGIN) / inner * bays;
    let width = inner / bays;
    if height < SHOP {
        shop(house, bay, width, height, falling)
    } else {
        upper(house, bay, width, height - SHOP, falling)
    }
}

/// The light from the bare side wall of a house.
pub(super) fn gable(side: Side, house: &House) -> Light {
    house.wall.mixed(Light::grey(0.3), 0.5).under(falling(side)).scaled(0.6)
}

/// The light that falls on a façade: the sun is behind the camera, to the right.
fn falling(side: Side) -> Light {
    match side {
        Side::Left => Light::SUN,
        Side::Right => Light::SHADE,
        Side::Across => Light::SUN.scaled(0.8),
    }
}

/// A cornice is bright on top and casts a shadow below.
fn cornice(below_roof: f64) -> f64 {
    if below_roof < 0.3 { 1.05 } else { 0.55 }
}

/// The ground floor: a sign above panes and a door.
fn shop(house: &House, bay: f64, width: f64, height: f64, falling: Light) -> Light {
    let number = bay.floor();
    let hue = speckle(house.from * 7.0, house.to);
    let accent = Light::new(0.15 + 0.6 * hue, 0.18 + 0.2 * (1.0 - hue), 0.5 - 0.4 * hue);
    let from_middle = ((bay - number - 0.5) * width).abs();
    let is_pane = from_middle < width / 2.0 - 0.18;
    let is_door = speckle(number, house.to * 3.0) < 0.3 && from_middle < 0.55;
    let surface = if height > 3.45 {
        house.wall.mixed(TRIM, 0.3)
    } else if height > 2.85 {
        accent
    } else if is_door && height < 2.2 {
        accent.scaled(0.5)
    } else if is_pane && height > 0.5 {
        GLASS.mixed(LAMP, 0.25 * speckle(number * 5.0, house.from))
    } else {
        house.wall.scaled(0.8)
    };
    surface.under(falling)
}

/// A storey above the shops: a window in each bay.
fn upper(house: &House, bay: f64, width: f64, height: f64, falling: Light) -> Light {
    let (floor, number) = ((height / STOREY).floor(), bay.floor());
    let (across, up) = (((bay - number - 0.5) * width).abs(), height.rem_euclid(STOREY));
    if up < 0.13 {
        return house.wall.mixed(TRIM, 0.35).under(falling);
    }
    let is_below_roof = SHOP + (floor + 1.0) * STOREY <= house.roof;
    if is_below_roof && across < 0.68 && (0.75..2.55).contains(&up) {
        return window(house, (number, floor), across, up, falling);
    }
    house.wall.under(falling).scaled(0.94 + 0.06 * speckle(bay * 9.0, height * 3.0))
}

/// A window, `across` from its middle and `up` from its floor: a frame with crossing bars, and what is behind the panes.
fn window(house: &House, (number, floor): (f64, f64), across: f64, up: f64, falling: Light) -> Light {
    let is_pane = (0.035..0.56).contains(&across) && (0.87..2.43).contains(&up) && (up - 1.9).abs() > 0.03;
    if !is_pane {
        return TRIM.under(falling);
    }
    let inside = speckle(number + 31.0 * house.to.floor(), floor + 17.0 * house.from.floor());
    if inside < 0.07 {
        LAMP.scaled(0.7)
    } else if inside < 0.4 && across > 0.25 {
        CURTAIN.under(falling)
    } else {
        GLASS.under(falling) + SKY_IN_GLASS.scaled(up)
    }
}
