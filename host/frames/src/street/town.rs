//! The town: three rows of houses, and what a ray meets first.

use super::light::Light;
use super::{facade, figures, ground, sky};

/// The camera's height above the ground, in metres.
pub(super) const CAMERA: f64 = 2.6;

/// How far the houses extend behind their façade, in metres.
const DEPTH: f64 = 14.0;

/// Which side of the street a row of houses is on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Side {
    /// Along the street at u = −distance.
    Left,
    /// Along the street at u = distance.
    Right,
    /// Across its end at w = distance.
    Across,
}

/// One house of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct House {
    /// Where its façade begins and ends along the row: w for the side rows, u for the one across.
    pub(super) from: f64,
    /// See [`Self::from`].
    pub(super) to: f64,
    /// The height of its roof above the ground.
    pub(super) roof: f64,
    /// The colour of its walls. Neighbours alternate between light and dark, so that their edge can be measured.
    pub(super) wall: Light,
}

/// Houses wall to wall.
pub(super) struct Row {
    pub(super) side: Side,
    /// From the camera to the façades, in metres.
    pub(super) distance: f64,
    pub(super) houses: &'static [House],
}

const fn house(from: f64, to: f64, roof: f64, wall: Light) -> House {
    House { from, to, roof, wall }
}

const CREAM: Light = Light::new(0.82, 0.74, 0.58);
const WHITE: Light = Light::new(0.84, 0.83, 0.80);
const ROSE: Light = Light::new(0.80, 0.62, 0.55);
const SAND: Light = Light::new(0.78, 0.68, 0.46);
const BRICK: Light = Light::new(0.30, 0.12, 0.085);
const SLATE: Light = Light::new(0.15, 0.18, 0.23);
const BROWN: Light = Light::new(0.20, 0.13, 0.09);
const MOSS: Light = Light::new(0.14, 0.20, 0.14);

/// The rows that line the street and close it.
pub(super) static ROWS: [Row; 3] = [
    Row {
        side: Side::Left,
        distance: 8.0,
        houses: &[
            house(-40.0, -6.0, 13.0, BRICK),
            house(-6.0, 2.4, 15.5, SAND),
            house(2.4, 7.0, 12.5, BROWN),
            house(7.0, 12.5, 14.8, CREAM),
            house(12.5, 18.5, 11.6, BRICK),
            house(18.5, 27.0, 13.7, WHITE),
        ],
    },
    Row {
        side: Side::Right,
        distance: 9.0,
        houses: &[
            house(-40.0, -5.0, 14.0, WHITE),
            house(-5.0, 4.2, 12.0, SLATE),
            house(4.2, 9.6, 14.5, WHITE),
            house(9.6, 16.0, 12.8, MOSS),
            house(16.0, 22.0, 15.2, ROSE),
            house(22.0, 27.0, 11.9, BROWN),
        ],
    },
    Row {
        side: Side::Across,
        distance: 37.0,
        houses: &[
            house(-60.0, -14.0, 13.0, CREAM),
            house(-14.0, -3.2, 15.0, SLATE),
            house(-3.2, 4.6, 17.5, CREAM),
            house(4.6, 15.0, 14.0, BRICK),
            house(15.0, 60.0, 12.5, WHITE),
        ],
    },
];

/// The upright edge between two neighbouring façades.
pub(super) struct Edge {
    /// The index of their row in [`ROWS`].
    pub(super) row: usize,
    /// The index of the first of the two houses in the row.
    pub(super) house: usize,
    /// Its longitude in radians, positive to the right.
    pub(super) longitude: f64,
}

/// All edges between neighbours.
pub(super) fn edges() -> impl Iterator<Item = Edge> {
    ROWS.iter().enumerate().flat_map(|(row, houses)| {
        houses.houses.windows(2).enumerate().map(move |(house, pair)| {
            let (u, w) = match houses.side {
                Side::Left => (-houses.distance, pair[0].to),
                Side::Right => (houses.distance, pair[0].to),
                Side::Across => (pair[0].to, houses.distance),
            };
            Edge { row, house, longitude: u.atan2(w) }
        })
    })
}

/// What a ray meets. In metres, as everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Hit {
    /// Nothing.
    Sky,
    /// The ground at (u, w).
    Ground(f64, f64),
    /// A façade: its row and house, and the place on it, along the row and above the ground.
    Facade {
        /// The index of the row in [`ROWS`].
        row: usize,
        /// The index of the house in the row.
        house: usize,
        /// The place along the row.
        along: f64,
        /// The height above the ground.
        height: f64,
    },
    /// The wall of a house that stands above its neighbour.
    Gable(Side, House),
    /// Something that stands in the street, of this colour.
    Figure(Light),
}

/// The light that comes back along `ray`, a unit vector.
pub(super) fn light(ray: [f64; 3]) -> Light {
    match seen(ray) {
        Hit::Sky => sky::light(ray),
        Hit::Ground(u, w) => ground::light(u, w),
        Hit::Facade { row, house, along, height } => {
            let row = &ROWS[row];
            facade::light(row.side, &row.houses[house], along, height)
        }
        Hit::Gable(side, house) => facade::gable(side, &house),
        Hit::Figure(light) => light,
    }
}

/// What `ray` meets first.
pub(super) fn seen(ray: [f64; 3]) -> Hit {
    let (distance, behind) = built(ray);
    figures::seen(ray, distance).map_or(behind, Hit::Figure)
}

/// Which house or ground `ray` meets, and how far away.
fn built(ray: [f64; 3]) -> (f64, Hit) {
    let [u, v, w] = ray;
    let floor = if v > 0.0 { CAMERA / v } else { f64::INFINITY };
    let ground = if v > 0.0 { Hit::Ground(u * floor, w * floor) } else { Hit::Sky };
    let meeting = |row: usize| ROWS[row].meets(row, ray).filter(|(distance, _)| *distance < floor);
    meeting(usize::from(u > 0.0)).or_else(|| meeting(2)).unwrap_or((floor, ground))
}

impl Row {
    /// What `ray` meets of this row, whose index in [`ROWS`] is `index`, and how far away.
    fn meets(&self, index: usize, [u, v, w]: [f64; 3]) -> Option<(f64, Hit)> {
        let (towards, sideways) = match self.side {
            Side::Left => (-u, w),
            Side::Right => (u, w),
            Side::Across => (w, u),
        };
        if towards <= 0.0 {
            return None;
        }
        let distance = self.distance / towards;
        let (along, height) = (distance * sideways, CAMERA - distance * v);
        let house = self.houses.iter().position(|house| (house.from..house.to).contains(&along))?;
        if height <= self.houses[house].roof {
            return Some((distance, Hit::Facade { row: index, house, along, height }));
        }
        let beyond = |house: &'static House, wall: f64| {
            let distance = wall / sideways;
            let within = distance * towards < self.distance + DEPTH;
            (within && CAMERA - distance * v <= house.roof)
                .then_some((distance, Hit::Gable(self.side, *house)))
        };
        if sideways > 0.0 {
            self.houses.iter().skip(house + 1).find_map(|house| beyond(house, house.from))
        } else {
            self.houses.iter().take(house).rev().find_map(|house| beyond(house, house.to))
        }
    }
}
