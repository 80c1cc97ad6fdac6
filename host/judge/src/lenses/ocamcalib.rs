//! OCamCalib's text file: lines of numbers with comments between them.
//!
//! Its x counts rows and its y columns. Row comes before column, and height before width. Its z points away from the scene. The
//! centre counts from 0, as the toolbox exports it, although MATLAB counts from 1.

use halfrow_model::{CalibratedLens, Profile};

use super::{LensContentError, LensFile, LensModel, MAX_COEFFICIENTS, picture_size};
use halfrow_files::text::quoted;

/// The most pixels by which the inverse polynomial, which is a fit, may differ from the direct one.
const MAX_DISTANCE: f64 = 2.0;

/// Degrees from the axis at which the two are compared.
const COMPARED: [f64; 3] = [30.0, 60.0, 90.0];

/// A line of numbers.
struct Line {
    /// Its number, from 1.
    line: usize,
    numbers: Vec<f64>,
}

pub(super) fn parse(text: &str) -> Result<LensFile, LensContentError> {
    let lines = lines(text)?;
    let (direct, inverse, rest) = match lines.as_slice() {
        [direct, inverse, rest @ ..] if rest.len() == 3 => (direct, Some(inverse), rest),
        [direct, rest @ ..] if rest.len() == 3 => (direct, None, rest),
        _ => return Err(LensContentError::Lines { found: lines.len() }),
    };
    let direct = direct.polynomial("the direct polynomial")?;
    let [row, column] = rest[0].exactly("the centre's row and column")?;
    let [c, d, e] = rest[1].exactly("the affine parameters c, d, e")?;
    let [height, width] = rest[2].exactly("the image's height and width")?;
    let size = picture_size(width, height)?;
    match direct.first() {
        Some(&first) if first < 0.0 => {}
        first => return Err(LensContentError::Sign(first.copied().unwrap_or_default())),
    }
    let lens = CalibratedLens::new(Profile::Polynomial(direct.to_vec()), [[1.0, e], [d, c]])?;
    if let Some(inverse) = inverse {
        check_inverse(&lens, inverse.polynomial("the inverse polynomial")?, size)?;
    }
    let file = LensFile { model: LensModel::OCamCalib, lens, centre: (column, row), size: Some(size) };
    file.with_centre_inside()
}

/// The lines that contain numbers.
fn lines(text: &str) -> Result<Vec<Line>, LensContentError> {
    let mut lines = Vec::new();
    for (index, text) in text.lines().enumerate() {
        let line = index + 1;
        let words = text.split(['#', '%']).next().unwrap_or_default().split_whitespace();
        let number = |word: &str| {
            let number = word.parse().ok().filter(|number: &f64| number.is_finite());
            number.ok_or_else(|| LensContentError::Number { line, found: quoted(word) })
        };
        let numbers = words.map(number).collect::<Result<Vec<f64>, _>>()?;
        if !numbers.is_empty() {
            lines.push(Line { line, numbers });
        }
    }
    Ok(lines)
}

impl Line {
    fn exactly<const N: usize>(&self, what: &'static str) -> Result<[f64; N], LensContentError> {
        <[f64; N]>::try_from(self.numbers.as_slice()).map_err(|_| self.wrong(N, what))
    }

    /// The coefficients, which follow their count.
    fn polynomial(&self, what: &'static str) -> Result<&[f64], LensContentError> {
        let (&count, coefficients) = self.numbers.split_first().unwrap_or((&0.0, &[]));
        if count.fract() != 0.0 || !(1.0..=MAX_COEFFICIENTS as f64).contains(&count) {
            Err(LensContentError::Count { line: self.line, found: count, what })
        } else if count == coefficients.len() as f64 {
            Ok(coefficients)
        } else {
            Err(self.wrong(count as usize + 1, what))
        }
    }

    fn wrong(&self, wanted: usize, what: &'static str) -> LensContentError {
        LensContentError::Numbers { line: self.line, found: self.numbers.len(), wanted, what }
    }
}

/// Checks that the inverse polynomial belongs to the direct one; it gives r for the angle above the plane of the sensor. As a fit
/// it holds only inside the pictures, and it is used for nothing else.
fn check_inverse(
    lens: &CalibratedLens,
    inverse: &[f64],
    (width, height): (usize, usize),
) -> Result<(), LensContentError> {
    let shown = width.min(height) as f64 / 2.0;
    for degrees in COMPARED {
        let Some(direct) = lens.column(degrees.to_radians()).filter(|&r| r <= shown) else { continue };
        let above = (degrees - 90.0).to_radians();
        let fitted = inverse.iter().rev().fold(0.0, |value, coefficient| value * above + coefficient);
        let distance = (fitted - direct).abs();
        if distance.is_nan() || distance > MAX_DISTANCE {
            return Err(LensContentError::Inverse { distance, degrees });
        }
    }
    Ok(())
}
