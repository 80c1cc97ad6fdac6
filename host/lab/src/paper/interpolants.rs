//! Fig. 8: the curves of each interpolant through the samples of a row.

use halfrow_model::{Interpolant, TAP_NAMES};

use super::Item;
use super::exhibit::{Cell, Drawing, Exhibit, Picture, Table};
use super::svg::Canvas;
use super::table_1::name;

/// Points of a curve in 0 ≤ x ≤ 2.
const POINTS: u32 = 129;

/// By how much the other colour is darker, as on a grey edge in coloured light.
const OTHER_COLOUR: f64 = 40.0;

/// The parts of the figure, and the interpolants in each.
const PARTS: [(&str, &str, &[Interpolant]); 3] = [
    ("fig-8a", "Fig. 8(a): nearest and linear interpolation.", &[Interpolant::Nearest, Interpolant::Linear]),
    ("fig-8b", "Fig. 8(b): cubic interpolation.", &[Interpolant::Keys]),
    ("fig-8c", "Fig. 8(c): Hermite interpolation.", &[Interpolant::Hermite]),
];

const GREEN: &str = "#1d7a46";
const RED: &str = "#b3283a";
const CURVES: [&str; 2] = ["#1f5f8b", "#a8326f"];

/// The brightness of green at `x` pixels right of G2, which is sampled: an edge.
fn edge(x: f64) -> f64 {
    128.0 + 70.0 * (1.1 * x - 1.4).tanh()
}

/// The samples of the seven taps, at x = −2 to 4.
fn taps() -> [f64; 7] {
    std::array::from_fn(|tap| {
        let value = edge(tap as f64 - 2.0);
        if tap % 2 == 0 { value } else { value - OTHER_COLOUR }
    })
}

/// G(x) by an interpolant (Eqs. 10, 11, 12, 18).
fn value(interpolant: Interpolant, x: f64) -> f64 {
    interpolant.weights(x).into_iter().zip(taps()).map(|(weight, sample)| weight * sample).sum()
}

/// The curves between two green samples, and the weights that make them.
pub(super) fn exhibit() -> Exhibit {
    let mut exhibit = Exhibit::new(Item::Fig8);
    exhibit.remark(format!(
        "A smooth edge (dashed) is sampled in green (dots on it) and, {OTHER_COLOUR} darker, in red. The curves run between the green \
         samples at x = 0 and x = 2. Nearest and linear see two green samples, cubic four, Hermite two and three red ones.",
    ));
    exhibit.pictures.extend(PARTS.map(|(name, caption, interpolants)| Picture {
        name: name.to_owned(),
        caption: caption.to_owned(),
        drawing: Drawing::Lines(drawn(interpolants)),
    }));
    exhibit.tables.push(table());
    exhibit
}

fn drawn(interpolants: &[Interpolant]) -> String {
    // 80 units across for a pixel, and one up for a level.
    let place = |x: f64, level: f64| (80.0 * x, 255.0 - level);
    let curve = |from: f64, to: f64, f: &dyn Fn(f64) -> f64| -> Vec<(f64, f64)> {
        let at = |point: u32| from + (to - from) * f64::from(point) / f64::from(POINTS - 1);
        (0..POINTS).map(|point| place(at(point), f(at(point)))).collect()
    };
    let mut canvas = Canvas::new([-200.0, 0.0, 560.0, 255.0]);
    canvas.line(curve(-2.0, 4.0, &edge), GREEN, true);
    for (index, (&interpolant, colour)) in interpolants.iter().zip(CURVES).enumerate() {
        canvas.line(curve(0.0, 2.0, &|x| value(interpolant, x)), colour, false);
        canvas.words((-190.0, 20.0 + 18.0 * index as f64), name(interpolant), colour);
    }
    for (tap, sample) in taps().into_iter().enumerate() {
        canvas.dot(place(tap as f64 - 2.0, sample), if tap % 2 == 0 { GREEN } else { RED });
    }
    canvas.document()
}

fn table() -> Table {
    let row = |interpolant: Interpolant, node: u32| {
        let x = f64::from(node) / 32.0;
        let weights = interpolant.weights(x).map(|weight| Cell::Number(weight, 8));
        let mut cells = vec![Cell::Text(name(interpolant).to_owned()), Cell::Number(x, 5)];
        cells.extend(weights);
        cells.push(Cell::Number(value(interpolant, x), 4));
        cells
    };
    let heads = ["interpolant", "x, px"].into_iter().chain(TAP_NAMES).chain(["G(x) of the drawing"]);
    Table {
        name: "fig-8",
        caption: "The weights at the kernel's 65 nodes (Eqs. 10, 11, 12, 18), and the drawn curves."
            .to_owned(),
        columns: heads.map(str::to_owned).collect(),
        rows: Interpolant::ALL.into_iter().flat_map(|it| (0..65).map(move |node| row(it, node))).collect(),
        on_page: false,
    }
}
