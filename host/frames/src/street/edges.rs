//! How straight the houses stand, which measures what the correction is for.
//!
//! Every edge between two neighbouring façades is upright in the world, at one longitude θ. A fisheye lens bends it; corrected,
//! it should run down one column. On the horizon both images have it in the column of θ, with an equidistant lens f · θ from the
//! centre. From there it is followed through the pixels, up and down. The scene only says where to begin and which rows show
//! the edge. Both are the same in the two images, as the correction keeps the rows (Eq. 7).

use halfrow_model::Frame;
use serde::{Deserialize, Serialize};

use super::facade::MARGIN;
use super::sight::Sight;
use super::town::{self, Edge, Hit, ROWS};

/// How many columns to either side of its expected place an edge is looked for.
const REACH: usize = 6;

/// The smallest step between samples that counts as an edge, as a share of the largest sample.
const STEP: f64 = 1.0 / 32.0;

/// The least number of rows in which an edge must be found to count.
const LEAST_ROWS: usize = 32;

/// How far upright edges deviate from straight columns.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EdgeDeviation {
    /// How many edges were measured.
    pub edges: usize,
    /// The mean distance of an edge from its own mean column, over all rows of all edges, in pixels.
    pub mean_px: f64,
    /// The greatest distance of an edge from its own mean column, in pixels.
    pub max_px: f64,
}

/// An upright edge as found in a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundEdge {
    /// Its longitude in the world in radians, positive to the right.
    pub longitude: f64,
    /// Rows, and the column of the edge in each, to a fraction; from the horizon up, then from there down.
    pub places: Vec<(usize, f64)>,
}

impl FoundEdge {
    /// Its mean column.
    #[must_use]
    pub fn mean_column(&self) -> f64 {
        mean(&self.places.iter().map(|(_, column)| *column).collect::<Vec<_>>())
    }

    /// The distances of its places from its mean column, in pixels.
    pub fn distances(&self) -> impl Iterator<Item = f64> {
        let middle = self.mean_column();
        self.places.iter().map(move |(_, column)| (column - middle).abs())
    }
}

/// How far the edges of the street's houses deviate from straight columns in `frame`, which is the street rendered for `scene`,
/// corrected or not. An edge counts if it is found in most of the rows that show it. `None` if there is no such edge, as in
/// another picture or one that is too small.
#[must_use]
pub fn edge_deviation<S: Sight>(frame: &Frame, scene: &S) -> Option<EdgeDeviation> {
    let edges = found_edges(frame, scene);
    let distances: Vec<f64> = edges.iter().flat_map(FoundEdge::distances).collect();
    let max_px = distances.iter().copied().reduce(f64::max)?;
    Some(EdgeDeviation { edges: edges.len(), mean_px: mean(&distances), max_px })
}

/// The edges of the street's houses that are found in most of the rows of `frame` that show them, row of houses by row of houses.
/// `frame` is the street rendered for `scene`, corrected or not.
#[must_use]
pub fn found_edges<S: Sight>(frame: &Frame, scene: &S) -> Vec<FoundEdge> {
    let found =
        |edge: Edge| Some(FoundEdge { longitude: edge.longitude, places: places(frame, scene, &edge)? });
    town::edges().filter_map(found).collect()
}

/// The rows of `frame` in which the edge is found, each with its column, if these are most of the rows that show it.
fn places<S: Sight>(frame: &Frame, scene: &S, edge: &Edge) -> Option<Vec<(usize, f64)>> {
    let showing: Vec<usize> = (0..frame.height()).filter(|&row| shows(scene, edge, scene.y(row))).collect();
    let above = showing.partition_point(|&row| scene.y(row) < 0.0);
    let least = f64::from(frame.depth().max()) * STEP;
    let mut found = Vec::new();
    let (up, down) = showing.split_at(above);
    for rows in [&mut up.iter().rev() as &mut dyn Iterator<Item = &usize>, &mut down.iter()] {
        let mut track = Track::from_horizon(scene, edge)?;
        for &row in rows {
            let expected = track.column_at(scene.y(row));
            if let Some(column) = step_near(frame.row(row), expected, least) {
                track.update(column);
                found.push((row, column));
            }
        }
    }
    (found.len() >= LEAST_ROWS.max(showing.len() * 3 / 4)).then_some(found)
}

/// Whether the row at `y` shows the edge: plain wall of one house on its left and of the other on its right.
fn shows<S: Sight>(scene: &S, edge: &Edge, y: f64) -> bool {
    let Some(x) = scene.imaged(edge.longitude, y) else { return false };
    let reach = REACH as f64 + 1.0;
    let walls = [-reach, -1.0, 1.0, reach].map(|aside| wall_of(edge, town::seen(scene.ray(x + aside, y)?)));
    let [Some(left), Some(near_left), Some(near_right), Some(right)] = walls else { return false };
    left == near_left && right == near_right && left != right
}

/// Which of the two houses beside `edge` has the plain wall that is seen, if one has.
fn wall_of(edge: &Edge, seen: Hit) -> Option<usize> {
    match seen {
        Hit::Facade { row, house, along, .. } if row == edge.row => {
            let wall = ROWS.get(row)?.houses.get(edge.house)?.to;
            let beside = house == edge.house || house == edge.house + 1;
            (beside && (along - wall).abs() < MARGIN).then_some(house)
        }
        _ => None,
    }
}

/// A line that is followed from row to row: its place and slope, corrected a little by each measurement (an alpha-beta
/// filter).
struct Track {
    y: f64,
    column: f64,
    slope: f64,
}

impl Track {
    const ALPHA: f64 = 0.5;
    const BETA: f64 = 0.1;

    /// Upright, at its place on the horizon, if the lens images that place.
    fn from_horizon<S: Sight>(scene: &S, edge: &Edge) -> Option<Self> {
        let column = scene.centre_x() + scene.on_horizon(edge.longitude)?;
        Some(Self { y: 0.0, column, slope: 0.0 })
    }

    /// Moves on to the row at `y`, and returns where the line should be there.
    fn column_at(&mut self, y: f64) -> f64 {
        self.column += self.slope * (y - self.y);
        self.y = y;
        self.column
    }

    /// Notes that the line is at `column` in the present row.
    fn update(&mut self, column: f64) {
        let residual = column - self.column;
        self.column += Self::ALPHA * residual;
        self.slope += Self::BETA * residual * self.y.signum();
    }
}

/// The place of the strongest step between samples of one colour within [`REACH`] of `column`, to a fraction of a column.
fn step_near(row: &[u16], column: f64, least: f64) -> Option<f64> {
    let first = (column.round() as usize).saturating_sub(REACH).max(1);
    let windows = row.get(first - 1..)?.windows(3).take(2 * REACH + 1);
    let steps: Vec<f64> = windows.map(|samples| f64::from(samples[0].abs_diff(samples[2]))).collect();
    let strongest = steps.iter().enumerate().max_by(|(_, a), (_, b)| a.total_cmp(b));
    let (place, _) = strongest.filter(|(_, step)| **step >= least)?;
    let around = steps.iter().enumerate().skip(place.saturating_sub(2)).take(5);
    let (moment, weight) = around
        .fold((0.0, 0.0), |(moment, weight), (place, step)| (moment + place as f64 * step, weight + step));
    Some(first as f64 + moment / weight)
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    /// A wall of 100 and one of 900: if they meet at 19.8, column 20, which begins at 19.5, has 0.3 of the first.
    #[test]
    fn a_step_is_found_to_a_fraction_of_a_column() {
        let row: Vec<u16> = (0..40).map(|column| if column < 20 { 100 } else { 900 }).collect();
        assert_eq!(step_near(&row, 22.0, 50.0), Some(19.5));
        let mut blurred = row;
        blurred[20] = 660;
        let found = step_near(&blurred, 17.0, 50.0).unwrap();
        assert!((found - 19.8).abs() < 0.01, "{found}");
    }

    #[test]
    fn no_step_is_found_where_there_is_none() {
        let row: Vec<u16> = (0..40).map(|column| if column < 20 { 100 } else { 900 }).collect();
        assert_eq!(step_near(&row, 10.0, 50.0), None);
        assert_eq!(step_near(&row, 20.0, 1000.0), None);
        assert_eq!(step_near(&row, -50.0, 50.0), None);
        assert_eq!(step_near(&row, 5000.0, 50.0), None);
        assert_eq!(step_near(&[], 0.0, 50.0), None);
    }

    #[test]
    fn a_track_follows_a_bend_across_a_gap() {
        let scene = Scene::default();
        let edge = Edge { row: 0, house: 0, longitude: 1.0 };
        let bent = |y: f64| 959.5 + scene.lens.focal_length() - 3e-4 * y * y;
        for direction in [-1.0, 1.0] {
            let mut track = Track::from_horizon(&scene, &edge).unwrap();
            for y in (1..500).map(|step| direction * f64::from(step)) {
                let hidden = (200.0..260.0).contains(&y.abs());
                let expected = track.column_at(y);
                assert!((expected - bent(y)).abs() < 3.0, "{expected} at {y}");
                if !hidden {
                    track.update(bent(y));
                }
            }
        }
    }
}
