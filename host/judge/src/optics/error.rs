//! Why a lens, tables or a kernel cannot be used.

use std::path::PathBuf;

use halfrow_model::{CameraError, GeometryError, GridRoomError, LensError, TableError};

use crate::kernels::{DamagedKernel, UnknownKernel};
use crate::lenses::{LensContentError, LensFileError};
use crate::tables::TableFileError;
use crate::words::{count, verb};

/// A lens, tables or a kernel that cannot be had.
#[derive(Debug, thiserror::Error)]
pub enum OpticsError {
    /// There is neither a kernel nor a file of this name.
    #[error("there is no file {name}, and {unknown}, or a kernel file")]
    Kernel {
        /// The name.
        name: String,
        /// Which names there are.
        unknown: UnknownKernel,
    },
    /// A named kernel is damaged.
    #[error(transparent)]
    Damaged(#[from] DamagedKernel),
    /// A file of tables or of a kernel cannot be used.
    #[error(transparent)]
    File(#[from] TableFileError),
    /// A lens file cannot be used.
    #[error(transparent)]
    LensFile(#[from] LensFileError),
    /// The lens file was made with pictures of another shape than the frames.
    #[error("the lens file {} does not fit", path.display())]
    Shape {
        /// The file.
        path: PathBuf,
        /// Which shapes.
        #[source]
        source: LensContentError,
    },
    /// No frame can have the lens file's size, or be behind its lens.
    #[error("the lens file {} cannot be used for these frames", path.display())]
    Unfit {
        /// The file.
        path: PathBuf,
        /// Why.
        #[source]
        source: LensContentError,
    },
    /// The frames have a size that no board takes.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// The lens is none.
    #[error(transparent)]
    Lens(#[from] LensError),
    /// The lens does not fit the frames.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// The row factors are none that a board can have.
    #[error(transparent)]
    Tables(#[from] TableError),
    /// No grid has so few entries.
    #[error(transparent)]
    Room(#[from] GridRoomError),
    /// The image circle of the lens lies outside the frame's rows.
    #[error(
        "{}, so nothing would be corrected; check the lens, its centre and the size of the frames",
        circle(*.outside, *.rows, *.radius, *.centre)
    )]
    OutsideCircle {
        /// Rows outside of the circle.
        outside: usize,
        /// All rows.
        rows: usize,
        /// The circle's radius, in pixels.
        radius: f64,
        /// The row of its middle.
        centre: f64,
    },
}

impl OpticsError {
    /// Whether a file is for another datapath. It is refused in the same way as a board with another datapath.
    #[must_use]
    pub fn is_other_datapath(&self) -> bool {
        matches!(self, Self::File(TableFileError::Datapath { .. }))
    }
}

/// How many rows lie outside the image circle, and where the circle is.
pub(super) fn circle(outside: usize, rows: usize, radius: f64, centre: f64) -> String {
    format!(
        "{outside} of {} {} outside the image circle, whose radius is {radius:.3} pixels around row {centre:.1}",
        count(rows, "row"),
        verb(outside, "lie")
    )
}
