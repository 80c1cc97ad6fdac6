//! A photograph in which somebody has marked straight lines, for Fig. 4.
//!
//! ```json
//! {"circle": {"centre": [959.5, 539.5], "radius": 640},
//!  "lines": [{"from": [700, 200], "to": [690, 820], "is": "upright"}, …]}
//! ```
//!
//! Points are columns and rows of the photograph, counted from 0. The circle is where the lens, which is assumed to be
//! equidistant, images 90° from its axis.

use std::error::Error;
use std::io;
use std::path::{Path, PathBuf};

use halfrow::files::text;
use halfrow::frames::preview::RgbImage;
use halfrow::frames::{self, ReadError};
use halfrow_model::{Equidistant, LensError, MIN_RADIUS};
use serde::Deserialize;

use super::lines::{Constraint, Line};

/// A photograph, its image circle and its lines.
#[derive(Clone, Debug)]
pub struct MarkedPhotograph {
    pub(super) image: RgbImage,
    /// Column and row of the circle's middle.
    pub(super) centre: (f64, f64),
    /// Pixels.
    pub(super) radius: f64,
    pub(super) lines: Vec<Line>,
}

/// A photograph or its lines that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum MarkedError {
    /// The photograph cannot be read.
    #[error("the photograph cannot be used; give a PNG in colour of 8 bits, a JPEG, a WebP or a BMP")]
    Photograph(#[from] ReadError),
    /// The file of lines cannot be read.
    #[error("{} cannot be read; check that it is there and readable", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The file of lines does not have the form that it must have.
    #[error(
        "{} is no file of lines; write {{\"circle\": {{\"centre\": [x, y], \"radius\": r}}, \"lines\": [{{\"from\": [x, y], \
         \"to\": [x, y], \"is\": \"upright\"}}]}}",
        path.display()
    )]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong, and where.
        source: Box<dyn Error + Send + Sync>,
    },
    /// No lens has the radius of the circle in the file of lines.
    #[error(
        "the circle in {} has the radius {radius}; give at least {least}, the pixels from its middle to where the lens images 90°",
        path.display(),
        least = MIN_RADIUS
    )]
    Radius {
        /// The file.
        path: PathBuf,
        /// The radius.
        radius: f64,
        /// Why.
        source: LensError,
    },
    /// The file of lines has none, so that there is nothing to keep straight.
    #[error("{} marks no line; mark at least one straight line of the photograph", path.display())]
    NoLine {
        /// The file.
        path: PathBuf,
    },
    /// A marked line is too short, or ends outside of the image circle.
    #[error(
        "entry {number} of `lines` in {} is too short, or lies beyond what a projection shows; mark it inside of the image circle",
        path.display()
    )]
    Line {
        /// The file.
        path: PathBuf,
        /// Which, from 1.
        number: usize,
    },
    /// A marked line ends outside of the photograph, so that it may be of another one.
    #[error(
        "entry {number} of `lines` in {} ends outside of the photograph, which has {width} x {height} pixels; mark it in this \
         photograph, turned as it is shown",
        path.display()
    )]
    Outside {
        /// The file.
        path: PathBuf,
        /// Which, from 1.
        number: usize,
        /// Columns of the photograph.
        width: usize,
        /// Its rows.
        height: usize,
    },
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Content {
    circle: Circle,
    lines: Vec<Marked>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Circle {
    centre: [f64; 2],
    radius: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Marked {
    from: [f64; 2],
    to: [f64; 2],
    is: Constraint,
}

/// `error` shortened to what can be read, followed by its place.
fn short(error: &serde_json::Error) -> Box<dyn Error + Send + Sync> {
    let (whole, place) = (error.to_string(), format!(" at line {} column {}", error.line(), error.column()));
    let said = whole.strip_suffix(&place).unwrap_or(&whole);
    format!("{}{place}", text::told(said)).into()
}

impl MarkedPhotograph {
    /// The photograph in the file `photograph`, with the lines in the file `lines`.
    ///
    /// # Errors
    /// [`MarkedError`] for the first thing that is wrong.
    pub fn read(photograph: &Path, lines: &Path) -> Result<Self, MarkedError> {
        let path = || lines.to_owned();
        let text =
            text::read(lines, text::MAX_BYTES).map_err(|source| MarkedError::Io { path: path(), source })?;
        let content: Content = serde_json::from_str(text::without_mark(&text))
            .map_err(|error| MarkedError::Content { path: path(), source: short(&error) })?;
        let Circle { centre: [column, row], radius } = content.circle;
        let lens = Equidistant::from_radius(radius).map_err(|source| MarkedError::Radius {
            path: path(),
            radius,
            source,
        })?;
        if content.lines.is_empty() {
            return Err(MarkedError::NoLine { path: path() });
        }
        let ray = |[x, y]: [f64; 2]| {
            let (right, down) = (x - column, y - row);
            lens.ray(right, down).filter(|_| right.hypot(down) <= radius)
        };
        let marked = content.lines.iter().zip(1..).map(|(line, number)| {
            let ends = ray(line.from).zip(ray(line.to));
            let found = ends.and_then(|(from, to)| Line::between([from, to], line.is));
            found.ok_or_else(|| MarkedError::Line { path: path(), number })
        });
        let marked = marked.collect::<Result<_, _>>()?;
        let image = frames::read_shown(photograph)?;
        let (width, height) = (image.width, image.height);
        let is_shown = |line: &Marked| [line.from, line.to].into_iter().all(|end| shows(&image, end));
        if let Some(place) = content.lines.iter().position(|line| !is_shown(line)) {
            return Err(MarkedError::Outside { path: path(), number: place + 1, width, height });
        }
        Ok(Self { image, centre: (column, row), radius, lines: marked })
    }
}

/// Whether the point lies in a pixel of `image`. The middle of the first is at 0.
fn shows(image: &RgbImage, [column, row]: [f64; 2]) -> bool {
    let is_in = |at: f64, pixels: usize| (-0.5..=pixels as f64 - 0.5).contains(&at);
    is_in(column, image.width) && is_in(row, image.height)
}
