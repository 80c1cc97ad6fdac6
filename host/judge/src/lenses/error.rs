//! What can be wrong with a lens file.

use std::io;
use std::path::PathBuf;

use halfrow_model::{
    CameraError, GeometryError, LensError, MAX_HEIGHT, MAX_RADIUS, MAX_WIDTH, MIN_RADIUS, MIN_WIDTH, Short,
    TableError,
};

/// A file that holds no lens that can be used. The source says where and what to do.
#[derive(Debug, thiserror::Error)]
pub enum LensFileError {
    /// The lens file could not be read, or is not text.
    #[error(
        "cannot read the lens file {}; check that it is there, that it is text and that you may read it, \
         or name the lens as equidistant:RADIUS",
        path.display()
    )]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The content of the lens file is wrong; the cause that follows says where.
    #[error("the lens file {} cannot be used", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// Where and why.
        source: LensContentError,
    },
}

/// Text that describes no lens that can be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LensContentError {
    /// The lens file is empty.
    #[error("it is empty; calibrate the lens, or copy the file again")]
    Empty,
    /// The lens file is XML, the one format of OpenCV's that this program does not read.
    #[error("it is XML; write it with cv::FileStorage as .yml or .json")]
    Xml,
    /// The lens file is neither YAML nor JSON.
    #[error("line {line}, column {column}: {reason}; mend it there, or copy the file again")]
    Syntax {
        /// The line, from 1.
        line: usize,
        /// The column, from 1.
        column: usize,
        /// What the reader found.
        reason: String,
    },
    /// The lens file is YAML or JSON, but not one group of keys and values.
    #[error(
        "it holds no keys; give OpenCV's FileStorage, ROS's camera_info, Kalibr's camchain or OCamCalib's \
         calib_results.txt"
    )]
    NoKeys,
    /// The lens file lacks a key.
    #[error("it has no {what}: none of the keys {keys}; add one")]
    Missing {
        /// What is missing.
        what: &'static str,
        /// The keys that it goes by.
        keys: String,
    },
    /// The lens file has two keys that differ only by case or punctuation, or that mean the same and have different numbers.
    #[error("`{second}` says again what `{first}` says; leave one of them out")]
    Twice {
        /// The key that is there first.
        first: String,
        /// The other one.
        second: String,
    },
    /// A value in the lens file is of the wrong kind.
    #[error("`{key}` is {found}, not {wanted}; correct it, or calibrate again")]
    Kind {
        /// The key.
        key: String,
        /// The value, shortened.
        found: String,
        /// The kind that it should be.
        wanted: &'static str,
    },
    /// The lens file describes several cameras.
    #[error("it holds several cameras, {0}; copy the keys of one into a file of its own")]
    Cameras(String),
    /// The lens file's camera model is not OpenCV's fisheye model.
    #[error(
        "its model is {name}, and a fisheye lens needs `equidistant`, OpenCV's fisheye model; calibrate with \
         cv::fisheye::calibrate, with Kalibr's pinhole-equi or with OCamCalib"
    )]
    Model {
        /// The model's name.
        name: String,
    },
    /// The lens file does not have four distortion coefficients.
    #[error(
        "it has {found} distortion coefficients{name}, and OpenCV's fisheye model has four, k1 to k4; calibrate with \
         cv::fisheye::calibrate"
    )]
    Coefficients {
        /// How many.
        found: usize,
        /// The model that has this many, in parentheses.
        name: &'static str,
    },
    /// The matrix in the lens file is not a camera matrix.
    #[error(
        "its camera matrix is not [fx, skew, cx; 0, fy, cy; 0, 0, 1]; take the matrix that the calibration returned"
    )]
    Matrix,
    /// A focal length of the lens is zero, so that it images nothing off its axis.
    #[error("its focal lengths fx and fy are {} and {} pixels, and neither can be 0; calibrate the lens again", Short(*.fx), Short(*.fy))]
    FocalLength {
        /// Pixels for a unit to the right.
        fx: f64,
        /// Pixels for a unit down.
        fy: f64,
    },
    /// The radius of the lens's image is outside the range of real lenses.
    #[error(
        "the radius of its image is {} pixels, outside {min} to {max:e}; check the focal length and the coefficients, or \
         calibrate the lens again",
        Short(*.0),
        min = MIN_RADIUS,
        max = MAX_RADIUS
    )]
    Radius(f64),
    /// The image size in the lens file is not the size of a picture.
    #[error("its image size is not two whole numbers from 1 to {max}; give columns and rows", max = super::MAX_SIDE)]
    Size,
    /// The axis of the lens is outside its pictures.
    #[error(
        "the axis is at column {column}, row {row}, outside its pictures of {columns} x {rows}; check the order, which \
         is row before column in OCamCalib's file and column before row elsewhere"
    )]
    Centre {
        /// The axis's column.
        column: f64,
        /// The axis's row.
        row: f64,
        /// Columns of the pictures.
        columns: usize,
        /// Rows of the pictures.
        rows: usize,
    },
    /// The calibration's pictures are no frames, but there are frames of their shape.
    #[error(
        "it was calibrated with pictures of {columns} x {rows}, and no frame has that size; name the size of the frames, at most \
         {width} x {height} in this shape"
    )]
    NoFrame {
        /// Columns of the pictures.
        columns: usize,
        /// Rows of the pictures.
        rows: usize,
        /// Columns of the largest frame of their shape.
        width: usize,
        /// Rows of that frame.
        height: usize,
    },
    /// Frames of another shape than the calibration's.
    #[error(transparent)]
    Shape(#[from] WrongShape),
    /// OCamCalib's file has too few or too many lines of numbers.
    #[error(
        "it has {found} lines of numbers instead of 5 (direct polynomial, inverse polynomial, centre, affine parameters, \
         image size); export it again"
    )]
    Lines {
        /// Lines of numbers there.
        found: usize,
    },
    /// A line of OCamCalib's file has the wrong number of numbers.
    #[error("line {line}: {found} numbers instead of {wanted} for {what}; export the file again")]
    Numbers {
        /// The line, from 1.
        line: usize,
        /// Numbers there.
        found: usize,
        /// Numbers that should be there.
        wanted: usize,
        /// What the line holds.
        what: &'static str,
    },
    /// A polynomial in OCamCalib's file does not begin with the number of its coefficients.
    #[error(
        "line {line}: {what} begins with {}, in place of the number of coefficients that follow, from 1 to {most}; \
         export the file again",
        Short(*.found),
        most = super::MAX_COEFFICIENTS
    )]
    Count {
        /// The line, from 1.
        line: usize,
        /// The number there.
        found: f64,
        /// What the line holds.
        what: &'static str,
    },
    /// A word in OCamCalib's file is not a finite number.
    #[error("line {line}: {found:?} is no finite number; export the file again")]
    Number {
        /// The line, from 1.
        line: usize,
        /// The word, shortened.
        found: String,
    },
    /// The direct polynomial in OCamCalib's file begins with the wrong sign.
    #[error(
        "the direct polynomial begins with {0}, and OCamCalib's begin below zero; if z counts forwards in your \
         program, change the signs of all of its coefficients"
    )]
    Sign(f64),
    /// The direct and the inverse polynomial in OCamCalib's file do not belong together.
    #[error(
        "the inverse polynomial is {distance:.1} pixels off the direct one at {degrees} degrees; they are of two \
         calibrations or in another order, so export the file again"
    )]
    Inverse {
        /// Pixels between them.
        distance: f64,
        /// Degrees from the axis.
        degrees: f64,
    },
    /// The numbers make no lens.
    #[error(transparent)]
    Lens(#[from] LensError),
    /// The lens is none for the frames.
    #[error(transparent)]
    Camera(CameraError),
    /// Its pictures have a size that no board takes.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// With this lens, a row would have to come from outside the frame.
    #[error("row {row} would not lie in the frame; calibrate the lens again")]
    RowOutside {
        /// The first such row.
        row: usize,
    },
    /// Its tables are none that a board can have.
    #[error(transparent)]
    Tables(TableError),
}

/// The advice of these errors, to lower the offsets, does not fit a lens file, which has none.
impl From<TableError> for LensContentError {
    fn from(error: TableError) -> Self {
        match error {
            TableError::BeforeFirst { row, .. } | TableError::AfterLast { row, .. } => {
                Self::RowOutside { row }
            }
            other => Self::Tables(other),
        }
    }
}

/// Whoever reads a lens file cannot choose its radius, so the advice of that error would not fit.
impl From<CameraError> for LensContentError {
    fn from(error: CameraError) -> Self {
        match error {
            CameraError::Lens(LensError::Radius(radius)) => Self::Radius(radius),
            other => Self::Camera(other),
        }
    }
}

impl LensContentError {
    /// The error for a calibration with pictures of this size, of which no frame can be, as `error` says.
    pub(crate) fn of_pictures((columns, rows): (usize, usize), error: GeometryError) -> Self {
        let widths = (MIN_WIDTH..=MAX_WIDTH).rev().step_by(2).filter(|&width| width <= columns);
        let heights = widths.map(|width| (width, width * rows));
        let of_shape = heights.filter(|(_, height)| height.is_multiple_of(columns));
        let mut frames = of_shape.map(|(width, height)| (width, height / columns));
        match frames.find(|(_, height)| (1..=MAX_HEIGHT).contains(height)) {
            Some((width, height)) => Self::NoFrame { columns, rows, width, height },
            None => error.into(),
        }
    }
}

/// The lens was calibrated with pictures of another shape than the frames.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "it was calibrated with pictures of {columns} x {rows}, and frames of {width} x {height} have another shape; calibrate \
     with such frames, or give the lens pitch and the optical centre for the same lens on another or a cropped sensor"
)]
pub struct WrongShape {
    /// Columns of the pictures.
    pub columns: usize,
    /// Rows of the pictures.
    pub rows: usize,
    /// Columns of the frames.
    pub width: usize,
    /// Rows of the frames.
    pub height: usize,
}
