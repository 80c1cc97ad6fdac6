//! Figs. 4 and 6(b): one fisheye picture, shown in each projection.

use halfrow_model::{BitDepth, Equidistant, Geometry, Phase};

use super::exhibit::{Cell, Drawing, Exhibit, Picture, Table};
use super::views::{View, ray};
use super::{Item, PaperError, graticule};
use halfrow::frames::preview::{RgbImage, demosaic};
use halfrow::frames::{Builtin, Scene};

/// Columns and rows of the pictures: the whole image circle, 2R.
const SIDE: usize = 640;

/// The scene's vertical lines of the table, in degrees of longitude.
const LONGITUDES: [i32; 5] = [15, 30, 45, 60, 75];

/// They reach from −60° to 60° of latitude.
const REACH: i32 = 60;

/// Fig. 4: all projections but the simplified one.
pub(super) fn figure_4() -> Result<Exhibit, PaperError> {
    let (lens, fisheye) = fisheye()?;
    let mut exhibit = Exhibit::new(Item::Fig4);
    exhibit.remark(
        "The paper's photograph is not public; a rendered street, seen by an equidistant lens, stands for it.",
    );
    exhibit.remark(
        "Fig. 4(d), the method of Carroll et al., is left out: it optimises each picture anew from lines that a person \
         marks in it, so there is no formula to reproduce.",
    );
    let figures = [
        (View::Fisheye, "fig-4a", "Fig. 4(a): the fisheye picture, 180° across."),
        (View::Perspective, "fig-4b", "Fig. 4(b): perspective, 120° across."),
        (View::Mercator, "fig-4c", "Fig. 4(c): Mercator."),
        (View::Exact, "fig-4e", "Fig. 4(e): the paper's exact projection (Eqs. 6, 7)."),
    ];
    for (view, name, caption) in figures {
        exhibit.pictures.push(picture(&lens, &fisheye, view, name, caption));
    }
    exhibit.tables.push(straightness(&lens, "fig-4", &View::ALL[..4]));
    Ok(exhibit)
}

/// Fig. 6: the simplified projection, as a map and as a picture.
pub(super) fn figure_6() -> Result<Exhibit, PaperError> {
    let (lens, fisheye) = fisheye()?;
    let mut exhibit = Exhibit::new(Item::Fig6);
    graticule::figure_6a(&mut exhibit)?;
    let caption = "Fig. 6(b): the simplified projection (Eqs. 8, 9).";
    exhibit.pictures.push(picture(&lens, &fisheye, View::Simplified, "fig-6b", caption));
    exhibit.tables.push(straightness(&lens, "fig-6b", &[View::Exact, View::Simplified]));
    Ok(exhibit)
}

/// The street through a lens whose image circle fills the picture.
fn fisheye() -> Result<(Equidistant, RgbImage), PaperError> {
    let lens = Equidistant::from_radius(SIDE as f64 / 2.0)?;
    let geometry = Geometry::centred(SIDE, SIDE, BitDepth::Twelve)?;
    let scene = Scene { geometry, centre_y: None, phase: Phase::Grbg, lens, seed: 1 };
    Ok((lens, demosaic(&Builtin::Street.render(&scene)?)))
}

fn picture(lens: &Equidistant, fisheye: &RgbImage, view: View, name: &str, caption: &str) -> Picture {
    Picture {
        name: name.to_owned(),
        caption: caption.to_owned(),
        drawing: Drawing::Pixels(shown(lens, fisheye, view), 1),
    }
}

/// `fisheye` in a projection, black where the lens sees nothing.
fn shown(lens: &Equidistant, fisheye: &RgbImage, view: View) -> RgbImage {
    let centre = (SIDE as f64 - 1.0) / 2.0;
    let places = (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| (row, column)));
    let data = places.flat_map(|(row, column)| {
        let source = view.source(lens, column as f64 - centre, row as f64 - centre);
        source.map_or([0; 3], |(x, y)| sampled(fisheye, x + centre, y + centre))
    });
    RgbImage { width: SIDE, height: SIDE, data: data.collect() }
}

/// The colour at column `x`, row `y` of `image`, bilinear between four pixels.
fn sampled(image: &RgbImage, x: f64, y: f64) -> [u8; 3] {
    let x = x.clamp(0.0, image.width as f64 - 1.0);
    let y = y.clamp(0.0, image.height as f64 - 1.0);
    let (left, top) = (x as usize, y as usize);
    let (right, bottom) = ((left + 1).min(image.width - 1), (top + 1).min(image.height - 1));
    let (across, down) = (x - left as f64, y - top as f64);
    std::array::from_fn(|colour| {
        let value = |row, column| f64::from(image.data[3 * (row * image.width + column) + colour]);
        let upper = value(top, left) * (1.0 - across) + value(top, right) * across;
        let lower = value(bottom, left) * (1.0 - across) + value(bottom, right) * across;
        (upper * (1.0 - down) + lower * down + 0.5) as u8
    })
}

/// How crooked vertical lines of the scene are, in percent of R.
fn straightness(lens: &Equidistant, name: &'static str, views: &[View]) -> Table {
    let heads = views.iter().map(|view| format!("{}, % of R", view.name()));
    let row = |longitude: i32| {
        let spreads = views.iter().map(|&view| 100.0 * spread(lens, view, longitude) / lens.radius());
        std::iter::once(Cell::Number(f64::from(longitude), 0))
            .chain(spreads.map(|spread| Cell::Number(spread, 3)))
            .collect()
    };
    Table {
        name,
        caption: format!(
            "How far apart the columns of a vertical line of the scene are, from −{REACH}° to {REACH}° of latitude."
        ),
        columns: std::iter::once("longitude, degrees".to_owned()).chain(heads).collect(),
        rows: LONGITUDES.into_iter().map(row).collect(),
        on_page: true,
    }
}

/// The largest less the least x of the line at `longitude`, in pixels.
fn spread(lens: &Equidistant, view: View, longitude: i32) -> f64 {
    let column = |latitude: i32| {
        view.place(lens, ray(f64::from(longitude).to_radians(), f64::from(latitude).to_radians())).0
    };
    let ends = (-REACH..=REACH)
        .map(column)
        .fold((f64::MAX, f64::MIN), |(least, most), x| (least.min(x), most.max(x)));
    ends.1 - ends.0
}
