//! Figs. 4 and 6(b): one fisheye picture in each projection.

use halfrow_model::{BitDepth, Equidistant, Geometry, Phase};

use super::carroll::{self, Net};
use super::exhibit::{Accepted, Cell, Claim, Drawing, Exhibit, Picture, Table};
use super::lines::{self, Line};
use super::marked::MarkedPhotograph;
use super::views::{View, ray};
use super::{Item, PaperError, graticule, quality};
use halfrow::frames::preview::{RgbImage, demosaic};
use halfrow::frames::{Builtin, Scene};

/// Columns and rows of the pictures, which show the whole image circle: 2R.
const SIDE: usize = 640;

/// The column and the row of their middle.
const MIDDLE: f64 = (SIDE as f64 - 1.0) / 2.0;

/// Name of the projection of Fig. 4(d).
const OPTIMISED: &str = "Carroll et al.";

/// The vertical lines of the scene in the table, in degrees of longitude.
const LONGITUDES: [i32; 5] = [15, 30, 45, 60, 75];

/// How far outside of the middles of its outermost pixels a picture reaches, in pixels: half of one, and what rounding adds.
const EDGE: f64 = 0.5 + 1e-6;

/// The lines reach from −60° to 60° of latitude.
const REACH: i32 = 60;

/// Fig. 4: all projections but the simplified one, of the street or of a photograph with its own lines.
pub(super) fn figure_4(marked: Option<&MarkedPhotograph>) -> Result<Exhibit, PaperError> {
    let subject = marked.map_or_else(Subject::street, Subject::photograph)?;
    let mut exhibit = Exhibit::new(Item::Fig4);
    exhibit.remark(match marked {
        None => "The paper's photograph is not public; a rendered street, seen by an equidistant lens, stands for it.",
        Some(_) => "A photograph of your own stands for the paper's, as an equidistant lens would have taken it.",
    });
    exhibit.remark(
        "Fig. 4(d) is the method of Carroll et al. (ACM Transactions on Graphics 28, 2009), which makes a projection for each \
         picture from lines that are known to be straight: the street's own upright edges, roofs and feet of walls, or those that \
         were marked in a photograph.",
    );
    let net = Net::optimised(&subject.lines, subject.lens.focal_length())?;
    exhibit.in_threes = true;
    let figures = [
        (View::Fisheye, "fig-4a", "Fig. 4(a): the fisheye picture, 180° across."),
        (View::Perspective, "fig-4b", "Fig. 4(b): perspective, 120° across."),
        (View::Mercator, "fig-4c", "Fig. 4(c): Mercator."),
        (View::Exact, "fig-4e", "Fig. 4(e): the paper's exact projection (Eqs. 6, 7)."),
    ];
    for (view, name, caption) in figures {
        exhibit.pictures.push(subject.picture(view, name, caption));
    }
    exhibit.pictures.insert(3, subject.optimised(&net));
    exhibit.tables.push(straightness(&subject.lens, "fig-4", &View::ALL[..4]));
    let kept = kept(&subject, &net);
    if marked.is_none() {
        exhibit.claims = optimised_for(&kept);
    }
    exhibit.tables.push(table_of(&kept, subject.lines.len()));
    Ok(exhibit)
}

/// Fig. 6: the simplified projection, as a map and as a picture.
pub(super) fn figure_6() -> Result<Exhibit, PaperError> {
    let subject = Subject::street()?;
    let mut exhibit = Exhibit::new(Item::Fig6);
    graticule::figure_6a(&mut exhibit)?;
    let caption = "Fig. 6(b): the simplified projection (Eqs. 8, 9).";
    exhibit.pictures.push(subject.picture(View::Simplified, "fig-6b", caption));
    exhibit.tables.push(straightness(&subject.lens, "fig-6b", &[View::Exact, View::Simplified]));
    Ok(exhibit)
}

/// The picture that is shown.
struct Subject {
    /// A lens whose image circle fills the pictures that are made.
    lens: Equidistant,
    fisheye: RgbImage,
    /// The middle of the image circle in `fisheye`.
    centre: (f64, f64),
    /// Pixels of `fisheye` for one pixel of the pictures.
    scale: f64,
    lines: Vec<Line>,
}

impl Subject {
    /// The street.
    fn street() -> Result<Self, PaperError> {
        let lens = Equidistant::from_radius(SIDE as f64 / 2.0)?;
        let geometry = Geometry::centred(SIDE, SIDE, BitDepth::Twelve)?;
        let scene = Scene { geometry, centre_y: None, phase: Phase::Grbg, lens, seed: 1 };
        let fisheye = demosaic(&Builtin::Street.render(&scene)?);
        Ok(Self { lens, fisheye, centre: (MIDDLE, MIDDLE), scale: 1.0, lines: lines::of_the_street() })
    }

    fn photograph(marked: &MarkedPhotograph) -> Result<Self, PaperError> {
        let MarkedPhotograph { image, centre, radius, lines } = marked.clone();
        let lens = Equidistant::from_radius(SIDE as f64 / 2.0)?;
        Ok(Self { scale: radius / lens.radius(), lens, fisheye: image, centre, lines })
    }

    /// The colour at the fisheye point (`x`, `y`), in pixels of the pictures that are made.
    fn colour(&self, (x, y): (f64, f64)) -> [u8; 3] {
        sampled(&self.fisheye, self.centre.0 + self.scale * x, self.centre.1 + self.scale * y)
    }

    /// The subject in a projection, black where the lens sees nothing and where the photograph has ended.
    fn picture(&self, view: View, name: &str, caption: &str) -> Picture {
        let places = (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| (row, column)));
        let data = places.flat_map(|(row, column)| {
            let source = view.source(&self.lens, column as f64 - MIDDLE, row as f64 - MIDDLE);
            source.map_or([0; 3], |point| self.colour(point))
        });
        let image = RgbImage { width: SIDE, height: SIDE, data: data.collect() };
        pixels(name, caption, image)
    }

    /// Fig. 4(d): the subject in the projection that was made for its lines.
    fn optimised(&self, net: &Net) -> Picture {
        let colour = |longitude, latitude| self.colour(self.lens.image_point(ray(longitude, latitude)));
        let caption = "Fig. 4(d): the projection of Carroll et al., made for these lines.";
        pixels("fig-4d", caption, carroll::shown(net, SIDE, &colour))
    }
}

fn pixels(name: &str, caption: &str, image: RgbImage) -> Picture {
    Picture { name: name.to_owned(), caption: caption.to_owned(), drawing: Drawing::Pixels(image, 1) }
}

/// How well a projection keeps lines and shapes.
struct Quality {
    name: &'static str,
    /// See [`quality::straightness`].
    straightness: f64,
    /// See [`quality::conformality`].
    conformality: f64,
}

/// The same for each projection of Fig. 4, in its order.
fn kept(subject: &Subject, net: &Net) -> Vec<Quality> {
    let kept = |name, place: quality::Place<'_>| Quality {
        name,
        straightness: quality::straightness(place, &subject.lines),
        conformality: quality::conformality(place),
    };
    let of_view = |&view: &View| {
        kept(view.name(), &|longitude, latitude| view.place(&subject.lens, ray(longitude, latitude)))
    };
    let mut all: Vec<_> = View::ALL[..4].iter().map(of_view).collect();
    all.insert(3, kept(OPTIMISED, &|longitude, latitude| net.place(longitude, latitude)));
    all
}

/// The claims that the optimised projection does what it is made for.
fn optimised_for(kept: &[Quality]) -> Vec<Claim> {
    let named = |name: &str| kept.iter().find(|kept| kept.name == name);
    let views = [View::Mercator, View::Perspective].map(|view| named(view.name()));
    let (Some(own), [Some(mercator), Some(perspective)]) = (named(OPTIMISED), views) else {
        return Vec::new();
    };
    let below = |what: &str, unit, found: f64, limit: f64| Claim {
        what: what.to_owned(),
        unit,
        paper: None,
        found,
        accepted: Accepted::Below((limit * 1e4).round() / 1e4),
        judges_board: false,
    };
    vec![
        below(
            "farthest from straight, Carroll et al. against Mercator",
            "px",
            own.straightness,
            mercator.straightness,
        ),
        below(
            "shapes, Carroll et al. against perspective",
            "nepers",
            own.conformality,
            perspective.conformality,
        ),
    ]
}

fn table_of(kept: &[Quality], lines: usize) -> Table {
    let row = |kept: &Quality| {
        let Quality { name, straightness, conformality } = kept;
        vec![Cell::Text((*name).to_owned()), Cell::Number(*straightness, 2), Cell::Number(*conformality, 4)]
    };
    Table {
        name: "fig-4-lines",
        caption: format!(
            "How far a line is from its chord at most, of {lines}, in pixels of a picture of {SIDE}; and how far small shapes are \
             from what they are, mean |ln(σ1/σ2)| over ±{}° of longitude and ±{}° of latitude.",
            quality::SHOWN.0,
            quality::SHOWN.1
        ),
        columns: ["projection", "farthest from straight, px", "shapes, mean |ln(σ1/σ2)|"]
            .map(str::to_owned)
            .to_vec(),
        rows: kept.iter().map(row).collect(),
        on_page: true,
    }
}

/// The colour of `image` at column `x`, row `y`, by bilinear interpolation; black outside of it.
fn sampled(image: &RgbImage, x: f64, y: f64) -> [u8; 3] {
    let is_within = |at: f64, count: usize| (-EDGE..=count as f64 - 1.0 + EDGE).contains(&at);
    if !(is_within(x, image.width) && is_within(y, image.height)) {
        return [0; 3];
    }
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

/// The table of how crooked vertical lines of the scene are, in percent of R.
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

/// The largest x minus the least x of the line at `longitude`, in pixels.
fn spread(lens: &Equidistant, view: View, longitude: i32) -> f64 {
    let column = |latitude: i32| {
        view.place(lens, ray(f64::from(longitude).to_radians(), f64::from(latitude).to_radians())).0
    };
    let ends = (-REACH..=REACH)
        .map(column)
        .fold((f64::MAX, f64::MIN), |(least, most), x| (least.min(x), most.max(x)));
    ends.1 - ends.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outside_of_a_photograph_nothing_is_seen() {
        let image = RgbImage { width: 2, height: 1, data: vec![10, 20, 30, 50, 60, 70] };
        assert_eq!(sampled(&image, 0.5, 0.0), [30, 40, 50]);
        assert_eq!([sampled(&image, -0.5, 0.5), sampled(&image, 1.5, -0.5)], [[10, 20, 30], [50, 60, 70]]);
        for (x, y) in [(-0.6, 0.0), (1.6, 0.0), (0.0, -0.6), (0.0, 0.6)] {
            assert_eq!(sampled(&image, x, y), [0; 3], "{x}, {y}");
        }
    }
}
