//! Figs. 3 and 6(a): longitudes and latitudes every 10° in the hemisphere in front of the lens.

use halfrow_model::Equidistant;

use super::exhibit::{Accepted, Cell, Claim, Drawing, Exhibit, Picture, Table, largest};
use super::svg::Canvas;
use super::views::{View, ray};
use super::{Item, PaperError};

/// R in pixels.
const RADIUS: f64 = 100.0;

/// The poles themselves have no longitude, so lines end at this latitude, in degrees.
const NEAR_POLE: f64 = 89.9;

/// The colours of longitudes and of latitudes.
const COLOURS: [&str; 2] = ["#a8326f", "#1f5f8b"];

/// How far a longitude may be from a straight column in the exact projection, in pixels: only rounding.
const STRAIGHT: f64 = 1e-9;

/// A line on the sphere.
struct Line {
    kind: usize,
    degrees: i32,
    /// Longitude and latitude of its points, in degrees.
    points: Vec<(f64, f64)>,
}

const KINDS: [&str; 2] = ["longitude", "latitude"];

/// Fig. 3: the fisheye model and the exact projection.
pub(super) fn figure_3() -> Result<Exhibit, PaperError> {
    let lens = Equidistant::from_radius(RADIUS)?;
    let mut exhibit = Exhibit::new(Item::Fig3);
    exhibit.remark("Longitudes and latitudes from −90° to 90°, every 10°, R = 100.");
    exhibit.claims.push(Claim {
        what: "farthest that a longitude is from its straight column, exact projection (Eq. 5)".to_owned(),
        unit: "px",
        paper: None,
        found: farthest_from_column(&lens, View::Exact),
        accepted: Accepted::UpTo(STRAIGHT),
        judges_board: false,
    });
    exhibit.pictures.push(map(&lens, View::Fisheye, "fig-3a", "Fig. 3(a): the fisheye model."));
    exhibit.pictures.push(map(&lens, View::Exact, "fig-3b", "Fig. 3(b): the exact projection (Eqs. 6, 7)."));
    exhibit.tables.push(table(&lens, "fig-3", &[View::Fisheye, View::Exact]));
    Ok(exhibit)
}

/// Adds Fig. 6(a), the simplified projection, with the table of its points.
pub(super) fn figure_6a(exhibit: &mut Exhibit) -> Result<(), PaperError> {
    let lens = Equidistant::from_radius(RADIUS)?;
    let caption = "Fig. 6(a): the simplified projection (Eqs. 8, 9).";
    exhibit.pictures.push(map(&lens, View::Simplified, "fig-6a", caption));
    exhibit.tables.push(table(&lens, "fig-6a", &[View::Simplified]));
    Ok(())
}

fn lines() -> Vec<Line> {
    let tens = || (-9..=9).map(|tens| 10 * tens);
    let along = |end: f64| {
        let inner = (-89..=89).map(f64::from);
        std::iter::once(-end).chain(inner).chain([end]).collect::<Vec<f64>>()
    };
    let longitudes = tens().map(|degrees| Line {
        kind: 0,
        degrees,
        points: along(NEAR_POLE).into_iter().map(|latitude| (f64::from(degrees), latitude)).collect(),
    });
    let latitudes = tens().filter(|degrees| degrees.abs() < 90).map(|degrees| Line {
        kind: 1,
        degrees,
        points: along(90.0).into_iter().map(|longitude| (longitude, f64::from(degrees))).collect(),
    });
    longitudes.chain(latitudes).collect()
}

fn place(lens: &Equidistant, view: View, (longitude, latitude): (f64, f64)) -> (f64, f64) {
    view.place(lens, ray(longitude.to_radians(), latitude.to_radians()))
}

/// The largest |x − fθ| over all points of longitudes.
fn farthest_from_column(lens: &Equidistant, view: View) -> f64 {
    let points = lines().into_iter().filter(|line| line.kind == 0).flat_map(|line| line.points);
    let distances =
        points.map(|point| (place(lens, view, point).0 - lens.focal_length() * point.0.to_radians()).abs());
    largest(distances)
}

fn map(lens: &Equidistant, view: View, name: &str, caption: &str) -> Picture {
    let side = 2.2 * RADIUS;
    let mut canvas = Canvas::new([-side / 2.0, -side / 2.0, side, side]);
    for line in lines() {
        let points = line.points.iter().map(|&point| place(lens, view, point));
        canvas.line(points, COLOURS[line.kind], false);
    }
    Picture { name: name.to_owned(), caption: caption.to_owned(), drawing: Drawing::Lines(canvas.document()) }
}

fn table(lens: &Equidistant, name: &'static str, views: &[View]) -> Table {
    let mut rows = Vec::new();
    for &view in views {
        for line in lines() {
            rows.extend(line.points.iter().map(|&point| {
                let (x, y) = place(lens, view, point);
                let along = if line.kind == 0 { point.1 } else { point.0 };
                vec![
                    Cell::Text(view.name().to_owned()),
                    Cell::Text(KINDS[line.kind].to_owned()),
                    Cell::Number(f64::from(line.degrees), 0),
                    Cell::Number(along, 1),
                    Cell::Number(x, 4),
                    Cell::Number(y, 4),
                ]
            }));
        }
    }
    let columns = ["map", "line", "degrees", "along it, degrees", "x, px", "y, px"];
    Table {
        name,
        caption: "The points of the lines, R = 100.".to_owned(),
        columns: columns.map(str::to_owned).to_vec(),
        rows,
        on_page: false,
    }
}
