//! Line drawings, as SVG.

use std::fmt::Write as _;

/// A drawing in its own coordinates, x to the right and y down.
#[derive(Clone, Debug)]
pub(super) struct Canvas {
    /// Left, top, width and height.
    view: [f64; 4],
    body: String,
}

impl Canvas {
    /// An empty drawing that shows `view`: left, top, width and height.
    pub(super) fn new(view: [f64; 4]) -> Self {
        Self { view, body: String::new() }
    }

    /// A line through `points`.
    pub(super) fn line(&mut self, points: impl IntoIterator<Item = (f64, f64)>, colour: &str, dashed: bool) {
        let path = points.into_iter().enumerate().fold(String::new(), |mut path, (index, (x, y))| {
            // Writing to a string cannot fail.
            let _ = write!(path, "{}{x:.2} {y:.2}", if index == 0 { 'M' } else { 'L' });
            path
        });
        let width = self.thin();
        let dashes = if dashed {
            format!(" stroke-dasharray=\"{} {}\"", 4.0 * width, 3.0 * width)
        } else {
            String::new()
        };
        let _ = writeln!(
            self.body,
            "<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"{dashes}/>"
        );
    }

    /// A dot.
    pub(super) fn dot(&mut self, (x, y): (f64, f64), colour: &str) {
        let radius = 3.0 * self.thin();
        let _ = writeln!(self.body, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{radius}\" fill=\"{colour}\"/>");
    }

    /// A few words that start at a position. They must not contain characters that XML reserves.
    pub(super) fn words(&mut self, (x, y): (f64, f64), words: &str, colour: &str) {
        let size = 9.0 * self.thin();
        let _ = writeln!(
            self.body,
            "<text x=\"{x:.2}\" y=\"{y:.2}\" font-size=\"{size}\" font-family=\"sans-serif\" fill=\"{colour}\">{words}</text>"
        );
    }

    /// The width of a line: a four-hundredth of the drawing's width.
    fn thin(&self) -> f64 {
        self.view[2] / 400.0
    }

    /// The complete SVG document.
    pub(super) fn document(&self) -> String {
        let [left, top, width, height] = self.view;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{left} {top} {width} {height}\" width=\"{}\" \
             height=\"{}\">\n<rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n{}</svg>\n",
            480.0,
            480.0 * height / width,
            self.body
        )
    }
}
