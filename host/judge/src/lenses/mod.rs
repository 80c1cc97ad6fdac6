//! Lens files: what calibration programs write, converted into the model's lens.
//!
//! OpenCV's fisheye model comes as OpenCV's own FileStorage (YAML or JSON), as ROS's `camera_info` or as Kalibr's camchain;
//! OCamCalib has a text file of its own. A file with another model is refused, and the error names the model.

mod error;
mod fisheye;
mod ocamcalib;
mod tree;

use std::fmt;
use std::path::Path;

use halfrow_model::CalibratedLens;

pub use error::{LensContentError, LensFileError, WrongShape};

use crate::call::Input;
use halfrow_files::text;

/// The most columns and rows that pictures of a calibration may have.
const MAX_SIDE: usize = 65_535;

/// The most coefficients of a polynomial. Programs fit fewer than twenty, and every sample is computed with all of them.
const MAX_COEFFICIENTS: usize = 64;

/// The longest lens file that is read. OpenCV's programs store every corner of every picture in theirs.
const MAX_BYTES: u64 = 16 << 20;

/// The model of a lens file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LensModel {
    /// Kannala and Brandt's, as in OpenCV's `fisheye` functions.
    OpenCvFisheye,
    /// Scaramuzza's, as in OCamCalib.
    OCamCalib,
}

impl fmt::Display for LensModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::OpenCvFisheye => "OpenCV fisheye lens",
            Self::OCamCalib => "OCamCalib lens",
        })
    }
}

/// A lens as a file describes it.
#[derive(Clone, Debug, PartialEq)]
pub struct LensFile {
    /// The file's model.
    pub model: LensModel,
    /// The lens, in pixels of the pictures that it was calibrated with.
    pub lens: CalibratedLens,
    /// Column and row of the axis in those pictures, 0 being the middle of the first pixel.
    pub centre: (f64, f64),
    /// Columns and rows of those pictures, if the file names them.
    pub size: Option<(usize, usize)>,
}

impl LensFile {
    /// Reads the lens from the file `path`. Also returns the path and hash of what was read.
    ///
    /// # Errors
    /// [`LensFileError`] when the file cannot be read or holds no lens that can be used.
    pub fn read(path: &Path) -> Result<(Self, Input), LensFileError> {
        let text = text::read(path, MAX_BYTES)
            .map_err(|source| LensFileError::Io { path: path.to_owned(), source })?;
        match Self::parse(&text) {
            Ok(lens) => Ok((lens, Input::of_bytes(path, text.as_bytes()))),
            Err(source) => Err(LensFileError::Content { path: path.to_owned(), source }),
        }
    }

    /// The lens that `text` describes, in any of the formats.
    ///
    /// # Errors
    /// [`LensContentError`] when it describes no lens that can be used.
    pub fn parse(text: &str) -> Result<Self, LensContentError> {
        let text = text::without_mark(text);
        let mut lines = text.lines().map(str::trim);
        match lines.find(|line| !line.is_empty() && !is_comment(line)) {
            None => Err(LensContentError::Empty),
            Some(line) if line.starts_with('<') => Err(LensContentError::Xml),
            Some(line) if begins_with_number(line) => ocamcalib::parse(text),
            Some(_) => fisheye::parse(text),
        }
    }

    /// The file unchanged, if its axis lies inside its pictures.
    fn with_centre_inside(self) -> Result<Self, LensContentError> {
        let (column, row) = self.centre;
        let inside = |place: f64, side: usize| (0.0..=(side - 1) as f64).contains(&place);
        match self.size {
            Some((columns, rows)) if !(inside(column, columns) && inside(row, rows)) => {
                Err(LensContentError::Centre { column, row, columns, rows })
            }
            _ => Ok(self),
        }
    }

    /// The lens and its centre in frames of `width` x `height`: as calibrated if the frames have the size of the pictures or the
    /// file names no size, and scaled if they have the same shape.
    ///
    /// # Errors
    /// [`WrongShape`] when the frames have another shape, and what [`CalibratedLens::scaled`] refuses.
    pub fn for_frame(
        &self,
        width: usize,
        height: usize,
    ) -> Result<(CalibratedLens, (f64, f64)), LensContentError> {
        let Some((columns, rows)) = self.size.filter(|&size| size != (width, height)) else {
            return Ok((self.lens.clone(), self.centre));
        };
        let has_pixels = width > 0 && height > 0;
        if !has_pixels || columns as u128 * height as u128 != rows as u128 * width as u128 {
            return Err(WrongShape { columns, rows, width, height }.into());
        }
        let factor = width as f64 / columns as f64;
        // The middle of the first pixel is half a pixel from the picture's edge, whatever the size of a pixel.
        let scaled = |place: f64| (place + 0.5) * factor - 0.5;
        Ok((self.lens.scaled(factor)?, (scaled(self.centre.0), scaled(self.centre.1))))
    }
}

/// Whether `line` is a comment in YAML or MATLAB, and not the header of YAML.
fn is_comment(line: &str) -> bool {
    line.starts_with('#') || line.starts_with('%') && !line.starts_with("%YAML")
}

fn begins_with_number(line: &str) -> bool {
    line.trim_start_matches(['+', '-', '.']).starts_with(|first: char| first.is_ascii_digit())
}

/// Columns and rows of a picture, if both are possible.
fn picture_size(width: f64, height: f64) -> Result<(usize, usize), LensContentError> {
    let side = |side: f64| {
        let whole = side.fract() == 0.0 && (1.0..=MAX_SIDE as f64).contains(&side);
        if whole { Ok(side as usize) } else { Err(LensContentError::Size) }
    };
    Ok((side(width)?, side(height)?))
}
