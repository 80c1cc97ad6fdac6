//! Eq. 9, fitted rows and the exact projection, side by side: on the map of Fig. 5 and on façades.

use halfrow_model::{Camera, Equidistant, Frame, Interpolant, Kernel, Phase, correct};

use super::cameras::{self, DSL215, PAPER};
use super::details::cut;
use super::exhibit::{Accepted, Cell, Claim, Drawing, Exhibit, Picture, Table, largest};
use super::ways::Way;
use super::{Item, PaperError};
use crate::Residuals;
use halfrow::frames::HeatMap;
use halfrow::frames::preview::{RgbImage, demosaic};
use halfrow::frames::street::{FoundEdge, found_edges, seen_by};
use halfrow::optics::{PAPER_SIZE, TablesBy};

/// R of Fig. 5 in pixels, and a frame that contains its circle: an even number of columns, with the axis on a whole one.
const RADIUS: f64 = 100.0;
const MAP: (usize, usize) = (202, 201);

/// The upper left corner of a façade's picture, column and row, and its size in columns and rows: the houses to the left, between
/// −63° and −23° through the paper's lens.
const CORNER: (usize, usize) = (180, 180);
const SIZE: (usize, usize) = (500, 720);

/// The colour of the line where an edge would be straight.
const UPRIGHT: [u8; 3] = [255, 40, 160];

/// Rows of an edge over which the median is taken: in a single row the strongest step may be that of a window.
const ROWS: usize = 15;

/// The most that an edge may bend in the exact projection, in pixels: the filter array and noise move a straight one by as much.
const STRAIGHT: f64 = 0.5;

/// The three ways, a column for each.
pub(super) fn exhibit() -> Result<Exhibit, PaperError> {
    let mut exhibit = Exhibit::new(Item::Verticals);
    exhibit.in_threes = true;
    exhibit.remark(
        "The maps are those of Fig. 5: how far a sample of the fisheye picture is put from its place in the exact projection, with \
         R = 100 and one scale for all three. Below them the street's façades as the datapath corrects them, through the paper's \
         lens and through a measured DSL215; a thin line stands in the mean column of every edge between two houses.",
    );
    exhibit.remark(format!(
        "The bend of an edge is found from the pixels of the frame: in each row that shows it, the place of the strongest step \
         between samples of one colour, and from those, how far the median of {ROWS} rows that follow each other is from the mean \
         column of all.",
    ));
    maps(&mut exhibit)?;
    let cameras = [
        (PAPER, "paper", cameras::paper(PAPER_SIZE)?),
        (DSL215, "dsl215", cameras::dsl215_before(PAPER_SIZE)?),
    ];
    let facades = cameras.map(|(lens, file, camera)| Facades::of(lens, file, &camera));
    let [paper, measured] = facades;
    let facades = [paper?, measured?];
    for facades in &facades {
        exhibit.pictures.extend(facades.pictures());
        exhibit.claims.push(facades.claim());
    }
    exhibit.tables.push(bends(&facades));
    exhibit.tables.push(edges(&facades));
    Ok(exhibit)
}

/// The three maps, and their means.
fn maps(exhibit: &mut Exhibit) -> Result<(), PaperError> {
    let lens = Equidistant::from_radius(RADIUS)?;
    let camera = cameras::equidistant(MAP, lens.radius(), (RADIUS, RADIUS))?;
    let left =
        Way::ALL.map(|way| Ok((way, Residuals::of(&camera, &way.tables(&camera, TablesBy::LEAST_ENTRIES)?))));
    let left = left.into_iter().collect::<Result<Vec<_>, PaperError>>()?;
    let most = left.iter().map(|(_, left)| left.circle.amounts.max).fold(0.0, f64::max);
    let samples = (MAP.1 * MAP.1) as f64;
    let mut rows = Vec::new();
    for (way, left) in &left {
        let map = HeatMap::up_to(&left.map, most);
        // The means of Fig. 5 count the zeros outside the circle.
        let mean = left.map.iter().flatten().sum::<f64>() / samples;
        exhibit.pictures.push(Picture {
            name: format!("map-{}", way.file()),
            caption: format!(
                "{}: the error, from 0 (dark) to {most:.1} px (bright); {mean:.4} px on the average, {:.3} px at most.",
                way.caption(),
                left.circle.amounts.max
            ),
            drawing: Drawing::Pixels(map.image, 3),
        });
        let amounts = [Cell::Number(mean, 4), Cell::Number(left.circle.amounts.max, 4)];
        rows.push(std::iter::once(Cell::Text(way.name().to_owned())).chain(amounts).collect());
    }
    exhibit.tables.push(Table {
        name: "map",
        caption: "The error over the map of Fig. 5, R = 100, in pixels of the corrected picture.".to_owned(),
        columns: ["tables by", "mean of the whole image", "largest"].map(str::to_owned).to_vec(),
        rows,
        on_page: true,
    });
    Ok(())
}

/// The street through one lens, before and after correction.
struct Facades {
    lens: &'static str,
    /// The stem of its file names.
    file: &'static str,
    fisheye: Vec<FoundEdge>,
    /// Corrected by each of [`Way::ALL`].
    corrected: Vec<(Way, Frame, Vec<FoundEdge>)>,
}

impl Facades {
    fn of(lens: &'static str, file: &'static str, camera: &Camera) -> Result<Self, PaperError> {
        let fisheye = seen_by(camera, Phase::Grbg, 1)?;
        let kernel = Kernel::from(Interpolant::Hermite);
        let corrected = Way::ALL.map(|way| {
            let frame = correct(&way.tables(camera, TablesBy::LEAST_ENTRIES)?, &kernel, &fisheye)?;
            let edges = found_edges(&frame, camera);
            Ok((way, frame, edges))
        });
        let corrected = corrected.into_iter().collect::<Result<_, PaperError>>()?;
        Ok(Self { lens, file, fisheye: found_edges(&fisheye, camera), corrected })
    }

    fn pictures(&self) -> impl Iterator<Item = Picture> {
        self.corrected.iter().map(|(way, frame, edges)| Picture {
            name: format!("facades-{}-{}", self.file, way.file()),
            caption: format!(
                "{}, {}: edges bend by up to {:.2} px.",
                way.caption(),
                self.lens,
                Bend::of(edges).max
            ),
            drawing: Drawing::Pixels(facade(frame, edges), 1),
        })
    }

    fn claim(&self) -> Claim {
        // An edge that is no longer found may have bent out of sight.
        let found = self.corrected.iter().find(|(way, ..)| *way == Way::Exact);
        let found = found.filter(|(.., edges)| edges.len() == self.fisheye.len());
        Claim {
            what: format!("farthest that an edge is from straight, exact projection, {}", self.lens),
            unit: "px",
            paper: None,
            found: found.map_or(f64::NAN, |(.., edges)| Bend::of(edges).max),
            accepted: Accepted::UpTo(STRAIGHT),
            judges_board: false,
        }
    }

    /// The edges before and after each correction, with its name.
    fn all(&self) -> impl Iterator<Item = (&'static str, &[FoundEdge])> {
        let corrected = self.corrected.iter().map(|(way, _, edges)| (way.name(), &edges[..]));
        std::iter::once(("fisheye", &self.fisheye[..])).chain(corrected)
    }
}

/// How far edges are from their mean columns, in pixels, by medians of [`ROWS`] rows; NaN if there is no such edge.
struct Bend {
    mean: f64,
    max: f64,
}

/// The distances of an edge from its mean column; none if the edge has fewer than [`ROWS`] rows.
fn distances(edge: &FoundEdge) -> Vec<f64> {
    let middle = edge.mean_column();
    let mut places = edge.places.clone();
    places.sort_unstable_by_key(|(row, _)| *row);
    let median = |rows: &[(usize, f64)]| {
        let mut columns: Vec<f64> = rows.iter().map(|(_, column)| *column).collect();
        columns.sort_unstable_by(f64::total_cmp);
        columns[rows.len() / 2]
    };
    places.windows(ROWS).map(|rows| (median(rows) - middle).abs()).collect()
}

impl Bend {
    fn of(edges: &[FoundEdge]) -> Self {
        let (mut count, mut sum, mut max) = (0.0, 0.0, f64::NAN);
        for distance in edges.iter().flat_map(distances) {
            (count, sum, max) = (count + 1.0, sum + distance, max.max(distance));
        }
        Self { mean: sum / count, max }
    }
}

/// The façades to the left, with a line where each edge would be straight.
fn facade(frame: &Frame, edges: &[FoundEdge]) -> RgbImage {
    let mut image = cut(&demosaic(frame), CORNER, SIZE);
    for edge in edges {
        let Some(column) = (edge.mean_column().round() as usize).checked_sub(CORNER.0) else { continue };
        let rows = edge.places.iter().filter_map(|(row, _)| row.checked_sub(CORNER.1));
        for row in rows.filter(|&row| row < SIZE.1 && column < SIZE.0) {
            let start = 3 * (row * SIZE.0 + column);
            image.data[start..start + 3].copy_from_slice(&UPRIGHT);
        }
    }
    image
}

fn bends(facades: &[Facades]) -> Table {
    let row = |lens: &str, name: &str, edges: &[FoundEdge]| {
        let Bend { mean, max } = Bend::of(edges);
        vec![
            Cell::Text(lens.to_owned()),
            Cell::Text(name.to_owned()),
            Cell::Number(edges.len() as f64, 0),
            Cell::Number(mean, 2),
            Cell::Number(max, 2),
        ]
    };
    let rows =
        facades.iter().flat_map(|facades| facades.all().map(|(name, edges)| row(facades.lens, name, edges)));
    Table {
        name: "verticals",
        caption: "How far the edges between the street's houses are from straight columns, found from the frames' pixels.".to_owned(),
        columns: ["lens", "picture", "edges", "mean, px", "largest, px"].map(str::to_owned).to_vec(),
        rows: rows.collect(),
        on_page: true,
    }
}

/// The table of all single edges.
fn edges(facades: &[Facades]) -> Table {
    let mut rows = Vec::new();
    for facades in facades {
        for (name, edges) in facades.all() {
            rows.extend(edges.iter().map(|edge| {
                let shown = edge.places.iter().map(|(row, _)| *row);
                let ends = [shown.clone().min(), shown.max()].map(|row| row.unwrap_or_default() as f64);
                vec![
                    Cell::Text(facades.lens.to_owned()),
                    Cell::Text(name.to_owned()),
                    Cell::Number(edge.longitude.to_degrees(), 4),
                    Cell::Number(edge.places.len() as f64, 0),
                    Cell::Number(ends[0], 0),
                    Cell::Number(ends[1], 0),
                    Cell::Number(edge.mean_column(), 3),
                    Cell::Number(largest(distances(edge).into_iter()), 3),
                ]
            }));
        }
    }
    let columns = [
        "lens",
        "picture",
        "longitude, degrees",
        "rows",
        "first row",
        "last row",
        "mean column",
        "largest, px",
    ];
    Table {
        name: "verticals-edges",
        caption: "Every edge by itself.".to_owned(),
        columns: columns.map(str::to_owned).to_vec(),
        rows,
        on_page: false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_that_are_not_found_are_not_straight() {
        let straight = FoundEdge { longitude: 0.0, places: (0..40).map(|row| (row, 9.0)).collect() };
        let frame = || Frame::new(64, halfrow_model::BitDepth::Eight, Phase::Grbg, vec![0; 64]).unwrap();
        let holds = |before: usize, behind: usize| {
            let edges = |count| vec![straight.clone(); count];
            let corrected = vec![(Way::Exact, frame(), edges(behind))];
            Facades { lens: PAPER, file: "paper", fisheye: edges(before), corrected }.claim().holds()
        };
        assert!(holds(2, 2));
        assert!(!holds(2, 1) && !holds(2, 0) && !holds(0, 0));
    }
}
